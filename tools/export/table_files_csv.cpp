#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <iterator>

#include "engine/io/files/csv.h"
#include "tools/export/table_cells.h"
#include "tools/export/table_files.h"

namespace vinerow::tools {
namespace {

using record::RosKind;

template <class T>
void print_cell(const char* bytes, std::string& out) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(value)) {
      out += "nan";  // whatever its sign
      return;
    }
  }
  fmt::format_to(std::back_inserter(out), "{}", value);
}

void print_number(RosKind kind, const char* bytes, std::string& out) {
  switch (kind) {
    case RosKind::kBool:
      out += *bytes != 0 ? "True" : "False";  // spelling that pandas reads as booleans
      return;
    case RosKind::kInt8:
      return print_cell<std::int8_t>(bytes, out);
    case RosKind::kUint8:
      return print_cell<std::uint8_t>(bytes, out);
    case RosKind::kInt16:
      return print_cell<std::int16_t>(bytes, out);
    case RosKind::kUint16:
      return print_cell<std::uint16_t>(bytes, out);
    case RosKind::kInt32:
      return print_cell<std::int32_t>(bytes, out);
    case RosKind::kUint32:
      return print_cell<std::uint32_t>(bytes, out);
    case RosKind::kInt64:
      return print_cell<std::int64_t>(bytes, out);
    case RosKind::kUint64:
      return print_cell<std::uint64_t>(bytes, out);
    case RosKind::kFloat32:
      return print_cell<float>(bytes, out);
    case RosKind::kFloat64:
      return print_cell<double>(bytes, out);
    case RosKind::kText:
    case RosKind::kMessage:
      return;
  }
}

/// Nanoseconds as seconds without trailing zeros: "12.05".
void print_seconds(std::int64_t ns, std::string& out) {
  constexpr std::uint64_t kSecond_ns = 1'000'000'000;
  const auto size =
      ns < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(ns) : static_cast<std::uint64_t>(ns);
  std::string text =
      fmt::format("{}{}.{:09d}", ns < 0 ? "-" : "", size / kSecond_ns, size % kSecond_ns);
  while (text.ends_with('0') && !text.ends_with(".0")) text.pop_back();
  out += text;
}

}  // namespace

std::string csv_of(const MessageTable& table, const std::string& what) {
  std::size_t count = 3;
  for (const TableColumn& column : table.columns()) count += column.width();
  if (count > kMaxColumns) {
    throw TableTooLarge(
        fmt::format("{}: has {} columns, must be at most {}; --npz writes sequences as arrays, "
                    "--long writes one row per element",
                    what, count, kMaxColumns));
  }
  std::string out = "time_s,logged_s";
  if (table.has_elements()) out += ",element";
  std::vector<std::size_t> widths;
  for (const TableColumn& column : table.columns()) {
    widths.push_back(column.width());
    for (std::size_t i = 0; i < widths.back(); ++i) {
      out += "," + io::csv_text(column.list ? fmt::format("{}[{}]", column.name, i) : column.name);
    }
  }
  out += '\n';
  const TableCells cells(table);
  for (const std::size_t row : cells.order()) {
    print_seconds(table.rows()[row].stamp_ns, out);
    out += ',';
    print_seconds(table.rows()[row].logged_ns, out);
    if (table.has_elements()) out += fmt::format(",{}", table.rows()[row].element);
    for (std::size_t c = 0; c < widths.size(); ++c) {
      const TableColumn& column = table.columns()[c];
      for (std::size_t i = 0; i < widths[c]; ++i) {
        out += ',';
        if (i >= column.counts[row]) continue;  // a shorter sequence leaves cells empty
        if (column.kind == RosKind::kText) {
          out += io::csv_text(cells.text(c, row, i));
        } else {
          print_number(column.kind, cells.number(c, row, i), out);
        }
      }
    }
    out += '\n';
  }
  return out;
}

}  // namespace vinerow::tools

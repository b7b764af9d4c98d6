#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

#include "engine/api/messages/camera.h"
#include "engine/imaging/picture_codec.h"
#include "engine/io/files/utf8.h"
#include "engine/record/crc32.h"
#include "tools/export/number_bytes.h"
#include "tools/export/table_cells.h"
#include "tools/export/table_files.h"

// Sources: NEP 1, "A Simple File Format for NumPy Arrays", version 1.0; PKWARE,
// "APPNOTE.TXT", 6.3.10, sections 4.3.7, 4.3.12, 4.3.16.

namespace vinerow::tools {
namespace {

using record::RosKind;

constexpr std::uint64_t kMaxBytes = 0xFFFFFFFFu;  // zip needs other records beyond it

template <class T>
void append_little(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    out += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFFu);
  }
}

/// NumPy type code of a number.
const char* type_code(RosKind kind) {
  switch (kind) {
    case RosKind::kBool:
      return "|b1";
    case RosKind::kInt8:
      return "|i1";
    case RosKind::kUint8:
      return "|u1";
    case RosKind::kInt16:
      return "<i2";
    case RosKind::kUint16:
      return "<u2";
    case RosKind::kInt32:
      return "<i4";
    case RosKind::kUint32:
      return "<u4";
    case RosKind::kInt64:
      return "<i8";
    case RosKind::kUint64:
      return "<u8";
    case RosKind::kFloat32:
      return "<f4";
    default:
      return "<f8";
  }
}

/// @param shape  "(12,)"
std::string npy_head(const std::string& type, const std::string& shape) {
  std::string head =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, shape);
  constexpr std::size_t kBefore = 10, kAlign = 64;
  while ((kBefore + head.size() + 1) % kAlign != 0) head += ' ';
  head += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  append_little(bytes, static_cast<std::uint16_t>(head.size()));
  return bytes + head;
}

/// Zip file of stored (uncompressed) members with a fixed date: the same table gives the same
/// bytes.
class StoredZip {
 public:
  explicit StoredZip(const std::string& what) : what_(what) {}

  void add(const std::string& name, const std::string& data) {
    check(data.size());
    check(bytes_.size() + data.size());
    const std::size_t offset = bytes_.size();
    const std::uint32_t crc =
        record::calc_crc32({reinterpret_cast<const std::uint8_t*>(data.data()), data.size()});
    std::string common;
    append_little<std::uint16_t>(common, 20);      // version needed
    append_little<std::uint16_t>(common, 0x0800);  // the name is UTF-8
    append_little<std::uint16_t>(common, 0);       // stored
    append_little<std::uint16_t>(common, 0);       // time
    append_little<std::uint16_t>(common, 0x21);    // 1 January 1980
    append_little<std::uint32_t>(common, crc);
    append_little<std::uint32_t>(common, static_cast<std::uint32_t>(data.size()));
    append_little<std::uint32_t>(common, static_cast<std::uint32_t>(data.size()));
    append_little<std::uint16_t>(common, static_cast<std::uint16_t>(name.size()));
    append_little<std::uint16_t>(common, 0);  // extra field
    bytes_ += std::string("PK\x03\x04", 4) + common + name;
    bytes_ += data;
    directory_ += std::string("PK\x01\x02", 4);
    append_little<std::uint16_t>(directory_, 20);  // version made by
    directory_ += common;
    directory_.append(10, '\0');  // comment, disk, attributes
    append_little<std::uint32_t>(directory_, static_cast<std::uint32_t>(offset));
    directory_ += name;
    ++count_;
  }

  std::string finish() && {
    check(bytes_.size() + directory_.size());
    const std::size_t offset = bytes_.size();
    bytes_ += directory_ + std::string("PK\x05\x06\0\0\0\0", 8);
    append_little<std::uint16_t>(bytes_, static_cast<std::uint16_t>(count_));
    append_little<std::uint16_t>(bytes_, static_cast<std::uint16_t>(count_));
    append_little<std::uint32_t>(bytes_, static_cast<std::uint32_t>(directory_.size()));
    append_little<std::uint32_t>(bytes_, static_cast<std::uint32_t>(offset));
    append_little<std::uint16_t>(bytes_, 0);  // comment
    return std::move(bytes_);
  }

  void check(std::uint64_t size) const {
    if (size < kMaxBytes) return;
    throw ConfigError(
        fmt::format("{}: the arrays take more than 4 GiB, use --csv or a shorter "
                    "time span (--from, --to)",
                    what_));
  }

 private:
  std::string what_, bytes_, directory_;
  std::size_t count_ = 0;
};

std::string text_array(const MessageTable& table, const TableCells& cells, std::size_t c,
                       const std::string& shape, const StoredZip& zip) {
  const TableColumn& column = table.columns()[c];
  std::size_t longest = 1;
  for (const std::string& text : column.texts) {
    longest = std::max(longest, io::code_points_of(text).size());
  }
  const std::size_t width = column.width();
  zip.check(static_cast<std::uint64_t>(table.rows().size()) * width * longest * sizeof(char32_t));
  std::string data = npy_head(fmt::format("<U{}", longest), shape);
  for (const std::size_t row : cells.order()) {
    for (std::size_t i = 0; i < width; ++i) {
      std::u32string points;
      if (i < column.counts[row]) points = io::code_points_of(cells.text(c, row, i));
      points.resize(longest);
      for (const char32_t point : points) append_little(data, static_cast<std::uint32_t>(point));
    }
  }
  return data;
}

std::string number_array(const MessageTable& table, const TableCells& cells, std::size_t c,
                         const std::string& shape, const StoredZip& zip) {
  const TableColumn& column = table.columns()[c];
  const std::size_t width = column.width();
  const bool gaps = std::any_of(column.counts.begin(), column.counts.end(),
                                [&](std::uint32_t count) { return count < width; });
  const bool whole = column.kind != RosKind::kFloat32 && column.kind != RosKind::kFloat64;
  const RosKind kind = gaps && whole ? RosKind::kFloat64 : column.kind;
  const std::size_t size = record::size_of(kind);
  zip.check(static_cast<std::uint64_t>(table.rows().size()) * width * size);
  std::string gap(size, '\0');
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr float kShortNan = std::numeric_limits<float>::quiet_NaN();
  if (kind == RosKind::kFloat64) std::memcpy(gap.data(), &kNan, size);
  if (kind == RosKind::kFloat32) std::memcpy(gap.data(), &kShortNan, size);
  std::string data = npy_head(type_code(kind), shape);
  for (const std::size_t row : cells.order()) {
    for (std::size_t i = 0; i < width; ++i) {
      if (i >= column.counts[row]) {
        data += gap;
      } else if (kind != column.kind) {
        const double value = number_of(column.kind, cells.number(c, row, i));
        data.append(reinterpret_cast<const char*>(&value), sizeof value);
      } else {
        data.append(cells.number(c, row, i), size);
      }
    }
  }
  return data;
}

/// Pixels of pictures of one size and form, (rows, height, width, 3) or (rows, height, width).
/// @param c  column of their bytes  @returns nullopt if they are others
std::optional<std::string> pixel_array(const MessageTable& table, const TableCells& cells,
                                       std::size_t c, const StoredZip& zip) {
  const TableColumn& column = table.columns()[c];
  std::string data;
  Picture first, picture;
  for (const std::size_t row : cells.order()) {
    const std::size_t size = column.counts[row];
    const std::string_view bytes =
        size > 0 ? std::string_view(cells.number(c, row, 0), size) : std::string_view();
    if (!imaging::decode_picture(bytes, picture)) return std::nullopt;
    if (data.empty()) {
      first = picture;
      zip.check(static_cast<std::uint64_t>(table.rows().size()) * first.data.size());
      data = npy_head(Picture::bytes_per_pixel(first.format) == 2 ? "<u2" : "|u1",
                      fmt::format("({}, {}, {}{})", table.rows().size(), first.height, first.width,
                                  first.format == Picture::Format::kRgb8 ? ", 3" : ""));
    }
    if (picture.format != first.format || picture.width != first.width ||
        picture.height != first.height) {
      return std::nullopt;
    }
    data.append(reinterpret_cast<const char*>(picture.data.data()), picture.data.size());
  }
  if (data.empty()) return std::nullopt;
  return data;
}

/// Member name that stays inside the folder into which the file is unpacked.
std::string member_name(const std::string& column) {
  std::string name = column;
  for (char& c : name) {
    if (c == '/' || c == '\\' || c == '\0') c = '_';
  }
  constexpr std::size_t kLongest = 60'000;
  return name.substr(0, kLongest) + ".npy";
}

}  // namespace

std::string npz_of(const MessageTable& table, const std::string& what, bool are_pictures) {
  if (table.columns().size() + 3 > kMaxColumns) {
    throw TableTooLarge(fmt::format("{}: has {} columns, must be at most {}", what,
                                    table.columns().size() + 3, kMaxColumns));
  }
  StoredZip zip(what);
  const TableCells cells(table);
  const std::string rows = fmt::format("({},)", table.rows().size());
  const auto add_seconds = [&](const char* name, std::int64_t TableRow::*ns) {
    std::string data = npy_head("<f8", rows);
    for (const std::size_t row : cells.order()) {
      // Division gives the double nearest to the decimal number; multiplication by 1e-9 does not.
      const double seconds = static_cast<double>(table.rows()[row].*ns) / 1e9;
      data.append(reinterpret_cast<const char*>(&seconds), sizeof seconds);
    }
    zip.add(member_name(name), data);
  };
  add_seconds("time_s", &TableRow::stamp_ns);
  add_seconds("logged_s", &TableRow::logged_ns);
  if (table.has_elements()) {
    std::string data = npy_head("<u4", rows);
    for (const std::size_t row : cells.order()) append_little(data, table.rows()[row].element);
    zip.add(member_name("element"), data);
  }
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    const TableColumn& column = table.columns()[c];
    if (are_pictures && column.name == "data" && !table.has_elements()) {
      if (const auto pixels = pixel_array(table, cells, c, zip)) {
        zip.add(member_name("pixels"), *pixels);
        continue;
      }
    }
    const std::string shape =
        column.list ? fmt::format("({}, {})", table.rows().size(), column.width()) : rows;
    const bool text = column.kind == RosKind::kText;
    zip.add(member_name(column.name), text ? text_array(table, cells, c, shape, zip)
                                           : number_array(table, cells, c, shape, zip));
  }
  return std::move(zip).finish();
}

}  // namespace vinerow::tools

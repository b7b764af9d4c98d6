#include "tools/export/message_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "engine/io/files/utf8.h"

namespace vinerow::tools {

using record::CdrReader;
using record::RosField;
using record::RosKind;
using Shape = record::RosField::Shape;

namespace {

/// Whether a name is reserved for the columns that every table has.
bool is_reserved(const std::string& name) {
  return name == "time_s" || name == "logged_s" || name == "element";
}

bool is_header(const record::RosMessageType& type) {
  return type.name == "std_msgs/Header" && type.fields.size() == 2 &&
         type.fields[0].name == "stamp" && type.fields[1].name == "frame_id";
}

/// Whether a type is an instant or a duration in two integers, which a table shows as seconds.
bool is_seconds(const record::RosMessageType& type) {
  return (type.name == "builtin_interfaces/Time" || type.name == "builtin_interfaces/Duration") &&
         type.fields.size() == 2;
}

std::int64_t read_nanoseconds(CdrReader& in) {
  const auto seconds = in.read<std::int32_t>();
  return std::int64_t{seconds} * 1'000'000'000 + in.read<std::uint32_t>();
}

bool is_sequence(const RosField& field, std::string_view name, RosKind kind) {
  return field.name == name && field.kind == kind && field.shape == Shape::kSequence;
}

template <class T>
void append_number(CdrReader& in, std::string& numbers) {
  const T value = in.read<T>();
  numbers.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void take_number(CdrReader& in, RosKind kind, std::string& numbers) {
  switch (record::size_of(kind)) {
    case 1:
      return append_number<std::uint8_t>(in, numbers);
    case 2:
      return append_number<std::uint16_t>(in, numbers);
    case 4:
      return append_number<std::uint32_t>(in, numbers);
    default:
      return append_number<std::uint64_t>(in, numbers);
  }
}

/// Smallest size of a value, which bounds the memory that a damaged count can request.
std::size_t min_bytes(RosKind kind) {
  if (kind == RosKind::kText) return sizeof(std::uint32_t);
  return kind == RosKind::kMessage ? 1 : record::size_of(kind);
}

std::uint32_t read_length(CdrReader& in, const RosField& field) {
  if (field.shape == Shape::kSequence) {
    return static_cast<std::uint32_t>(in.read_count(min_bytes(field.kind)));
  }
  // Limited by the remaining bytes: reading detects a count that is too large.
  return static_cast<std::uint32_t>(std::min(field.length, in.remaining() + 1));
}

}  // namespace

std::size_t TableColumn::width() const {
  if (!list) return 1;
  return counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
}

MessageTable::MessageTable(record::RosSchema schema, bool long_form) : schema_(std::move(schema)) {
  const std::vector<RosField>& fields = type(0).fields;
  has_header_ = !fields.empty() && fields[0].kind == RosKind::kMessage &&
                fields[0].shape == Shape::kOne && is_header(type(fields[0].message));
  is_cloud_ = has_header_ && type(0).name == "sensor_msgs/PointCloud2";
  rows_of_elements_ = is_cloud_ || has_sequence(0, long_form);
  named_values_ = !rows_of_elements_ && has_header_ && fields.size() == 3 &&
                  is_sequence(fields[1], "name", RosKind::kText) &&
                  is_sequence(fields[2], "value", RosKind::kFloat64);
  announce(0, "", false);
}

bool MessageTable::has_sequence(std::size_t type_index, bool of_numbers_too) const {
  for (const RosField& field : type(type_index).fields) {
    const bool message = field.kind == RosKind::kMessage;
    if (field.shape == Shape::kSequence && (message || of_numbers_too)) return true;
    if (message && field.shape == Shape::kOne && has_sequence(field.message, of_numbers_too)) {
      return true;
    }
  }
  return false;
}

/// Adds columns in the order of the definition, so that a topic without messages has columns too.
/// Columns with an index in their name, and those of named values and clouds, are added with the
/// messages.
void MessageTable::announce(std::size_t type_index, const std::string& prefix, bool in_element) {
  const std::vector<RosField>& fields = type(type_index).fields;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const RosField& field = fields[i];
    const std::string name = prefix + field.name;
    const bool goes_along = rows_of_elements_ && !in_element && field.shape == Shape::kSequence;
    if (prefix.empty() && i == 0 && has_header_) {
      column(name + ".frame_id", RosKind::kText, false);
    } else if (prefix.empty() && (named_values_ || is_cloud_)) {
      continue;
    } else if (field.kind != RosKind::kMessage) {
      column(name, field.kind, field.shape != Shape::kOne && !goes_along);
    } else if (field.shape == Shape::kOne && is_seconds(type(field.message))) {
      column(name, RosKind::kFloat64, false);
    } else if (field.shape == Shape::kOne || goes_along) {
      announce(field.message, name + ".", in_element || goes_along);
    }
  }
}

std::size_t MessageTable::column(const std::string& name, RosKind kind, bool list) {
  const auto [place, added] = places_.try_emplace(name, columns_.size());
  if (added) {
    TableColumn& fresh = columns_.emplace_back();
    fresh.name = is_reserved(name) ? name + "_" : name;
    fresh.kind = kind;
    fresh.list = list;
    fresh.counts.resize(rows_.size());
  }
  return place->second;
}

bool MessageTable::add(std::int64_t stamp_ns, std::int64_t logged_ns,
                       std::span<const std::uint8_t> message) {
  leaves_.clear();
  numbers_.clear();
  texts_.clear();
  elements_ = 0;
  CdrReader in(message);
  if (has_header_) stamp_ns = decode_header(in);
  if (named_values_) {
    decode_named_values(in);
  } else if (is_cloud_) {
    if (!decode_cloud(in)) return false;
  } else {
    decode(in, 0, "", kEveryRow);
  }
  if (!in.ok()) return false;
  const std::uint32_t count = std::max(1u, elements_);
  for (std::uint32_t element = 0; element < count; ++element) {
    rows_.push_back({stamp_ns, logged_ns, element});
  }
  keep(count);
  bytes_ += count * (sizeof(TableRow) + columns_.size() * sizeof(std::uint32_t));
  return true;
}

std::int64_t MessageTable::decode_header(CdrReader& in) {
  const std::int64_t stamp_ns = read_nanoseconds(in);
  const RosField& header = type(0).fields[0];
  take(in, column(header.name + ".frame_id", RosKind::kText, false), kEveryRow, 1);
  return stamp_ns;
}

void MessageTable::decode_named_values(CdrReader& in) {
  std::vector<std::string> names(in.read_count(min_bytes(RosKind::kText)));
  for (std::string& name : names) {
    in.read(name);
    name = io::valid_utf8(name);
  }
  const std::size_t count = in.read_count(min_bytes(RosKind::kFloat64));
  for (std::size_t i = 0; i < count && in.ok(); ++i) {
    const std::string name = i < names.size() ? names[i] : fmt::format("value[{}]", i);
    const bool again = std::find(names.begin(), names.begin() + std::min(i, names.size()), name) !=
                       names.begin() + std::min(i, names.size());
    const std::string own = again ? fmt::format("{}[{}]", name, i) : name;
    take(in, column(own, RosKind::kFloat64, false), kEveryRow, 1);
  }
}

void MessageTable::decode(CdrReader& in, std::size_t type_index, const std::string& prefix,
                          int row) {
  const std::vector<RosField>& fields = type(type_index).fields;
  // A message without fields takes one byte.
  if (fields.empty()) in.read<std::uint8_t>();
  const std::size_t first = type_index == 0 && has_header_ ? 1 : 0;
  for (std::size_t i = first; i < fields.size() && in.ok(); ++i) {
    const RosField& field = fields[i];
    const std::string name = prefix + field.name;
    if (field.kind == RosKind::kMessage) {
      decode_messages(in, field, name, row);
    } else {
      decode_values(in, field, name, row);
    }
  }
}

void MessageTable::decode_messages(CdrReader& in, const RosField& field, const std::string& name,
                                   int row) {
  if (field.shape == Shape::kOne && is_seconds(type(field.message))) {
    const double seconds = static_cast<double>(read_nanoseconds(in)) / 1e9;
    leaves_.push_back({column(name, RosKind::kFloat64, false), row, 1, numbers_.size()});
    numbers_.append(reinterpret_cast<const char*>(&seconds), sizeof seconds);
    return;
  }
  if (field.shape == Shape::kOne) return decode(in, field.message, name + ".", row);
  const std::uint32_t count = read_length(in, field);
  const bool goes_along = rows_of_elements_ && row == kEveryRow && field.shape == Shape::kSequence;
  if (goes_along) elements_ = std::max(elements_, count);
  for (std::uint32_t i = 0; i < count && in.ok(); ++i) {
    if (goes_along) {
      decode(in, field.message, name + ".", static_cast<int>(i));
    } else {
      decode(in, field.message, fmt::format("{}[{}].", name, i), row);
    }
  }
}

void MessageTable::decode_values(CdrReader& in, const RosField& field, const std::string& name,
                                 int row) {
  if (field.shape == Shape::kOne) return take(in, column(name, field.kind, false), row, 1);
  const std::uint32_t count = read_length(in, field);
  if (!rows_of_elements_ || row != kEveryRow || field.shape == Shape::kArray) {
    return take(in, column(name, field.kind, true), row, count);
  }
  elements_ = std::max(elements_, count);
  const std::size_t place = column(name, field.kind, false);
  for (std::uint32_t i = 0; i < count && in.ok(); ++i) take(in, place, static_cast<int>(i), 1);
}

void MessageTable::take(CdrReader& in, std::size_t place, int row, std::uint32_t count) {
  const RosKind kind = columns_[place].kind;
  const bool text = kind == RosKind::kText;
  leaves_.push_back({place, row, count, text ? texts_.size() : numbers_.size()});
  for (std::uint32_t i = 0; i < count && in.ok(); ++i) {
    if (text) {
      texts_.push_back(io::valid_utf8(in.read_text()));
    } else {
      take_number(in, kind, numbers_);
    }
  }
}

void MessageTable::keep(std::uint32_t row_count) {
  // Sorted by row, so that a column's values are in the order of its rows.
  std::stable_sort(leaves_.begin(), leaves_.end(),
                   [](const Leaf& a, const Leaf& b) { return a.row < b.row; });
  const std::size_t first_row = rows_.size() - row_count;
  const auto of_elements = std::find_if(leaves_.begin(), leaves_.end(),
                                        [](const Leaf& leaf) { return leaf.row != kEveryRow; });
  auto next = of_elements;
  for (std::uint32_t element = 0; element < row_count; ++element) {
    for (auto leaf = leaves_.begin(); leaf != of_elements; ++leaf) {
      append(*leaf, first_row + element);
    }
    for (; next != leaves_.end() && next->row == static_cast<int>(element); ++next) {
      append(*next, first_row + element);
    }
  }
  for (TableColumn& column : columns_) column.counts.resize(rows_.size());
}

void MessageTable::append(const Leaf& leaf, std::size_t row) {
  TableColumn& column = columns_[leaf.column];
  column.counts.resize(row);
  column.counts.push_back(leaf.count);
  if (column.kind == RosKind::kText) {
    column.texts.insert(column.texts.end(), texts_.begin() + leaf.from,
                        texts_.begin() + leaf.from + leaf.count);
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      bytes_ += sizeof(std::string) + texts_[leaf.from + i].size();
    }
  } else {
    const std::size_t size = leaf.count * record::size_of(column.kind);
    column.numbers.append(numbers_, leaf.from, size);
    bytes_ += size;
  }
}

}  // namespace vinerow::tools

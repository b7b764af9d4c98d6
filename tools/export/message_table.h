#pragma once
/// Table of the messages of one topic, decoded with the definition in the log.
///
/// A field is a column, named by its path in the message: "pose.pose.position.x". The column of an
/// array (float64[36]) or of a sequence of numbers has several values per row. A message with a
/// sequence of messages (a path, transforms) gives one row per element, as pandas' explode() does:
/// its sequences advance together, and all other values repeat in each of these rows. Instants and
/// durations are in seconds. Names and values in two sequences (NamedValues) give one column per
/// name. A cloud (PointCloud2) gives one row per point and one column for each field that it
/// describes.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/record/cdr.h"
#include "engine/record/ros_schema.h"

namespace vinerow::tools {

struct TableColumn {
  std::string name;
  record::RosKind kind = record::RosKind::kFloat64;
  bool list = false;                  ///< several values per row
  std::vector<std::uint32_t> counts;  ///< values in each row; may be 0
  std::string numbers;                ///< bytes of the numbers in sequence; empty for text
  std::vector<std::string> texts;     ///< texts in sequence, valid UTF-8

  /// Largest number of values in a row.
  std::size_t width() const;
};

struct TableRow {
  std::int64_t stamp_ns = 0;   ///< stamp in the message
  std::int64_t logged_ns = 0;  ///< time of recording
  std::uint32_t element = 0;   ///< index in the message's sequences
};

class MessageTable {
 public:
  /// @param long_form  one row per element of every sequence, also of numbers
  MessageTable(record::RosSchema schema, bool long_form);

  /// @param stamp_ns  used if the message has no header
  /// @returns false, and adds nothing, if the bytes are not such a message
  bool add(std::int64_t stamp_ns, std::int64_t logged_ns, std::span<const std::uint8_t> message);

  /// Whether a message can give several rows.
  bool has_elements() const { return rows_of_elements_; }
  const std::vector<TableRow>& rows() const { return rows_; }
  const std::vector<TableColumn>& columns() const { return columns_; }
  /// Size of the values, apart from what containers reserve.
  std::size_t bytes() const { return bytes_; }

 private:
  static constexpr int kEveryRow = -1;
  /// Values of one column in one message.
  struct Leaf {
    std::size_t column = 0;
    int row = kEveryRow;
    std::uint32_t count = 0;
    std::size_t from = 0;  ///< index in the scratch numbers or texts
  };

  const record::RosMessageType& type(std::size_t index) const { return schema_.messages[index]; }
  bool has_sequence(std::size_t type_index, bool of_numbers_too) const;
  void announce(std::size_t type_index, const std::string& prefix, bool in_element);
  std::size_t column(const std::string& name, record::RosKind kind, bool list);
  /// @returns the stamp
  std::int64_t decode_header(record::CdrReader& in);
  void decode_named_values(record::CdrReader& in);
  /// @returns false if its description does not fit its bytes
  bool decode_cloud(record::CdrReader& in);
  void decode(record::CdrReader& in, std::size_t type_index, const std::string& prefix, int row);
  void decode_messages(record::CdrReader& in, const record::RosField& field,
                       const std::string& name, int row);
  void decode_values(record::CdrReader& in, const record::RosField& field, const std::string& name,
                     int row);
  void take(record::CdrReader& in, std::size_t column, int row, std::uint32_t count);
  void keep(std::uint32_t row_count);
  void append(const Leaf& leaf, std::size_t row);

  record::RosSchema schema_;
  bool has_header_ = false;
  bool rows_of_elements_ = false;
  bool named_values_ = false;
  bool is_cloud_ = false;
  std::vector<TableColumn> columns_;
  std::map<std::string, std::size_t> places_;  ///< indices of columns by name
  std::vector<TableRow> rows_;
  std::size_t bytes_ = 0;
  // Scratch of the current message.
  std::vector<Leaf> leaves_;
  std::string numbers_;
  std::vector<std::string> texts_;
  std::uint32_t elements_ = 0;
};

}  // namespace vinerow::tools

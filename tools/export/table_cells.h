#pragma once
/// Access to the values of a table by row, and the order of the rows by stamp.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "tools/export/message_table.h"

namespace vinerow::tools {

class TableCells {
 public:
  explicit TableCells(const MessageTable& table) : table_(table), order_(table.rows().size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return table.rows()[a].stamp_ns < table.rows()[b].stamp_ns;
    });
    for (const TableColumn& column : table.columns()) {
      std::vector<std::size_t>& from = from_.emplace_back();
      std::size_t next = 0;
      for (const std::uint32_t count : column.counts) {
        from.push_back(next);
        next += count;
      }
    }
  }

  /// Rows in order of their stamps; rows with equal stamps in order of recording.
  const std::vector<std::size_t>& order() const { return order_; }
  /// @pre i < columns()[column].counts[row]
  const std::string& text(std::size_t column, std::size_t row, std::size_t i) const {
    return table_.columns()[column].texts[from_[column][row] + i];
  }
  /// Bytes of a number. @pre as text()
  const char* number(std::size_t column, std::size_t row, std::size_t i) const {
    const TableColumn& of = table_.columns()[column];
    return of.numbers.data() + (from_[column][row] + i) * record::size_of(of.kind);
  }

 private:
  const MessageTable& table_;
  std::vector<std::size_t> order_;
  std::vector<std::vector<std::size_t>> from_;
};

}  // namespace vinerow::tools

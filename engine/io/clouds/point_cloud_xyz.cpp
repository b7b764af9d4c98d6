#include "engine/io/clouds/point_cloud_xyz.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/io/clouds/point_cloud_scalar.h"
#include "engine/io/clouds/xyz_columns.h"

namespace vinerow::io {
namespace {

constexpr std::array<const char*, 7> kNames = {
    "x", "y", "z", "red", "green", "blue", "classification"};

class XyzReader : public PointCloudReader {
 public:
  explicit XyzReader(BlockFile file) : file_(std::move(file)) {
    find_first_point();
    for (std::size_t k = 0; k < columns_.of.size(); ++k) {
      if (!columns_.of[k]) continue;
      quantity_of_.resize(std::max(quantity_of_.size(), *columns_.of[k] + 1));
      quantity_of_[*columns_.of[k]] = k;
    }
    info_.format = "XYZ";
    info_.record_count = reported_;
    info_.has_colour = columns_.has_colour();
    info_.has_classification = columns_.of[6].has_value();
  }

 protected:
  Next next(CloudPoint& point) override {
    std::string_view line;
    if (!next_line(file_, &line, &is_comment)) {
      if (reported_ && at_ < *reported_) {
        file_.fail(fmt::format("is cut off: its first line counts {} points, it holds {}",
                               *reported_, at_));
      }
      return Next::kEnd;
    }
    if (reported_ && at_ == *reported_) {
      file_.fail(fmt::format("has more data than its first line counts: {} points, then line {}",
                             *reported_, file_.line_number()));
    }
    ++at_;
    read_fields(line);
    point.position = {values_[0], values_[1], values_[2]};
    point.rgb.reset();
    point.classification.reset();
    if (info_.has_colour) point.rgb = {{byte(3), byte(4), byte(5)}};
    if (info_.has_classification) point.classification = byte(6);
    return Next::kPoint;
  }

 private:
  static bool is_comment(std::string_view line) {
    return line.starts_with('#') || line.starts_with("//");
  }

  /// Determines columns and separator, and moves back to the start of the first point's line.
  void find_first_point() {
    std::string_view line;
    std::optional<XyzColumns> named, commented;
    std::uint64_t begin = 0;
    while (true) {
      begin = file_.position();
      if (!file_.line(&line)) file_.fail("has no line of points");
      std::string_view rest = line;
      const std::string_view word = next_word(&rest);
      if (word.empty()) continue;
      if (is_comment(word)) {
        if (!commented) commented = named_columns(line);
        continue;
      }
      separator_ = separator_of(line);
      std::optional<std::string_view> fields = line;
      const std::optional<std::string_view> first = next_field(&fields, separator_);
      if (!first || !parse_number(*first)) {
        if (named || !(named = named_columns(line))) {
          file_.fail(
              fmt::format("has '{}' in line {}, must be numbers or the names of columns with "
                          "x, y and z",
                          line.substr(0, 40), file_.line_number()));
        }
        continue;
      }
      const bool is_alone = !next_field(&fields, separator_);
      if (is_alone && !reported_ && parse_count(*first)) {
        reported_ = parse_count(*first);
        continue;
      }
      break;
    }
    // A comment that only mentions x, y and z has further words.
    if (!named && commented && commented->count == count_fields(line, separator_)) {
      named = commented;
    }
    columns_ = named ? *named : usual_columns(line, separator_, reported_.has_value());
    const std::uint64_t lines = file_.line_number() - 1;
    file_.seek_line(begin, lines);
  }

  void read_fields(std::string_view line) {
    std::optional<std::string_view> rest = line;
    for (std::size_t column = 0; column < quantity_of_.size(); ++column) {
      const std::optional<std::string_view> field = next_field(&rest, separator_);
      if (!field) {
        file_.fail(fmt::format("has {} columns in line {}, must have at least {}", column,
                               file_.line_number(), quantity_of_.size()));
      }
      if (!quantity_of_[column]) continue;
      const std::size_t k = *quantity_of_[column];
      values_[k] = number_in(file_, *field, kNames[k]);
    }
  }

  std::uint8_t byte(std::size_t k) const {
    if (!(values_[k] >= 0.0 && values_[k] <= 255.0) || values_[k] != std::floor(values_[k])) {
      file_.fail(fmt::format("has {} = {} in line {}, must be a whole number from 0 to 255",
                             kNames[k], values_[k], file_.line_number()));
    }
    return static_cast<std::uint8_t>(values_[k]);
  }

  BlockFile file_;
  XyzColumns columns_;
  char separator_ = ' ';
  std::vector<std::optional<std::size_t>> quantity_of_;  // of each column, up to the last needed
  std::optional<std::uint64_t> reported_;                // by the first line of a PTS file
  std::array<double, 7> values_{};
  std::uint64_t at_ = 0;
};

}  // namespace

std::unique_ptr<PointCloudReader> open_xyz(BlockFile file) {
  return std::make_unique<XyzReader>(std::move(file));
}

}  // namespace vinerow::io

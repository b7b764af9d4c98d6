#include "engine/io/clouds/point_cloud_pcd.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <string_view>
#include <utility>

#include "engine/io/clouds/pcd_header.h"

namespace vinerow::io {
namespace {

class PcdReader : public PointCloudReader {
 public:
  explicit PcdReader(BlockFile file) : file_(std::move(file)), header_(read_pcd_header(file_)) {
    for (int k = 0; k < 3; ++k) {
      axes_[k] = find({std::string_view("xyz").substr(static_cast<std::size_t>(k), 1)});
      if (axes_[k] == nullptr) file_.fail(fmt::format("has no field '{}'", "xyz"[k]));
    }
    rgb_ = find({"rgb", "rgba"});
    label_ = find({"label", "classification"});
    if (rgb_ && size_of(rgb_->type) != 4) {
      file_.fail(fmt::format("has the field '{}' with {} bytes, must be 4", rgb_->name,
                             size_of(rgb_->type)));
    }
    if (!header_.ascii) {
      const std::uint64_t held = file_.remaining() / header_.point_bytes;
      if (held != header_.points) fail_count(held);
    }
    info_.format = header_.ascii ? "PCD ascii" : "PCD binary";
    info_.record_count = header_.points;
    info_.has_colour = rgb_ != nullptr;
    info_.has_classification = label_ != nullptr;
  }

 protected:
  Next next(CloudPoint& point) override {
    if (at_ == header_.points) {
      std::string_view line;
      if (header_.ascii && next_line(file_, &line, &is_comment)) {
        file_.fail(fmt::format("has more data than its header counts: {} points, then line {}",
                               header_.points, file_.line_number()));
      }
      return Next::kEnd;
    }
    if (header_.ascii) {
      read_text();
    } else {
      read_bytes();
    }
    ++at_;
    point.position = position_;
    point.rgb.reset();
    point.classification.reset();
    if (rgb_ && packed_known_) {
      point.rgb = {{static_cast<std::uint8_t>(packed_ >> 16),
                    static_cast<std::uint8_t>(packed_ >> 8), static_cast<std::uint8_t>(packed_)}};
    }
    if (label_ && class_ >= 0.0 && class_ <= 255.0 && class_ == std::floor(class_)) {
      point.classification = static_cast<std::uint8_t>(class_);
    }
    return Next::kPoint;
  }

 private:
  const PcdField* find(std::initializer_list<std::string_view> names) const {
    for (const PcdField& field : header_.fields) {
      for (const std::string_view name : names) {
        if (field.name == name && field.count == 1) return &field;
      }
    }
    return nullptr;
  }

  [[noreturn]] void fail_count(std::uint64_t held) const {
    file_.fail(fmt::format("{} {} points, it holds {}",
                           held < header_.points ? "is cut off: its header counts"
                                                 : "has more data than its header counts:",
                           header_.points, held));
  }

  void read_bytes() {
    const std::uint8_t* bytes = file_.take(header_.point_bytes);
    if (bytes == nullptr) fail_count(at_);
    constexpr std::endian kOrder = std::endian::little;
    for (int k = 0; k < 3; ++k) position_[k] = load(axes_[k]->type, bytes + axes_[k]->at, kOrder);
    if (rgb_) packed_ = load<std::uint32_t>(bytes + rgb_->at);
    if (label_) class_ = load(label_->type, bytes + label_->at, kOrder);
  }

  static bool is_comment(std::string_view word) { return word.starts_with('#'); }
  void read_text() {
    std::string_view line;
    if (!next_line(file_, &line, &is_comment)) fail_count(at_);
    for (const PcdField& field : header_.fields) {
      for (std::size_t k = 0; k < field.count; ++k) {
        take(field, number_in(file_, next_word(&line), field.name));
      }
    }
  }
  void take(const PcdField& field, double value) {
    for (int k = 0; k < 3; ++k) {
      if (&field == axes_[k]) position_[k] = value;
    }
    if (&field == label_) class_ = value;
    if (&field != rgb_) return;
    if (field.type == Scalar::kF32) {
      packed_ = std::bit_cast<std::uint32_t>(static_cast<float>(value));
      // As text, the bits of an opaque colour are NaN, and the colour is lost.
      packed_known_ = !std::isnan(value);
    } else {
      packed_known_ = std::abs(value) < 1e10;
      packed_ = packed_known_ ? static_cast<std::uint32_t>(static_cast<std::int64_t>(value)) : 0;
    }
  }

  BlockFile file_;
  PcdHeader header_;
  std::array<const PcdField*, 3> axes_{};
  const PcdField* rgb_ = nullptr;
  const PcdField* label_ = nullptr;
  Eigen::Vector3d position_ = {0, 0, 0};
  std::uint32_t packed_ = 0;
  bool packed_known_ = true;
  double class_ = 0.0;
  std::uint64_t at_ = 0;
};

}  // namespace

std::unique_ptr<PointCloudReader> open_pcd(BlockFile file) {
  return std::make_unique<PcdReader>(std::move(file));
}

}  // namespace vinerow::io

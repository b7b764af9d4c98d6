#include "engine/render/sample_pattern.h"

#include <algorithm>
#include <cmath>

namespace vinerow::render {

namespace {

/// Columns or rows that llvmpipe can draw.
constexpr int kMaxDrawn = 16384;

}  // namespace

SamplePattern::SamplePattern(int width, int height, int samples)
    : width_(width),
      height_(height),
      staggered_(samples == 2 && std::max(width + height, 2 * height) < kMaxDrawn) {
  if (staggered_) {
    lod_bias_ = std::log2(spacing_px());
    columns_ = width + height + 1;
    rows_ = 2 * height + 1;
    taps_ = {{0, 4}, {-columns_, 1}, {1 - columns_, 1}, {columns_ - 1, 1}, {columns_, 1}};
  } else {
    scale_ = samples == 2 ? 2 : std::clamp(static_cast<int>(std::lround(std::sqrt(samples))), 1, 3);
    columns_ = width * scale_;
    rows_ = height * scale_;
    for (int row = 0; row < scale_; ++row) {
      for (int k = 0; k < scale_; ++k) taps_.push_back({row * columns_ + k, 1});
    }
  }
  for (const Tap& tap : taps_) weight_sum_ += tap.weight;
}

double SamplePattern::spacing_px() const {
  return staggered_ ? std::sqrt(0.5) : 1.0 / scale_;
}

Eigen::Matrix4d SamplePattern::drawn_from_clip() const {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  if (staggered_) {
    matrix(0, 0) = double{1} * width_ / columns_;
    matrix(0, 1) = -double{1} * height_ / columns_;
    matrix(1, 1) = double{2} * height_ / rows_;
  }
  return matrix;
}

SamplePattern::Columns SamplePattern::used_columns(int first_row, int rows) const {
  if (!staggered_) return {0, columns_};
  // x = a + j/2 - H is 0 to W, the corners of the outer pixels.
  const int last_row = first_row + rows - 1;
  return {std::max(0, height_ - (last_row + 1) / 2),
          std::min(columns_, width_ + height_ - first_row / 2 + 1)};
}

std::size_t SamplePattern::first_of(int x, int y) const {
  const std::ptrdiff_t above = height_ - 1 - y;
  // The middle of the pixel: row 2 above + 1, and x + 1/2 = a + row/2 - H.
  const std::ptrdiff_t row = staggered_ ? 2 * above + 1 : above * scale_;
  const std::ptrdiff_t column = staggered_ ? x + y + 1 : x * scale_;
  return static_cast<std::size_t>(row * columns_ + column);
}

}  // namespace vinerow::render

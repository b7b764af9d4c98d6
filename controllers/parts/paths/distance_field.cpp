#include "controllers/parts/paths/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/messages/grid.h"

namespace vinerow::controllers {
namespace {

constexpr float kFar = 1e20f;

/// Squared distances along one line: out[i] = min_k (i - k)^2 + in[k].
class LowerEnvelope {
 public:
  explicit LowerEnvelope(int longest)
      : parabola_(longest), height_(longest), begin_(longest + 1), half_per_(longest) {
    for (int k = 1; k < longest; ++k) half_per_[k] = 0.5 / k;
  }

  void transform(const float* in, int count, float* out) {
    int last = -1;
    for (int k = 0; k < count; ++k) {
      if (in[k] >= kFar) continue;
      const double height = in[k] + double(k) * k;
      double meet = -std::numeric_limits<double>::infinity();
      while (last >= 0) {
        // The rounding of the factor is far below the distance of different meeting points, which
        // are whole numbers over 2 (k - other): it decides between equal parabolas alone.
        meet = (height - height_[last]) * half_per_[k - parabola_[last]];
        if (meet > begin_[last]) break;
        meet = -std::numeric_limits<double>::infinity();
        --last;
      }
      ++last;
      parabola_[last] = k;
      height_[last] = height;
      begin_[last] = meet;
    }
    if (last < 0) {
      std::fill(out, out + count, kFar);
      return;
    }
    for (int i = 0, at = 0; i < count; ++i) {
      while (at < last && begin_[at + 1] < i) ++at;
      const float away = static_cast<float>(i - parabola_[at]);
      out[i] = away * away + in[parabola_[at]];
    }
  }

 private:
  // Of each parabola of the envelope:
  std::vector<int> parabola_;     // its position k
  std::vector<double> height_;    // in[k] + k^2: its value at 0
  std::vector<double> begin_;     // start of its part of the envelope
  std::vector<double> half_per_;  // 1 / (2 n) of n
};

}  // namespace

DistanceField::DistanceField(const OccupancyGrid& grid)
    : columns_(grid.columns), rows_(grid.rows), cell_m_(grid.cell_m), corner_W_(grid.corner_W) {
  if (grid.empty()) {
    columns_ = rows_ = 0;
    return;
  }
  distance_m_.resize(grid.cells.size());
  for (int j = 0; j < rows_; ++j) square_along_row(grid, j);
  // A few columns together, because neighbours in a row share a cache line.
  constexpr int kTogether = 16;
  LowerEnvelope envelope(rows_);
  std::vector<float> lines(static_cast<std::size_t>(kTogether) * rows_), result(rows_);
  for (int i = 0; i < columns_; i += kTogether) {
    const int together = std::min(kTogether, columns_ - i);
    for (int j = 0; j < rows_; ++j) {
      const float* cell = &distance_m_[static_cast<std::size_t>(j) * columns_ + i];
      for (int k = 0; k < together; ++k) lines[static_cast<std::size_t>(k) * rows_ + j] = cell[k];
    }
    for (int k = 0; k < together; ++k) {
      float* line = &lines[static_cast<std::size_t>(k) * rows_];
      envelope.transform(line, rows_, result.data());
      std::copy(result.begin(), result.end(), line);
    }
    for (int j = 0; j < rows_; ++j) {
      float* cell = &distance_m_[static_cast<std::size_t>(j) * columns_ + i];
      for (int k = 0; k < together; ++k) {
        const double square = lines[static_cast<std::size_t>(k) * rows_ + j];
        cell[k] = static_cast<float>(std::max(0.0, std::sqrt(square) * cell_m_ - 0.5 * cell_m_));
      }
    }
  }
}

/// Square of the distance to the nearest occupied cell of the same row, in cells.
void DistanceField::square_along_row(const OccupancyGrid& grid, int j) {
  float* row = &distance_m_[static_cast<std::size_t>(j) * columns_];
  float away = std::sqrt(kFar);
  for (int i = 0; i < columns_; ++i) {
    away = grid.occupied(i, j) ? 0.0f : away + 1.0f;
    row[i] = away;
  }
  away = std::sqrt(kFar);
  for (int i = columns_ - 1; i >= 0; --i) {
    away = row[i] == 0.0f ? 0.0f : away + 1.0f;
    const float nearest = std::min(row[i], away);
    row[i] = nearest * nearest;
  }
}

bool DistanceField::covers(const Eigen::Vector2d& p_W) const {
  const Eigen::Vector2d in_cells = (p_W - corner_W_) / cell_m_;
  return in_cells.x() >= 0.0 && in_cells.y() >= 0.0 && in_cells.x() < columns_ &&
         in_cells.y() < rows_;
}

double DistanceField::at(const Eigen::Vector2d& p_W) const {
  if (empty()) return std::numeric_limits<double>::infinity();
  if (!covers(p_W)) return 0.0;
  const double x = std::clamp((p_W.x() - corner_W_.x()) / cell_m_ - 0.5, 0.0, columns_ - 1.0);
  const double y = std::clamp((p_W.y() - corner_W_.y()) / cell_m_ - 0.5, 0.0, rows_ - 1.0);
  const int i = std::min(static_cast<int>(x), std::max(columns_ - 2, 0));
  const int j = std::min(static_cast<int>(y), std::max(rows_ - 2, 0));
  const int right = columns_ > 1 ? 1 : 0;
  const std::size_t up = rows_ > 1 ? static_cast<std::size_t>(columns_) : 0;
  const float* d = &distance_m_[static_cast<std::size_t>(j) * columns_ + i];
  const double u = x - i, v = y - j;
  return (1 - v) * ((1 - u) * d[0] + u * d[right]) + v * ((1 - u) * d[up] + u * d[up + right]);
}

}  // namespace vinerow::controllers

#include "controllers/estimation/row_localisation/row_line_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "engine/api/map.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr std::uint32_t kLeafPieces = 4;
constexpr std::size_t kDeepest = 64;  // halving 2^32 segments takes 32 levels
// Relative to the coordinates: far more than the rounding of a distance.
constexpr double kRounding = 1e-12;

}  // namespace

/// The two nearest rows among the segments so far, independent of their order.
struct RowLineIndex::Search {
  struct Candidate {
    LinePoint point;
    std::uint32_t row = UINT32_MAX, number = UINT32_MAX;

    bool is_before(const Candidate& other) const {
      return std::tie(point.distance_m, row, number) <
             std::tie(other.point.distance_m, other.row, other.number);
    }
  };

  void look_at(const Piece& piece, const Vector3d& p_W) {
    const Candidate seen{nearest_on_piece(piece.from_W, piece.to_W, p_W), piece.row, piece.number};
    if (!std::isfinite(seen.point.distance_m) || !seen.is_before(second)) return;
    if (seen.row == first.row) {
      if (seen.is_before(first)) first = seen;
    } else if (seen.is_before(first)) {
      second = first;
      first = seen;
    } else {
      second = seen;
    }
  }

  Candidate first, second;
};

RowLineIndex::RowLineIndex(const RowMap& map) {
  for (std::uint32_t row = 0; row < map.rows.size(); ++row) {
    const std::vector<Vector3d>& line_W = map.rows[row].line_W;
    for (std::uint32_t i = 0; i + 1 < line_W.size(); ++i) {
      const Vector2d from_W = line_W[i].head<2>(), to_W = line_W[i + 1].head<2>();
      // Such segments have no defined distance.
      if (!from_W.allFinite() || !to_W.allFinite() || (to_W - from_W).isZero()) continue;
      pieces_.push_back({line_W[i], line_W[i + 1], row, i});
      largest_m_ = std::max({largest_m_, from_W.cwiseAbs().maxCoeff(), to_W.cwiseAbs().maxCoeff()});
    }
  }
  if (!pieces_.empty()) lay_boxes(0, static_cast<std::uint32_t>(pieces_.size()));
}

void RowLineIndex::lay_boxes(std::uint32_t begin, std::uint32_t end) {
  Box box{pieces_[begin].from_W.head<2>(), pieces_[begin].from_W.head<2>(), begin, end};
  for (std::uint32_t k = begin; k < end; ++k) {
    for (const Vector3d& p_W : {pieces_[k].from_W, pieces_[k].to_W}) {
      box.low_W = box.low_W.cwiseMin(p_W.head<2>());
      box.high_W = box.high_W.cwiseMax(p_W.head<2>());
    }
  }
  const std::size_t index = boxes_.size();
  boxes_.push_back(box);
  if (end - begin <= kLeafPieces) return;
  Eigen::Index axis = 0;
  (box.high_W - box.low_W).maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(pieces_.begin() + begin, pieces_.begin() + middle, pieces_.begin() + end,
                   [axis](const Piece& a, const Piece& b) {
                     const double a_m = a.from_W[axis] + a.to_W[axis];
                     const double b_m = b.from_W[axis] + b.to_W[axis];
                     return std::tie(a_m, a.row, a.number) < std::tie(b_m, b.row, b.number);
                   });
  lay_boxes(begin, middle);
  boxes_[index].second = static_cast<std::uint32_t>(boxes_.size());
  lay_boxes(middle, end);
}

RowLineIndex::NearestRows RowLineIndex::nearest_rows(const Vector3d& p_W) const {
  const Vector2d p = p_W.head<2>();
  if (boxes_.empty() || !p.allFinite()) return {};
  const double rounding_m = kRounding * (largest_m_ + p.cwiseAbs().maxCoeff());
  struct Open {
    std::uint32_t box;
    double squared_m2;  // distance
  };
  const auto open = [&](std::uint32_t index) -> Open {
    const Box& box = boxes_[index];
    return {index, (p - p.cwiseMax(box.low_W).cwiseMin(box.high_W)).squaredNorm()};
  };
  std::array<Open, kDeepest> stack;
  std::size_t size = 0;
  stack[size++] = open(0);
  Search search;
  while (size > 0) {
    const Open next = stack[--size];
    const double limit_m = search.second.point.distance_m + rounding_m;
    if (next.squared_m2 > limit_m * limit_m) continue;
    const Box& box = boxes_[next.box];
    if (box.second == 0) {
      for (std::uint32_t k = box.begin; k < box.end; ++k) search.look_at(pieces_[k], p_W);
      continue;
    }
    // The nearer half first.
    const Open low = open(next.box + 1), high = open(box.second);
    const bool low_first = low.squared_m2 <= high.squared_m2;
    stack[size++] = low_first ? high : low;
    stack[size++] = low_first ? low : high;
  }
  return {search.first.point, search.second.point};
}

}  // namespace vinerow::controllers

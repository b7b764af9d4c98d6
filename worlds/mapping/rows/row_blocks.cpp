#include "worlds/mapping/rows/row_blocks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "engine/core/check.h"
#include "engine/math/planar.h"
#include "engine/math/statistics.h"
#include "worlds/mapping/rows/row_lines.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;

Vector2d chord_of(const RowCurve& row) {
  return row.points_W().back() - row.points_W().front();
}

/// Median distance of `own` from `other`, or null if they are side by side for less than a quarter.
std::optional<double> lateral_distance_m(const RowCurve& own, const RowCurve& other, double low_m,
                                         double high_m) {
  constexpr int kPlaces = 40, kFewest = 10;
  const double parallel = std::cos(6.0 * std::numbers::pi / 180.0);
  std::vector<double> distances_m;
  for (int k = 0; k < kPlaces; ++k) {
    const double s_m = own.length_m() * (k + 0.5) / kPlaces;
    double apart_m = 0.0;
    const double other_m = other.nearest_s_m(own.point_W(s_m), &apart_m);
    if (!(other_m > 0.0 && other_m < other.length_m())) continue;
    if (std::abs(own.direction_W(s_m).dot(other.direction_W(other_m))) < parallel) continue;
    if (apart_m > low_m && apart_m < high_m) distances_m.push_back(apart_m);
  }
  if (distances_m.size() < kFewest) return std::nullopt;
  return upper_median(distances_m);
}

/// `b` behind `a` as one row, where it goes on in its line.
std::optional<RowCurve> joined_rows(const RowCurve& a, RowCurve b, double spacing_m) {
  if (chord_of(a).dot(chord_of(b)) < 0.0) {
    b = RowCurve(std::vector<Vector2d>(b.points_W().rbegin(), b.points_W().rend()));
  }
  const Vector2d end = a.points_W().back(), start = b.points_W().front();
  const Vector2d u = a.direction_W(a.length_m()), v = b.direction_W(0.0);
  const Vector2d gap = start - end;
  if (gap.dot(u) <= 0.0 || gap.dot(v) <= 0.0) return std::nullopt;
  // Each one's line passes the other one's end.
  if (std::abs(gap.dot(left_of(u))) > 0.3 * spacing_m) return std::nullopt;
  if (std::abs(gap.dot(left_of(v))) > 0.3 * spacing_m) return std::nullopt;
  std::vector<Vector2d> points = a.points_W();
  points.insert(points.end(), b.points_W().begin(), b.points_W().end());
  return RowCurve(std::move(points));
}

void join_pieces(RowBlock& block) {
  for (std::size_t i = 0; i < block.rows.size();) {
    bool is_joined = false;
    for (std::size_t j = 0; j < block.rows.size() && !is_joined; ++j) {
      if (j == i) continue;
      auto whole = joined_rows(block.rows[i], block.rows[j], block.spacing_m);
      if (!whole) continue;
      block.rows[i] = std::move(*whole);
      block.rows.erase(block.rows.begin() + static_cast<std::ptrdiff_t>(j));
      is_joined = true;
    }
    i = is_joined ? 0 : i + 1;
  }
}

}  // namespace

double RowBlock::length_m() const {
  return std::accumulate(rows.begin(), rows.end(), 0.0,
                         [](double sum, const RowCurve& row) { return sum + row.length_m(); });
}

RowBlocks split_blocks(const std::vector<RowCurve>& lines, const std::vector<double>& spacing_m) {
  VINEROW_DEMAND(spacing_m.size() == lines.size());
  constexpr double kNearest = 0.5, kFarthest = 2.6;
  std::vector<int> block_of(lines.size(), -1);
  std::vector<std::vector<std::size_t>> members;
  for (std::size_t first = 0; first < lines.size(); ++first) {
    if (block_of[first] >= 0) continue;
    const int id = static_cast<int>(members.size());
    members.push_back({first});
    block_of[first] = id;
    for (std::size_t n = 0; n < members.back().size(); ++n) {
      const std::size_t a = members.back()[n];
      for (std::size_t b = 0; b < lines.size(); ++b) {
        if (block_of[b] >= 0) continue;
        const double pitch_m = std::min(spacing_m[a], spacing_m[b]);
        const bool a_is_shorter = lines[a].length_m() < lines[b].length_m();
        const auto distance_m =
            lateral_distance_m(lines[a_is_shorter ? a : b], lines[a_is_shorter ? b : a],
                               kNearest * pitch_m, kFarthest * pitch_m);
        if (!distance_m) continue;
        block_of[b] = id;
        members.back().push_back(b);
      }
    }
  }
  RowBlocks split;
  for (const std::vector<std::size_t>& of : members) {
    if (of.size() < 2) {
      split.lone.push_back(lines[of.front()]);
      continue;
    }
    RowBlock block;
    std::vector<double> pitches_m;
    // In the lines' order: of a single block nothing changes.
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (block_of[k] != block_of[of.front()]) continue;
      block.rows.push_back(lines[k]);
      pitches_m.push_back(spacing_m[k]);
    }
    block.spacing_m = upper_median(pitches_m);
    join_pieces(block);
    if (block.rows.size() < 2) {
      split.lone.push_back(block.rows.front());
      continue;
    }
    block.rows = order_block(std::move(block.rows));
    split.blocks.push_back(std::move(block));
  }
  std::stable_sort(
      split.blocks.begin(), split.blocks.end(),
      [](const RowBlock& a, const RowBlock& b) { return a.length_m() > b.length_m(); });
  return split;
}

}  // namespace vinerow::mapping

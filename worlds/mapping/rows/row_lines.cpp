#include "worlds/mapping/rows/row_lines.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/math/planar.h"
#include "worlds/mapping/model/row_map.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;

/// Calls visit(x, y, weight) for canopy within `along_m` and `across_m` of p, seen along u.
template <class F>
void for_canopy(const CanopyRaster& raster, const Vector2d& p, const Vector2d& u, double along_m,
                double across_m, F&& visit) {
  const Vector2d n = left_of(u);
  const Vector2d half = along_m * u.cwiseAbs() + across_m * n.cwiseAbs();
  const auto bound = [&](double at, double corner, int count) {
    return std::clamp(static_cast<int>(std::floor((at - corner) / raster.cell_m)), 0, count - 1);
  };
  const int i0 = bound(p.x() - half.x(), raster.corner.x(), raster.columns);
  const int i1 = bound(p.x() + half.x(), raster.corner.x(), raster.columns);
  const int j0 = bound(p.y() - half.y(), raster.corner.y(), raster.rows);
  const int j1 = bound(p.y() + half.y(), raster.corner.y(), raster.rows);
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const double weight = raster.weights[static_cast<std::size_t>(j) * raster.columns + i];
      if (weight <= 0.0) continue;
      const Vector2d d = raster.middle_of(i, j) - p;
      const double x = d.dot(u), y = d.dot(n);
      if (std::abs(x) <= along_m && std::abs(y) <= across_m) visit(x, y, weight);
    }
  }
}

struct Centre {
  Vector2d p;
  double weight;
};

/// Middle of the canopy beside every metre of a line; places without canopy are left out.
std::vector<Centre> centres_along(const CanopyRaster& raster, const RowCurve& line,
                                  double across_m) {
  std::vector<Centre> centres;
  const int count = std::max(2, static_cast<int>(std::lround(line.length_m())) + 1);
  for (int k = 0; k < count; ++k) {
    const double s_m = line.length_m() * k / (count - 1);
    const Vector2d p = line.point_W(s_m), u = line.direction_W(s_m);
    double sum = 0.0, x_sum = 0.0, y_sum = 0.0;
    for_canopy(raster, p, u, 0.75, across_m, [&](double x, double y, double weight) {
      sum += weight;
      x_sum += weight * x;
      y_sum += weight * y;
    });
    if (sum <= 1.0) continue;
    centres.push_back({p + x_sum / sum * u + y_sum / sum * left_of(u), sum});
  }
  return centres;
}

/// Drops points that do not lead forward, so that a curve can be laid through the rest.
std::optional<RowCurve> curve_through(const std::vector<Vector2d>& points) {
  std::vector<Vector2d> kept;
  for (const Vector2d& p : points) {
    if (kept.empty() || (p - kept.back()).norm() > 0.2) kept.push_back(p);
  }
  if (kept.size() < 2) return std::nullopt;
  return RowCurve(std::move(kept));
}

struct StraightLine {
  Vector2d middle, u;
  double off_m;  // largest mean over 10 m off it
};

StraightLine straight_through(const std::vector<Centre>& centres) {
  Vector2d middle = Vector2d::Zero();
  double weight = 0.0;
  for (const Centre& c : centres) {
    middle += c.weight * c.p;
    weight += c.weight;
  }
  middle /= weight;
  // Least squares across the line: the eigenvector of the larger spread.
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Centre& c : centres) {
    const Vector2d d = c.p - middle;
    xx += c.weight * d.x() * d.x();
    xy += c.weight * d.x() * d.y();
    yy += c.weight * d.y() * d.y();
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  StraightLine line{middle, {std::cos(angle), std::sin(angle)}, 0.0};
  const Vector2d way = centres.back().p - centres.front().p;
  if (way.dot(line.u) < 0.0) line.u = -line.u;
  double sum = 0.0, sum_weight = 0.0;
  double from_m = (centres.front().p - middle).dot(line.u);
  for (std::size_t k = 0; k <= centres.size(); ++k) {
    const bool is_end = k == centres.size();
    const double s_m = is_end ? 0.0 : (centres[k].p - middle).dot(line.u);
    if (is_end || s_m - from_m > 10.0) {
      // The last stretch may be short and says less.
      if (sum_weight > 0.0 && (!is_end || line.off_m == 0.0)) {
        line.off_m = std::max(line.off_m, std::abs(sum / sum_weight));
      }
      sum = sum_weight = 0.0;
      from_m = s_m;
    }
    if (is_end) break;
    sum += centres[k].weight * (centres[k].p - middle).dot(left_of(line.u));
    sum_weight += centres[k].weight;
  }
  return line;
}

/// A line by parabolas through the middles up to 8 m to each side, the near ones the heavier, at
/// every 2 m.
std::vector<Vector2d> smoothed(const RowCurve& line, const std::vector<Centre>& centres) {
  constexpr double kPitch_m = 2.0, kReach_m = 8.0;
  std::vector<double> at_m;
  for (const Centre& c : centres) at_m.push_back(line.nearest_s_m(c.p));
  const int count = std::max(2, static_cast<int>(std::lround(line.length_m() / kPitch_m)) + 1);
  std::vector<Vector2d> points;
  for (int k = 0; k < count; ++k) {
    const double s_m = line.length_m() * k / (count - 1);
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> sums = Eigen::Matrix<double, 3, 2>::Zero();
    const Vector2d here = line.point_W(s_m);
    double low_m = 0.0, high_m = 0.0;
    for (std::size_t n = 0; n < centres.size(); ++n) {
      const double x = at_m[n] - s_m, share = std::abs(x) / kReach_m;
      if (share >= 1.0) continue;
      const double bell = 1.0 - share * share;
      const Eigen::Vector3d powers(1.0, x, x * x);
      moments += centres[n].weight * bell * bell * powers * powers.transpose();
      sums += centres[n].weight * bell * bell * powers * (centres[n].p - here).transpose();
      low_m = std::min(low_m, x), high_m = std::max(high_m, x);
    }
    // Too few places, or all to one side: a parabola would swing out.
    const bool is_bent = low_m < -2.0 && high_m > 2.0;
    if (!is_bent) moments(2, 2) += 1e9;
    moments.diagonal().array() += 1e-9;
    const Vector2d off = moments.ldlt().solve(sums).row(0).transpose();
    points.push_back(here + (off.norm() < 1.0 ? off : Vector2d::Zero()));
  }
  return points;
}

/// Places along a line where the alleys beside it are no emptier than the row itself, and than they
/// are elsewhere on this line: a tree's crown, or a hedge across.
/// @param core,beside  canopy on the line and in the alleys' half beside it, step by step
std::vector<bool> find_wide(const std::vector<double>& core, const std::vector<double>& beside,
                            int run) {
  constexpr double kWide = 0.6, kTimesUsual = 2.0;
  std::vector<double> shares(core.size(), 0.0), usual;
  for (std::size_t k = 0; k < core.size(); ++k) {
    const auto reach = static_cast<std::size_t>(run / 2);
    double on_line = 0.0, off_line = 0.0;
    for (std::size_t n = k > reach ? k - reach : 0; n <= std::min(core.size() - 1, k + reach);
         ++n) {
      on_line += core[n];
      off_line += beside[n];
    }
    if (on_line <= 0.0) continue;
    shares[k] = off_line / on_line;
    usual.push_back(shares[k]);
  }
  if (usual.empty()) return std::vector<bool>(core.size(), false);
  const auto middle = usual.begin() + static_cast<std::ptrdiff_t>(usual.size() / 2);
  std::nth_element(usual.begin(), middle, usual.end());
  const double least = std::max(kWide, kTimesUsual * *middle);
  std::vector<bool> is_wide(core.size());
  for (std::size_t k = 0; k < core.size(); ++k) is_wide[k] = shares[k] > least;
  return is_wide;
}

/// The stretch of a line from its first canopy to its last, looked for a little beyond its ends.
std::optional<std::pair<double, double>> canopy_stretch(const CanopyRaster& raster,
                                                        const RowCurve& line, double across_m,
                                                        double half_alley_m) {
  constexpr double kBeyond_ends_m = 4.0, kLongest_gap_m = 2.0;
  const double kBin_along_m = std::max(0.1, raster.cell_m);
  const int bins =
      static_cast<int>(std::ceil((line.length_m() + 2.0 * kBeyond_ends_m) / kBin_along_m));
  std::vector<double> weights(static_cast<std::size_t>(bins), 0.0);
  std::vector<double> core(weights.size(), 0.0), beside(weights.size(), 0.0);
  for (int k = 0; k < bins; ++k) {
    const auto bin = static_cast<std::size_t>(k);
    const double s_m = -kBeyond_ends_m + (k + 0.5) * kBin_along_m;
    for_canopy(raster, line.point_W(s_m), line.direction_W(s_m), 0.5 * kBin_along_m, half_alley_m,
               [&](double, double y, double weight) {
                 if (std::abs(y) <= across_m) weights[bin] += weight;
                 (std::abs(y) < 0.4 * half_alley_m ? core : beside)[bin] += weight;
               });
  }
  std::vector<double> sorted;
  for (const double w : weights) {
    if (w > 0.0) sorted.push_back(w);
  }
  if (sorted.empty()) return std::nullopt;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double least = 0.45 * sorted[sorted.size() / 2];
  // Canopy of 0.6 m in one piece counts: a vine, and not a post or the stay behind the last one.
  std::vector<bool> is_canopy(weights.size());
  for (std::size_t k = 0; k < weights.size(); ++k) is_canopy[k] = weights[k] >= least;
  const int kRun = std::max(3, static_cast<int>(std::lround(0.6 / kBin_along_m)));
  const std::vector<bool> is_wide = find_wide(core, beside, kRun);
  for (std::size_t k = 0; k < weights.size(); ++k) is_canopy[k] = is_canopy[k] && !is_wide[k];
  int first = -1, last = -1;
  const int middle = bins / 2;
  const auto run_at = [&](int from) {
    int count = 0;
    for (int k = from; k < std::min(bins, from + kRun); ++k) {
      count += is_canopy[static_cast<std::size_t>(k)] ? 1 : 0;
    }
    return count >= kRun;
  };
  // Beyond the track's own end only what hangs together with it.
  const int track_first = static_cast<int>(kBeyond_ends_m / kBin_along_m);
  const int track_last = bins - 1 - track_first;
  int gap = 0;
  for (int k = track_first + 20; k >= 0 && gap <= static_cast<int>(kLongest_gap_m / kBin_along_m);
       --k) {
    if (k <= middle && run_at(k)) {
      first = k;
      gap = 0;
    } else if (k < track_first) {
      ++gap;
    }
  }
  gap = 0;
  for (int k = std::max(0, track_last - 20);
       k + kRun <= bins && gap <= static_cast<int>(kLongest_gap_m / kBin_along_m); ++k) {
    if (k >= middle - kRun && run_at(k)) {
      last = k + kRun;
      gap = 0;
    } else if (k > track_last) {
      ++gap;
    }
  }
  if (first < 0) {
    for (int k = track_first; k < bins && first < 0; ++k) {
      if (run_at(k)) first = k;
    }
  }
  if (last < 0) {
    for (int k = track_last - kRun; k >= 0 && last < 0; --k) {
      if (run_at(k)) last = k + kRun;
    }
  }
  if (first < 0 || last <= first) return std::nullopt;
  return std::pair{-kBeyond_ends_m + first * kBin_along_m, -kBeyond_ends_m + last * kBin_along_m};
}

std::optional<RowCurve> cut_to(const RowCurve& line, double from_m, double to_m) {
  std::vector<Vector2d> points{line.point_W(from_m)};
  double s_m = 0.0;
  const bool is_straight = line.points_W().size() == 2;
  for (std::size_t k = 0; !is_straight && k < line.points_W().size(); ++k) {
    if (k > 0) s_m += (line.points_W()[k] - line.points_W()[k - 1]).norm();
    if (s_m > from_m + 0.5 && s_m < to_m - 0.5) points.push_back(line.points_W()[k]);
  }
  points.push_back(line.point_W(to_m));
  return curve_through(points);
}

/// Whether canopy stands along most of a line and not where the alleys beside it would be. Bushes
/// on a meadow can be joined by a line too.
bool is_row_like(const CanopyRaster& raster, const RowCurve& line, double spacing_m) {
  constexpr double kCovered = 0.45, kContrast = 3.0;
  const int count = std::max(2, static_cast<int>(line.length_m()));
  int covered = 0;
  double row = 0.0, beside = 0.0;
  for (int k = 0; k < count; ++k) {
    const double s_m = line.length_m() * (k + 0.5) / count;
    double here = 0.0;
    for_canopy(raster, line.point_W(s_m), line.direction_W(s_m), 0.5, 0.6 * spacing_m,
               [&](double, double y, double weight) {
                 if (std::abs(y) < 0.2 * spacing_m) here += weight;
                 if (std::abs(y) > 0.4 * spacing_m) beside += weight;
               });
    row += here;
    // A tenth of a square metre in this metre.
    covered += here * raster.cell_m * raster.cell_m > 0.1 ? 1 : 0;
  }
  return covered >= kCovered * count && row > kContrast * beside;
}

/// The line through the middles of the canopy beside a first guess.
std::optional<RowCurve> fit_curve(const CanopyRaster& raster, const RowCurve& guess,
                                  double across_m) {
  constexpr double kStraight_m = 0.06;
  std::optional<RowCurve> line = guess;
  for (int round = 0; round < 4; ++round) {
    const std::vector<Centre> centres = centres_along(raster, *line, across_m);
    if (centres.size() < 3) return std::nullopt;
    const StraightLine straight = straight_through(centres);
    if (straight.off_m < kStraight_m) {
      const double from_m = (centres.front().p - straight.middle).dot(straight.u);
      const double to_m = (centres.back().p - straight.middle).dot(straight.u);
      if (to_m - from_m < 1.0) return std::nullopt;
      line = RowCurve({straight.middle + from_m * straight.u, straight.middle + to_m * straight.u});
    } else {
      line = curve_through(smoothed(*line, centres));
      if (!line) return std::nullopt;
    }
  }
  return line;
}

std::optional<RowCurve> fit_line(const CanopyRaster& raster, const RowTrack& track,
                                 const RowLineOptions& options) {
  const double across_m = 0.4 * options.spacing_m, half_alley_m = 0.5 * options.spacing_m;
  auto line = curve_through(track);
  if (line) line = fit_curve(raster, *line, across_m);
  if (!line) return std::nullopt;
  auto stretch = canopy_stretch(raster, *line, across_m, half_alley_m);
  // What is cut off was no row, and has drawn the line to itself.
  constexpr double kCutOff_m = 1.5;
  if (stretch && (stretch->first > kCutOff_m || line->length_m() - stretch->second > kCutOff_m)) {
    line = cut_to(*line, stretch->first, stretch->second);
    if (line) line = fit_curve(raster, *line, across_m);
    if (!line) return std::nullopt;
    stretch = canopy_stretch(raster, *line, across_m, half_alley_m);
  }
  if (!stretch || stretch->second - stretch->first < options.length_low_m) return std::nullopt;
  auto row = cut_to(*line, stretch->first, stretch->second);
  if (row && !is_row_like(raster, *row, options.spacing_m)) return std::nullopt;
  return row;
}

/// Whether another line runs beside this one, at a row's distance.
bool has_neighbour(const std::vector<RowCurve>& lines, std::size_t index, double spacing_m) {
  constexpr double kParallel = 0.94;  // 20 degrees
  const RowCurve& own = lines[index];
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (k == index) continue;
    int beside = 0, looked = 0;
    for (double share = 0.05; share < 1.0; share += 0.1) {
      const double s_m = share * own.length_m();
      double apart_m = 0.0;
      const double other_m = lines[k].nearest_s_m(own.point_W(s_m), &apart_m);
      const bool is_parallel =
          std::abs(own.direction_W(s_m).dot(lines[k].direction_W(other_m))) > kParallel;
      beside += is_parallel && apart_m > 0.6 * spacing_m && apart_m < 1.6 * spacing_m ? 1 : 0;
      ++looked;
    }
    if (3 * beside >= looked) return true;
  }
  return false;
}

}  // namespace

std::vector<RowCurve> fit_row_lines(const CanopyRaster& raster, const std::vector<RowTrack>& tracks,
                                    const RowLineOptions& options) {
  std::vector<RowCurve> lines;
  for (const RowTrack& track : tracks) {
    if (auto line = fit_line(raster, track, options)) lines.push_back(std::move(*line));
  }
  std::vector<RowCurve> rows;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (has_neighbour(lines, k, options.spacing_m)) rows.push_back(lines[k]);
  }
  return rows.empty() ? rows : order_block(std::move(rows));
}

std::vector<RowCurve> order_block(std::vector<RowCurve> rows) {
  // The longest first, from south to north: what order_rows() takes the direction from.
  std::stable_sort(rows.begin(), rows.end(), [](const RowCurve& a, const RowCurve& b) {
    return a.length_m() > b.length_m();
  });
  const Vector2d way = rows[0].points_W().back() - rows[0].points_W().front();
  const bool is_southward = way.y() < 0.0 || (way.y() == 0.0 && way.x() < 0.0);
  if (is_southward) {
    std::vector<Vector2d> points(rows[0].points_W().rbegin(), rows[0].points_W().rend());
    rows[0] = RowCurve(std::move(points));
  }
  // In order across the block, so that the first one given is the first one kept.
  const Vector2d n =
      -left_of((rows[0].points_W().back() - rows[0].points_W().front()).normalized());
  const auto place = [&](const RowCurve& row) { return row.point_W(0.5 * row.length_m()).dot(n); };
  const RowCurve guide = rows[0];
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const RowCurve& a, const RowCurve& b) { return place(a) < place(b); });
  for (RowCurve& row : rows) {
    const Vector2d own = row.points_W().back() - row.points_W().front();
    if (own.dot(guide.points_W().back() - guide.points_W().front()) >= 0.0) continue;
    std::vector<Vector2d> points(row.points_W().rbegin(), row.points_W().rend());
    row = RowCurve(std::move(points));
  }
  return order_rows(std::move(rows));
}

}  // namespace vinerow::mapping

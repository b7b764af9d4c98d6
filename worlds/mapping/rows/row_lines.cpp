#include "worlds/mapping/rows/row_lines.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/math/planar.h"
#include "engine/math/statistics.h"
#include "worlds/mapping/model/row_map.h"

// Plan, for each track:
//
//   1. Centres. Every metre of the line, c = weighted mean of the canopy squares in a window of
//      1.5 m x 2 across_m, with the raster's weights w.
//   2. Line. Straight if no mean_m mean of the centres is farther than straight_m from the total
//      least squares line; else locally weighted parabolas p(x) = b0 + b1 x + b2 x^2 through the
//      centres (one per coordinate), evaluated at x = 0 every kPitch_m. Steps 1 and 2 are repeated,
//      because a better line moves the windows.
//   3. Ends. The line is cut to the canopy along it (canopy_stretch). If more than cut_off_m is cut
//      off, steps 1 to 3 are repeated without the part that was cut off.
//   4. Checks: length, canopy along the line and free alleys (is_row_like), and at last, among all
//      lines, a parallel neighbour (has_neighbour).
//
// x is along a line and y to its left, with unit vectors u and n. Weights are counts of squares: 1
// is an average square of canopy (CanopyRaster). Thresholds in shares of the row spacing scale
// with the vineyard: RowLineOptions.

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;

/// Calls visit(x, y, weight) for every square of canopy with |x| <= along_m and |y| <= across_m,
/// x along u and y to its left, from p.
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

/// Weighted mean position of the canopy in one window.
struct Centre {
  Vector2d p;
  double weight;
};

/// Centres of the canopy at every metre of a line. Windows without canopy give none.
std::vector<Centre> centres_along(const CanopyRaster& raster, const RowCurve& line, double across_m,
                                  const RowLineOptions& options) {
  std::vector<Centre> centres;
  const int count = std::max(2, static_cast<int>(std::lround(line.length_m())) + 1);
  for (int k = 0; k < count; ++k) {
    const double s_m = line.length_m() * k / (count - 1);
    const Vector2d p = line.point_W(s_m), u = line.direction_W(s_m);
    double sum = 0.0, x_sum = 0.0, y_sum = 0.0;
    for_canopy(raster, p, u, options.half_window_m, across_m,
               [&](double x, double y, double weight) {
                 sum += weight;
                 x_sum += weight * x;
                 y_sum += weight * y;
               });
    if (sum <= options.min_weight) continue;
    centres.push_back({p + x_sum / sum * u + y_sum / sum * left_of(u), sum});
  }
  return centres;
}

/// Curve through points that are far enough apart; null if fewer than two are.
std::optional<RowCurve> curve_through(const std::vector<Vector2d>& points) {
  // Chosen: two raster squares of 0.1 m; the direction between closer points is noise.
  constexpr double kMinApart_m = 0.2;
  std::vector<Vector2d> kept;
  for (const Vector2d& p : points) {
    if (kept.empty() || (p - kept.back()).norm() > kMinApart_m) kept.push_back(p);
  }
  if (kept.size() < 2) return std::nullopt;
  return RowCurve(std::move(kept));
}

struct StraightLine {
  Vector2d middle, u;
  double off_m;  // largest distance of a mean_m mean of the centres from the line
};

/// Total least squares line: minimises sum w (n . (c - middle))^2. With the second moments xx, xy,
/// yy about the weighted mean, its angle is 1/2 atan2(2 xy, xx - yy).
StraightLine straight_through(const std::vector<Centre>& centres, double mean_m) {
  Vector2d middle = Vector2d::Zero();
  double weight = 0.0;
  for (const Centre& c : centres) {
    middle += c.weight * c.p;
    weight += c.weight;
  }
  middle /= weight;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Centre& c : centres) {
    const Vector2d d = c.p - middle;
    xx += c.weight * d.x() * d.x();
    xy += c.weight * d.x() * d.y();
    yy += c.weight * d.y() * d.y();
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  StraightLine line{middle, {std::cos(angle), std::sin(angle)}, 0.0};
  const Vector2d displacement = centres.back().p - centres.front().p;
  if (displacement.dot(line.u) < 0.0) line.u = -line.u;
  // off_m = max |sum w y / sum w| over consecutive pieces of mean_m.
  double sum = 0.0, sum_weight = 0.0;
  double from_m = (centres.front().p - middle).dot(line.u);
  for (std::size_t k = 0; k <= centres.size(); ++k) {
    const bool is_end = k == centres.size();
    const double s_m = is_end ? 0.0 : (centres[k].p - middle).dot(line.u);
    if (is_end || s_m - from_m > mean_m) {
      // The last piece may be short and its mean noisy: it counts only if it is the only one.
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

/// Locally weighted parabolas. At each s, b = argmin sum w (1 - (x / smooth_reach_m)^2)^2
/// |c - here - b0 - b1 x - b2 x^2|^2 with x the centre's distance along the line; the point is
/// here + b0. `moments` b = `sums` are the normal equations.
std::vector<Vector2d> smoothed(const RowCurve& line, const std::vector<Centre>& centres,
                               const RowLineOptions& options) {
  // Chosen: a point every 2 m follows what a window of 16 m can resolve.
  constexpr double kPitch_m = 2.0;
  // Added to the normal equations. With squares of 0.1 m the sums of w x^4 stay below 1e6 m^4, so
  // that 1e9 forces b2 to 0; 1e-9 keeps the matrix regular with a single centre.
  constexpr double kNoBend = 1e9, kRegular = 1e-9;
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
      const double x = at_m[n] - s_m, share = std::abs(x) / options.smooth_reach_m;
      if (share >= 1.0) continue;
      const double bell = 1.0 - share * share;
      const Eigen::Vector3d powers(1.0, x, x * x);
      moments += centres[n].weight * bell * bell * powers * powers.transpose();
      sums += centres[n].weight * bell * bell * powers * (centres[n].p - here).transpose();
      low_m = std::min(low_m, x), high_m = std::max(high_m, x);
    }
    // Few centres, or all to one side: a parabola would swing out, so a straight line is fitted.
    const bool is_bent = low_m < -options.min_side_m && high_m > options.min_side_m;
    if (!is_bent) moments(2, 2) += kNoBend;
    moments.diagonal().array() += kRegular;
    const Vector2d off = moments.ldlt().solve(sums).row(0).transpose();
    points.push_back(here + (off.norm() < options.max_shift_m ? off : Vector2d::Zero()));
  }
  return points;
}

/// Bins of a line at which the canopy is too wide for a row: a tree's crown, or a hedge across. In
/// a window of `run` bins around each, share = sum(beside) / sum(core); wide is a share above
/// max(wide, wide_over * median share of the line).
/// @param core,beside  canopy on the line and in the half alleys beside it, for each bin
std::vector<bool> find_wide(const std::vector<double>& core, const std::vector<double>& alley,
                            int run, const RowLineOptions& options) {
  std::vector<double> shares(core.size(), 0.0), usual;
  for (std::size_t k = 0; k < core.size(); ++k) {
    const auto reach = static_cast<std::size_t>(run / 2);
    double on_line = 0.0, off_line = 0.0;
    for (std::size_t n = k > reach ? k - reach : 0; n <= std::min(core.size() - 1, k + reach);
         ++n) {
      on_line += core[n];
      off_line += alley[n];
    }
    if (on_line <= 0.0) continue;
    shares[k] = off_line / on_line;
    usual.push_back(shares[k]);
  }
  if (usual.empty()) return std::vector<bool>(core.size(), false);
  const double threshold = std::max(options.wide, options.wide_over * upper_median(usual));
  std::vector<bool> is_wide(core.size());
  for (std::size_t k = 0; k < core.size(); ++k) is_wide[k] = shares[k] > threshold;
  return is_wide;
}

/// Stretch [from, to] of a line, in m from its start, from its first canopy to its last; it may
/// begin before 0 and end beyond the line.
///
/// The line, extended by beyond_ends_m, is divided into bins. A bin is canopy if its weight is at
/// least `low` times the median of the bins that hold any, and it is not too wide (find_wide). A
/// run is kRun bins of canopy in a row. Each end is searched outwards from a little inside the
/// track's end, until a gap beyond that end exceeds longest_gap_m; the outermost run found is the
/// end. Without one the search goes inwards from the track's end.
std::optional<std::pair<double, double>> canopy_stretch(const CanopyRaster& raster,
                                                        const RowCurve& line, double across_m,
                                                        double half_alley_m,
                                                        const RowLineOptions& options) {
  const double beyond_m = options.beyond_ends_m;
  // Bins are as long as a raster square, and at least 0.1 m.
  constexpr double kMinBin_m = 0.1;
  const double kBin_along_m = std::max(kMinBin_m, raster.cell_m);
  // Chosen: three bins, so that one noisy square makes no run.
  constexpr int kMinRun_bins = 3;
  // Chosen: the search starts this far inside the track (2 m in bins of 0.1 m).
  constexpr int kInside_bins = 20;
  const int bins = static_cast<int>(std::ceil((line.length_m() + 2.0 * beyond_m) / kBin_along_m));
  std::vector<double> weights(static_cast<std::size_t>(bins), 0.0);
  std::vector<double> core(weights.size(), 0.0), alley(weights.size(), 0.0);
  for (int k = 0; k < bins; ++k) {
    const auto bin = static_cast<std::size_t>(k);
    const double s_m = -beyond_m + (k + 0.5) * kBin_along_m;
    for_canopy(raster, line.point_W(s_m), line.direction_W(s_m), 0.5 * kBin_along_m, half_alley_m,
               [&](double, double y, double weight) {
                 if (std::abs(y) <= across_m) weights[bin] += weight;
                 (std::abs(y) < options.core * half_alley_m ? core : alley)[bin] += weight;
               });
  }
  // Median weight of the bins that hold canopy.
  std::vector<double> sorted;
  for (const double w : weights) {
    if (w > 0.0) sorted.push_back(w);
  }
  if (sorted.empty()) return std::nullopt;
  const double threshold = options.low * upper_median(sorted);
  std::vector<bool> is_canopy(weights.size());
  for (std::size_t k = 0; k < weights.size(); ++k) is_canopy[k] = weights[k] >= threshold;
  const int kRun =
      std::max(kMinRun_bins, static_cast<int>(std::lround(options.run_m / kBin_along_m)));
  const std::vector<bool> is_wide = find_wide(core, alley, kRun, options);
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
  // Outwards from both ends of the track. Gaps count beyond its ends only: inside the track they
  // are missing vines.
  const int track_first = static_cast<int>(beyond_m / kBin_along_m);
  const int track_last = bins - 1 - track_first;
  const int longest_gap = static_cast<int>(options.longest_gap_m / kBin_along_m);
  int gap = 0;
  for (int k = track_first + kInside_bins; k >= 0 && gap <= longest_gap; --k) {
    if (k <= middle && run_at(k)) {
      first = k;
      gap = 0;
    } else if (k < track_first) {
      ++gap;
    }
  }
  gap = 0;
  for (int k = std::max(0, track_last - kInside_bins); k + kRun <= bins && gap <= longest_gap;
       ++k) {
    if (k >= middle - kRun && run_at(k)) {
      last = k + kRun;
      gap = 0;
    } else if (k > track_last) {
      ++gap;
    }
  }
  // Inwards if the track's ends are on no canopy.
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
  return std::pair{-beyond_m + first * kBin_along_m, -beyond_m + last * kBin_along_m};
}

/// The line from `from_m` to `to_m`, which may be beyond its ends; null if that is too short.
std::optional<RowCurve> cut_to(const RowCurve& line, double from_m, double to_m) {
  // Chosen: a point of the line closer than this to a new end would bend the curve there.
  constexpr double kEndClearance_m = 0.5;
  std::vector<Vector2d> points{line.point_W(from_m)};
  double s_m = 0.0;
  const bool is_straight = line.points_W().size() == 2;
  for (std::size_t k = 0; !is_straight && k < line.points_W().size(); ++k) {
    if (k > 0) s_m += (line.points_W()[k] - line.points_W()[k - 1]).norm();
    if (s_m > from_m + kEndClearance_m && s_m < to_m - kEndClearance_m) {
      points.push_back(line.points_W()[k]);
    }
  }
  points.push_back(line.point_W(to_m));
  return curve_through(points);
}

/// True if enough of the line's metres hold canopy and the line holds more than `contrast` times
/// the canopy of the alleys beside it. Lines through bushes on a meadow fail.
bool is_row_like(const CanopyRaster& raster, const RowCurve& line, const RowLineOptions& options) {
  constexpr double kHalfMetre_m = 0.5;  // windows along the line abut
  const double spacing_m = options.spacing_m;
  const int count = std::max(2, static_cast<int>(line.length_m()));
  int covered = 0;
  double row = 0.0, alley = 0.0;
  for (int k = 0; k < count; ++k) {
    const double s_m = line.length_m() * (k + 0.5) / count;
    double here = 0.0;
    for_canopy(raster, line.point_W(s_m), line.direction_W(s_m), kHalfMetre_m,
               options.alley_to * spacing_m, [&](double, double y, double weight) {
                 if (std::abs(y) < options.row_share * spacing_m) here += weight;
                 if (std::abs(y) > options.alley_from * spacing_m) alley += weight;
               });
    row += here;
    covered += here * raster.cell_m * raster.cell_m > options.min_canopy_m2 ? 1 : 0;
  }
  return covered >= options.covered * count && row > options.contrast * alley;
}

/// Line through the centres of the canopy along a first guess (steps 1 and 2); null if there is too
/// little canopy.
std::optional<RowCurve> fit_curve(const CanopyRaster& raster, const RowCurve& guess,
                                  double across_m, const RowLineOptions& options) {
  constexpr int kRounds = 4;              // chosen: enough for the windows to settle on the row
  constexpr std::size_t kMinCentres = 3;  // a parabola has three unknowns
  constexpr double kMinLength_m = 1.0;    // chosen: the pitch of the centres
  std::optional<RowCurve> line = guess;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Centre> centres = centres_along(raster, *line, across_m, options);
    if (centres.size() < kMinCentres) return std::nullopt;
    const StraightLine straight = straight_through(centres, options.mean_m);
    if (straight.off_m < options.straight_m) {
      const double from_m = (centres.front().p - straight.middle).dot(straight.u);
      const double to_m = (centres.back().p - straight.middle).dot(straight.u);
      if (to_m - from_m < kMinLength_m) return std::nullopt;
      line = RowCurve({straight.middle + from_m * straight.u, straight.middle + to_m * straight.u});
    } else {
      line = curve_through(smoothed(*line, centres, options));
      if (!line) return std::nullopt;
    }
  }
  return line;
}

/// Steps 1 to 4 for one track, without the neighbour; null if it is no row.
std::optional<RowCurve> fit_line(const CanopyRaster& raster, const RowTrack& track,
                                 const RowLineOptions& options) {
  constexpr double kHalfAlley = 0.5;  // of the spacing: the middle of the alley
  const double across_m = options.across * options.spacing_m;
  const double half_alley_m = kHalfAlley * options.spacing_m;
  auto line = curve_through(track);
  if (line) line = fit_curve(raster, *line, across_m, options);
  if (!line) return std::nullopt;
  auto stretch = canopy_stretch(raster, *line, across_m, half_alley_m, options);
  // The part that is cut off was no row and has drawn the line towards it: fit again without it.
  if (stretch && (stretch->first > options.cut_off_m ||
                  line->length_m() - stretch->second > options.cut_off_m)) {
    line = cut_to(*line, stretch->first, stretch->second);
    if (line) line = fit_curve(raster, *line, across_m, options);
    if (!line) return std::nullopt;
    stretch = canopy_stretch(raster, *line, across_m, half_alley_m, options);
  }
  if (!stretch || stretch->second - stretch->first < options.length_low_m) return std::nullopt;
  auto row = cut_to(*line, stretch->first, stretch->second);
  if (row && !is_row_like(raster, *row, options)) return std::nullopt;
  return row;
}

/// True if another line is parallel to this one and about a row spacing away, at a third of ten
/// places along this one at least.
bool has_neighbour(const std::vector<RowCurve>& lines, std::size_t index,
                   const RowLineOptions& options) {
  constexpr double kParallel = 0.94;  // cosine of 20 degrees, chosen
  const double near_m = options.neighbour_near * options.spacing_m;
  const double far_m = options.neighbour_far * options.spacing_m;
  constexpr double kFirstShare = 0.05, kShareStep = 0.1;  // ten places, from 5 % to 95 %
  constexpr int kOneIn = 3;  // chosen: the neighbour may be shorter, or have a gap
  const RowCurve& own = lines[index];
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (k == index) continue;
    int alley = 0, looked = 0;
    for (double share = kFirstShare; share < 1.0; share += kShareStep) {
      const double s_m = share * own.length_m();
      double apart_m = 0.0;
      const double other_m = lines[k].nearest_s_m(own.point_W(s_m), &apart_m);
      const bool is_parallel =
          std::abs(own.direction_W(s_m).dot(lines[k].direction_W(other_m))) > kParallel;
      alley += is_parallel && apart_m > near_m && apart_m < far_m ? 1 : 0;
      ++looked;
    }
    if (kOneIn * alley >= looked) return true;
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
    if (has_neighbour(lines, k, options)) rows.push_back(lines[k]);
  }
  return rows.empty() ? rows : order_block(std::move(rows));
}

std::vector<RowCurve> order_block(std::vector<RowCurve> rows) {
  // The longest first, from south to north: order_rows() takes the direction from it.
  std::stable_sort(rows.begin(), rows.end(), [](const RowCurve& a, const RowCurve& b) {
    return a.length_m() > b.length_m();
  });
  const Vector2d displacement = rows[0].points_W().back() - rows[0].points_W().front();
  const bool is_southward =
      displacement.y() < 0.0 || (displacement.y() == 0.0 && displacement.x() < 0.0);
  if (is_southward) {
    std::vector<Vector2d> points(rows[0].points_W().rbegin(), rows[0].points_W().rend());
    rows[0] = RowCurve(std::move(points));
  }
  // Sorted across the block, so that the first row given to order_rows() stays the first.
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

#include "worlds/mapping/rows/row_tracking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/math/planar.h"

// Plan
//
// Seeds are the rows of the windows. From a seed p with direction u, with n to the left of u, each
// step goes kTrackStep_m ahead and then onto the line y = across_m + slope x through the canopy
// around it (x along u, y along n). That line is a regularised weighted least squares fit: with
// weights w of the raster squares, tapered by exp(-y^2 / (2 sigma^2)), it minimises
//
//   sum w (y - across_m - slope x)^2 + hold (centre_hold across_m^2 + along_m^2 slope^2),
//
// so that sparse canopy keeps the track straight. `hold` is the canopy that a full row has, taken
// from the nine steps around the seed. The normal equations are, with s = sum w, sx = sum w x, ...,
//
//   [s + centre_hold hold   sx                     ] [across_m]   [sy ]
//   [sx                     sxx + along_m^2 hold   ] [slope   ] = [sxy].
//
// A track ends at a taken square, at the raster's edge, or after too long a gap. Then the pieces of
// one row are joined (join_tracks), the shortest gap first. Thresholds: RowTrackingOptions.

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;

// Chosen: about the distance between vines.
constexpr double kTrackStep_m = 1.0;

/// Line through the canopy around a place.
struct Fit {
  double weight = 0.0;  // of the canopy within half a step of the place
  double across_m = 0.0;
  double slope = 0.0;
};

void take_around(const CanopyRaster& raster, const Vector2d& p, double reach_m,
                 TakenSquares& taken) {
  const int reach = static_cast<int>(std::ceil(reach_m / raster.cell_m));
  const int i = static_cast<int>((p.x() - raster.corner.x()) / raster.cell_m);
  const int j = static_cast<int>((p.y() - raster.corner.y()) / raster.cell_m);
  for (int v = std::max(0, j - reach); v <= std::min(raster.rows - 1, j + reach); ++v) {
    for (int h = std::max(0, i - reach); h <= std::min(raster.columns - 1, i + reach); ++h) {
      if ((raster.middle_of(h, v) - p).norm() > reach_m) continue;
      taken[static_cast<std::size_t>(v) * raster.columns + h] = 1;
    }
  }
}

class Tracker {
 public:
  Tracker(const CanopyRaster& raster, const RowTrackingOptions& options, const TakenSquares& taken)
      : raster_(raster), options_(options), taken_(taken) {
    taken_.resize(raster.weights.size(), 0);
  }

  std::vector<RowTrack> run(const std::vector<RowPatch>& patches) {
    std::vector<const RowPatch*> order;
    for (const RowPatch& patch : patches) order.push_back(&patch);
    std::stable_sort(order.begin(), order.end(), [](const RowPatch* a, const RowPatch* b) {
      return a->likelihood * a->canopy_m2 > b->likelihood * b->canopy_m2;
    });
    std::vector<RowTrack> tracks;
    for (const RowPatch* patch : order) {
      const Vector2d u(std::cos(patch->angle_rad), std::sin(patch->angle_rad));
      for (const double offset_m : patch->offsets_m) {
        if (auto track = from_seed(patch->middle + offset_m * left_of(u), u)) {
          take(*track);
          tracks.push_back(std::move(*track));
        }
      }
    }
    return tracks;
  }

 private:
  double reach_m() const { return options_.row_reach * options_.spacing_m; }

  bool is_taken(const Vector2d& p) const {
    const std::int64_t cell = raster_.cell_of(p.x(), p.y());
    return cell < 0 || taken_[static_cast<std::size_t>(cell)] != 0;
  }

  /// Line through the canopy up to along_m before and behind `p`, regularised towards `p` and `u`
  /// by the canopy of a full row.
  Fit fit(const Vector2d& p, const Vector2d& u, double full_weight) const {
    // Keeps the equations regular when nothing is known of the row, and no canopy is there.
    constexpr double kMinHold = 1e-6;
    const Vector2d n = left_of(u);
    const double along_m = options_.along_m, half_m = along_m + reach_m();
    const auto bound = [&](double at, double corner, int count) {
      return std::pair{
          std::clamp(static_cast<int>((at - half_m - corner) / raster_.cell_m), 0, count - 1),
          std::clamp(static_cast<int>((at + half_m - corner) / raster_.cell_m), 0, count - 1)};
    };
    const auto [i0, i1] = bound(p.x(), raster_.corner.x(), raster_.columns);
    const auto [j0, j1] = bound(p.y(), raster_.corner.y(), raster_.rows);
    const double sigma_m = options_.sigma * reach_m();
    double s = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    Fit result;
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        const double weight = raster_.weights[static_cast<std::size_t>(j) * raster_.columns + i];
        if (weight <= 0.0) continue;
        const Vector2d d = raster_.middle_of(i, j) - p;
        const double x = d.dot(u), y = d.dot(n);
        if (std::abs(x) > along_m || std::abs(y) > reach_m()) continue;
        const double w = weight * std::exp(-0.5 * y * y / (sigma_m * sigma_m));
        if (std::abs(x) < 0.5 * kTrackStep_m) result.weight += weight;
        s += w, sx += w * x, sy += w * y, sxx += w * x * x, sxy += w * x * y;
      }
    }
    // The 2 x 2 normal equations by Cramer's rule.
    const double hold = std::max(full_weight, kMinHold);
    const double a = s + options_.centre_hold * hold, c = sxx + along_m * along_m * hold;
    const double det = a * c - sx * sx;
    result.across_m = (sy * c - sxy * sx) / det;
    result.slope = (a * sxy - sx * sy) / det;
    return result;
  }

  /// Steps from `p` until the row ends. @returns points up to the last one on canopy, without `p`
  RowTrack walk(Vector2d p, Vector2d u, double full_weight) const {
    const double side_m = options_.max_side_step * kTrackStep_m;
    RowTrack track;
    std::size_t supported = 0;
    double gap_m = 0.0;
    double neighbour_m = 0.0;  // part of the gap beside which a neighbouring row goes on
    while (gap_m <= options_.open_gap_m ||
           (gap_m <= options_.longest_gap_m && neighbour_m >= options_.beside * gap_m)) {
      const Vector2d ahead = p + kTrackStep_m * u;
      if (raster_.cell_of(ahead.x(), ahead.y()) < 0) break;
      const Fit here = fit(ahead, u, full_weight);
      const double off_m = std::clamp(here.across_m, -side_m, side_m);
      const double slope = std::clamp(here.slope, -options_.max_turn, options_.max_turn);
      p = ahead + off_m * left_of(u);
      u = (u + slope * left_of(u)).normalized();
      if (is_taken(p)) break;
      track.push_back(p);
      if (here.weight >= options_.support * full_weight) {
        supported = track.size();
        gap_m = neighbour_m = 0.0;
      } else {
        // A gap. Does either neighbour have canopy here?
        gap_m += kTrackStep_m;
        for (const double side : {-1.0, 1.0}) {
          const Vector2d neighbour = p + side * options_.spacing_m * left_of(u);
          if (fit(neighbour, u, full_weight).weight < options_.support * full_weight) continue;
          neighbour_m += kTrackStep_m;
          break;
        }
      }
    }
    track.resize(supported);
    return track;
  }

  /// Track through a seed, both ways; null without canopy, on another row, or if too short.
  std::optional<RowTrack> from_seed(Vector2d p, Vector2d u) const {
    constexpr int kSteps = 4;              // chosen: to each side, a window of 9 m
    constexpr std::size_t kMinPoints = 3;  // chosen: shorter tracks have no direction
    // Mean canopy of a step, over the steps around the seed.
    double full_weight = 0.0;
    Vector2d best = p;
    double best_weight = 0.0;
    int places = 0;
    for (int k = -kSteps; k <= kSteps; ++k) {
      const Vector2d at = p + k * kTrackStep_m * u;
      if (raster_.cell_of(at.x(), at.y()) < 0) continue;
      const double weight = fit(at, u, 0.0).weight;
      full_weight += weight;
      ++places;
      // The seed moves to the place with the most canopy, discounted by its distance.
      const double nearness = 1.0 - options_.farther_loss * std::abs(k);
      if (weight * nearness > best_weight && !is_taken(at)) {
        best_weight = weight * nearness;
        best = at;
      }
    }
    if (places == 0 || best_weight <= 0.0) return std::nullopt;
    full_weight /= places;
    const Fit here = fit(best, u, full_weight);
    const Vector2d start = best + here.across_m * left_of(u);
    if (is_taken(start)) return std::nullopt;
    const double turn = options_.max_turn;
    u = (u + std::clamp(here.slope, -turn, turn) * left_of(u)).normalized();
    RowTrack track = walk(start, -u, full_weight);
    std::reverse(track.begin(), track.end());
    track.push_back(start);
    const RowTrack rest = walk(start, u, full_weight);
    track.insert(track.end(), rest.begin(), rest.end());
    if (track.size() < kMinPoints) return std::nullopt;
    return track;
  }

  /// Marks the squares around the track as taken, at its points and halfway between them.
  void take(const RowTrack& track) {
    for (std::size_t k = 0; k < track.size(); ++k) {
      for (const double share : {0.0, 0.5}) {
        if (k + 1 == track.size() && share > 0.0) continue;
        const Vector2d p = share > 0.0 ? Vector2d(0.5 * (track[k] + track[k + 1])) : track[k];
        take_around(raster_, p, reach_m(), taken_);
      }
    }
  }

  const CanopyRaster& raster_;
  const RowTrackingOptions& options_;
  TakenSquares taken_;
};

/// True if a track passes abreast of a place, less than `far_m` away. A track
/// that ends before or behind the place does not count: there all rows may end.
bool passes(const RowTrack& track, const Vector2d& p, const Vector2d& u, double far_m) {
  return std::any_of(track.begin(), track.end(), [&](const Vector2d& q) {
    const Vector2d d = q - p;
    return std::abs(d.dot(u)) <= kTrackStep_m && std::abs(d.dot(left_of(u))) < far_m;
  });
}

/// Unit direction of a track's last 8 steps: a single step is too noisy.
Vector2d end_direction(const RowTrack& track) {
  constexpr std::size_t kEnd_steps = 8;  // chosen
  const std::size_t back = std::min<std::size_t>(track.size() - 1, kEnd_steps);
  return (track.back() - track[track.size() - 1 - back]).normalized();
}

/// True if both are pieces of one row with a gap between: `second` is ahead of the end of `first`,
/// in one line with it and parallel, and a third track passes beside the gap.
bool goes_on(const RowTrack& first, const RowTrack& second, const std::vector<RowTrack>& all,
             const RowTrackingOptions& options) {
  const Vector2d u = end_direction(first);
  const Vector2d d = second.front() - first.back();
  const double along_m = d.dot(u), across_m = d.dot(left_of(u));
  if (along_m <= 0.0 || along_m > options.longest_join_m) return false;
  const double off_m = options.off_line * options.spacing_m + options.off_per_length * along_m;
  if (std::abs(across_m) > off_m) return false;
  RowTrack reversed(second.rbegin(), second.rend());
  if (-end_direction(reversed).dot(u) < std::cos(options.max_bend_rad)) return false;
  const Vector2d middle = 0.5 * (first.back() + second.front());
  const double far_m = options.neighbour * options.spacing_m;
  return std::any_of(all.begin(), all.end(), [&](const RowTrack& other) {
    return &other != &first && &other != &second && passes(other, middle, u, far_m);
  });
}

/// Joins pieces of rows, the shortest gap first, until none is left. Each pair is tried with both
/// tracks in both directions.
std::vector<RowTrack> join_tracks(std::vector<RowTrack> tracks, const RowTrackingOptions& options) {
  // Skips pairs that goes_on() would reject, with a margin for the distance across.
  constexpr double kFarPair = 1.5;
  for (;;) {
    double nearest_m = std::numeric_limits<double>::infinity();
    std::size_t a = 0, b = 0;
    bool a_turned = false, b_turned = false;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      for (std::size_t j = i + 1; j < tracks.size(); ++j) {
        for (const bool i_turned : {false, true}) {
          for (const bool j_turned : {false, true}) {
            const Vector2d& end = i_turned ? tracks[i].front() : tracks[i].back();
            const Vector2d& start = j_turned ? tracks[j].back() : tracks[j].front();
            const double gap_m = (start - end).norm();
            if (gap_m >= nearest_m || gap_m > kFarPair * options.longest_join_m) continue;
            const RowTrack kept_i = tracks[i], kept_j = tracks[j];
            if (i_turned) std::reverse(tracks[i].begin(), tracks[i].end());
            if (j_turned) std::reverse(tracks[j].begin(), tracks[j].end());
            const bool is_one = goes_on(tracks[i], tracks[j], tracks, options);
            tracks[i] = kept_i;
            tracks[j] = kept_j;
            if (!is_one) continue;
            nearest_m = gap_m;
            a = i, b = j, a_turned = i_turned, b_turned = j_turned;
          }
        }
      }
    }
    if (a == b) return tracks;
    if (a_turned) std::reverse(tracks[a].begin(), tracks[a].end());
    if (b_turned) std::reverse(tracks[b].begin(), tracks[b].end());
    // The gap is filled with points, so that steps keep their length.
    const Vector2d from = tracks[a].back(), displacement = tracks[b].front() - from;
    const int steps =
        std::max(1, static_cast<int>(std::lround(displacement.norm() / kTrackStep_m)));
    for (int k = 1; k < steps; ++k)
      tracks[a].push_back(from + displacement * (static_cast<double>(k) / steps));
    tracks[a].insert(tracks[a].end(), tracks[b].begin(), tracks[b].end());
    tracks.erase(tracks.begin() + static_cast<std::ptrdiff_t>(b));
  }
}

}  // namespace

std::vector<RowTrack> track_rows(const CanopyRaster& raster, const std::vector<RowPatch>& patches,
                                 const RowTrackingOptions& options, const TakenSquares& taken) {
  return join_tracks(Tracker(raster, options, taken).run(patches), options);
}

void take_rows(const CanopyRaster& raster, const std::vector<RowCurve>& rows,
               const RowTrackingOptions& options, TakenSquares& taken) {
  taken.resize(raster.weights.size(), 0);
  for (const RowCurve& row : rows) {
    for (double s_m = 0.0; s_m <= row.length_m(); s_m += 0.5 * kTrackStep_m) {
      take_around(raster, row.point_W(s_m), options.row_reach * options.spacing_m, taken);
    }
  }
}

}  // namespace vinerow::mapping

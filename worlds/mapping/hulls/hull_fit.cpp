#include "worlds/mapping/hulls/hull_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "engine/core/check.h"
#include "worlds/mapping/hulls/section_directions.h"

// Derivation. Sections j at s_j have offsets h_jk along the normals n_k. Between neighbours a and b
//
//   h_k(s) = h_ak + rise (s - s_a),   rise = (h_bk - h_ak) / (s_b - s_a),
//
// and a point p is outside side k if v = n_k . (y, z) > h_k(s) + tolerance. With l_jk the length of
// side k of section j (HullDirections::side_m), moving h_jk out by d changes the volume by
//
//   dV = slope d + O(d^2),   slope = sum over neighbours o of |s_j - s_o| (l_jk / 3 + l_ok / 6),
//
// the integral of the linear weight (1 at j, 0 at o) times the side's length. A point at s has the
// weight  w = (s - s_o) / (s_j - s_o)  and leaves the outside at
//
//   d = (v - tolerance - h_jk - (1 - w) (h_ok - h_jk)) / w                         (a "break").
//
// cost(d) = slope d + price * (number of breaks above d) is increasing in d between breaks. Its
// minimum over [low, high] is at a break or at an end, found by going through the sorted breaks.
//
// Sections are removed greedily by a priority queue (find_removals): the cost of a removal is the
// change of  volume + price * outside  after its two neighbours have been improved once. Entries
// that a removal nearby has made stale carry an old version and are skipped.

namespace vinerow::mapping {
namespace {

// Chosen: a shorter side would be a degenerate face.
constexpr double kMinSide_m = 0.005;
// Most sides of a section; RowHullOptions::corners allows no more.
constexpr std::size_t kMaxSides = 16;
// Points of a slice lie between its knots to within rounding: levels are compared with more than
// that.
constexpr double kRounding_m = 1e-4;
// Below this a side does not become shorter when it or its neighbour moves.
constexpr double kNoShrink = 1e-9;

/// Sides of the hull between two sections as functions of s, in the points' precision.
struct SideLines {
  std::array<float, kMaxSides> ny{}, nz{}, at{}, rise{};

  explicit SideLines(const HullDirections& directions) {
    for (int k = 0; k < directions.count(); ++k) {
      ny[k] = static_cast<float>(directions.normal(k).x());
      nz[k] = static_cast<float>(directions.normal(k).y());
    }
  }
  /// Sets at + rise s to h_k(s) + out_m.
  /// @param h_a,h_b  offsets of the sections at a_m and b_m
  void span(const double* h_a, const double* h_b, double a_m, double b_m, int sides, double out_m) {
    for (int k = 0; k < sides; ++k) {
      rise[k] = static_cast<float>((h_b[k] - h_a[k]) / (b_m - a_m));
      at[k] = static_cast<float>(h_a[k] + out_m) - rise[k] * static_cast<float>(a_m);
    }
  }
  /// n_k . (y, z) of a point, and the side's value at s.
  float value(int k, const Eigen::Vector3f& p) const { return ny[k] * p.y() + nz[k] * p.z(); }
  float level(int k, float s) const { return at[k] + rise[k] * s; }
};

}  // namespace

HullFit::HullFit(const RowStretch& stretch, const HullDirections& directions,
                 const HullFitOptions& options)
    : stretch_(stretch), directions_(directions), options_(options), c_(directions.count()) {
  const int slices = stretch.slices();
  left_ = slices + 1;
  for (int j = 0; j <= slices; ++j) {
    knots_.push_back(stretch.knot_m(j) - stretch.from_m);
    prev_.push_back(j - 1);
    next_.push_back(j < slices ? j + 1 : -1);
  }
  // Each slice gives a level; a knot takes the outer one of its two slices.
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  constexpr std::size_t kMinPoints = 3;  // chosen: fewer give no section
  h_.assign(static_cast<std::size_t>(left_) * c_, kNone);
  std::vector<float> values;
  for (int i = 0; i < slices; ++i) {
    const std::size_t begin = stretch.first[i], end = stretch.first[i + 1];
    if (end - begin < kMinPoints) continue;
    for (int k = 0; k < c_; ++k) {
      const Eigen::Vector2f n = directions.normal(k).cast<float>();
      values.clear();
      for (std::size_t p = begin; p < end; ++p) {
        values.push_back(n.x() * stretch.points[p].y() + n.y() * stretch.points[p].z());
      }
      const double level_m = upper_level(values);
      h(i)[k] = std::max(h(i)[k], level_m);
      h(i + 1)[k] = std::max(h(i + 1)[k], level_m);
    }
  }
  // Knots between empty slices repeat the last section, those at the start the first.
  int last = -1;
  for (int j = 0; j <= slices; ++j) {
    if (h(j)[0] == kNone) {
      if (last >= 0) std::copy_n(h(last), c_, h(j));
      continue;
    }
    if (last < 0) {
      for (int i = 0; i < j; ++i) std::copy_n(h(j), c_, h(i));
    }
    last = j;
  }
  VINEROW_DEMAND(last >= 0);
  for (int j = 0; j <= slices; ++j) directions_.repair(h(j), kMinSide_m);
}

double HullFit::volume_m3() const {
  return mapping::volume_m3(chain());
}

double HullFit::side_area_m2(int k) const {
  double area_m2 = 0.0;
  for (int a = 0, b = next_[0]; b >= 0; a = b, b = next_[b]) {
    area_m2 +=
        0.5 * (knots_[b] - knots_[a]) * (directions_.side_m(h(a), k) + directions_.side_m(h(b), k));
  }
  return area_m2;
}

double HullFit::side_area_m2() const {
  double area_m2 = 0.0;
  for (int k = 0; k < c_; ++k) area_m2 += side_area_m2(k);
  return area_m2;
}

void HullFit::collect(double reach_m) {
  const int slices = stretch_.slices();
  floor_ = h_;
  for (double& level : floor_) level -= reach_m;
  candidates_.clear();
  begins_.assign(static_cast<std::size_t>(slices) * c_ + 1, 0);
  std::vector<std::vector<Candidate>> found(c_);
  SideLines sides(directions_);
  const auto from_m = static_cast<float>(stretch_.from_m);
  const auto to_m = static_cast<float>(stretch_.to_m - stretch_.from_m);
  int a = 0;
  for (int i = 0; i < slices; ++i) {
    if (next_[a] <= i) a = next_[a];
    const int b = next_[a];
    sides.span(h(a), h(b), knots_[a], knots_[b], c_, -reach_m);
    for (auto& list : found) list.clear();
    for (std::size_t p = stretch_.first[i]; p < stretch_.first[i + 1]; ++p) {
      const Eigen::Vector3f& point = stretch_.points[p];
      const float s = std::clamp(point.x() - from_m, 0.0f, to_m);
      for (int k = 0; k < c_; ++k) {
        const float v = sides.value(k, point);
        if (v > sides.level(k, s)) found[k].push_back({s, v});
      }
    }
    for (int k = 0; k < c_; ++k) {
      std::sort(found[k].begin(), found[k].end(),
                [](const Candidate& one, const Candidate& other) { return one.v_m > other.v_m; });
      begins_[static_cast<std::size_t>(i) * c_ + k] =
          static_cast<std::uint32_t>(candidates_.size());
      candidates_.insert(candidates_.end(), found[k].begin(), found[k].end());
    }
  }
  begins_.back() = static_cast<std::uint32_t>(candidates_.size());
}

/// dV/dh_jk. @returns area, m2
double HullFit::slope_m2(int j, int k) const {
  const double own_m = directions_.side_m(h(j), k);
  double slope = 0.0;
  for (const int other : {prev_[j], next_[j]}) {
    if (other < 0) continue;
    slope +=
        std::abs(knots_[j] - knots_[other]) * (own_m / 3.0 + directions_.side_m(h(other), k) / 6.0);
  }
  return slope;
}

/// Moves side k of section j to the minimum of cost(d).
void HullFit::improve(int j, int k, double price_m3, double tolerance_m, double max_m) {
  // [low, high]: no farther than max_m, not in below what collect() has looked at, and no side
  // shorter than kMinSide_m. Moving in by d shortens the neighbours by d inverse_sin, moving out
  // shortens the side itself by d shrink.
  const int before = directions_.before(k), behind = directions_.behind(k);
  const auto max_move = [&](double side_m, double per_m) {
    return per_m > kNoShrink ? std::max(0.0, side_m - kMinSide_m) / per_m : max_m;
  };
  double low =
      -std::min({max_m, std::max(0.0, h(j)[k] - floor_[static_cast<std::size_t>(j) * c_ + k]),
                 max_move(directions_.side_m(h(j), before), directions_.inverse_sin(before)),
                 max_move(directions_.side_m(h(j), behind), directions_.inverse_sin(k))});
  const double high = std::min(max_m, max_move(directions_.side_m(h(j), k), directions_.shrink(k)));
  const double slope = slope_m2(j, k);
  if (directions_.normal(k).y() < options_.looks_down) price_m3 *= options_.down_price;
  // Breaks between low and high.
  breaks_.clear();
  const double own_m = h(j)[k];
  for (const int other : {prev_[j], next_[j]}) {
    if (other < 0) continue;
    const double per_m = 1.0 / (knots_[j] - knots_[other]);
    const double rise = h(other)[k] - own_m;
    const int a = std::min(j, other), b = std::max(j, other);
    // A point whose break is at low: linear in s, so that the ends of a slice bound it.
    const auto lowest_v_m = [&](double s_m) {
      const double weight = (s_m - knots_[other]) * per_m;
      return own_m + (1.0 - weight) * rise + tolerance_m + low * weight;
    };
    for (int i = a; i < b; ++i) {
      const std::size_t list = static_cast<std::size_t>(i) * c_ + k;
      const double last_v_m =
          std::min(lowest_v_m(knots_[i]), lowest_v_m(knots_[i + 1])) - kRounding_m;
      for (std::uint32_t p = begins_[list]; p < begins_[list + 1]; ++p) {
        if (candidates_[p].v_m < last_v_m) break;
        const double weight = (candidates_[p].s_m - knots_[other]) * per_m;
        const double over_m = candidates_[p].v_m - own_m - (1.0 - weight) * rise - tolerance_m;
        if (over_m <= low * weight || over_m >= high * weight) continue;
        breaks_.push_back(over_m / weight);
      }
    }
  }
  // Going inwards from high, every break passed costs one point. More breaks than `enough` cost
  // more than all the volume that can be won, so that only the outermost of them are sorted.
  double best = high, min_cost = slope * high;
  const auto enough = static_cast<std::size_t>(slope * (high - low) / price_m3) + 1;
  const bool may_stop = breaks_.size() > enough;
  if (may_stop) {
    const auto last = breaks_.begin() + static_cast<std::ptrdiff_t>(enough);
    std::nth_element(breaks_.begin(), last, breaks_.end(), std::greater<>());
    breaks_.erase(last, breaks_.end());
  }
  std::sort(breaks_.begin(), breaks_.end(), std::greater<>());
  for (std::size_t n = 0; n < breaks_.size(); ++n) {
    const double value = slope * breaks_[n] + price_m3 * static_cast<double>(n);
    if (value < min_cost) {
      min_cost = value;
      best = breaks_[n];
    }
  }
  if (!may_stop && slope * low + price_m3 * static_cast<double>(breaks_.size()) < min_cost)
    best = low;
  h(j)[k] += best;
}

void HullFit::sweep(double price_m3, double tolerance_m, double max_m) {
  for (int j = 0; j >= 0; j = next_[j]) {
    for (int k = 0; k < c_; ++k) improve(j, k, price_m3, tolerance_m, max_m);
  }
}

void HullFit::smooth_lower_edge() {
  const double reach_m = options_.edge_reach_m;
  // The side that looks down most.
  int k = 0;
  for (int other = 1; other < c_; ++other) {
    if (directions_.normal(other).y() < directions_.normal(k).y()) k = other;
  }
  const std::vector<double> before = h_;
  const auto level_m = [&](int j) { return before[static_cast<std::size_t>(j) * c_ + k]; };
  const Eigen::Vector2f n = directions_.normal(k).cast<float>();
  const int reach = std::max(1, static_cast<int>(std::lround(reach_m / stretch_.slice_m())));
  const auto has_few_points = [&](int j) {
    const int from = std::max(0, j - reach), to = std::min(stretch_.slices(), j + reach);
    const double min_m = level_m(j) - options_.edge_band_m;
    std::int64_t seen = 0;
    for (std::size_t p = stretch_.first[from]; p < stretch_.first[to]; ++p) {
      const Eigen::Vector3f& point = stretch_.points[p];
      seen += n.x() * point.y() + n.y() * point.z() > min_m ? 1 : 0;
    }
    const double few = options_.edge_few_per_m * (to - from) * stretch_.slice_m();
    return static_cast<double>(seen) <= few;
  };
  for (int j = 0; j >= 0; j = next_[j]) {
    if (!has_few_points(j)) continue;
    double lowest_m = level_m(j);
    for (int i = prev_[j]; i >= 0 && knots_[j] - knots_[i] <= reach_m; i = prev_[i]) {
      lowest_m = std::max(lowest_m, level_m(i));
    }
    for (int i = next_[j]; i >= 0 && knots_[i] - knots_[j] <= reach_m; i = next_[i]) {
      lowest_m = std::max(lowest_m, level_m(i));
    }
    const double spare_m = directions_.side_m(h(j), k) - kMinSide_m;
    const double shrink = directions_.shrink(k);
    const double max_m =
        shrink > kNoShrink ? std::max(0.0, spare_m) / shrink : lowest_m - level_m(j);
    h(j)[k] += std::min(lowest_m - level_m(j), max_m);
  }
}

void HullFit::offset(double out_m) {
  for (int j = 0; j >= 0; j = next_[j]) {
    for (int k = 0; k < c_; ++k) h(j)[k] += out_m;
    if (out_m < 0.0) directions_.repair(h(j), kMinSide_m);
  }
}

void HullFit::count_excess(ExcessCounts& counts) const {
  constexpr float kBelowAll_m = -1e9f;
  SideLines sides(directions_);
  const auto from_m = static_cast<float>(stretch_.from_m);
  const auto to_m = static_cast<float>(stretch_.to_m - stretch_.from_m);
  for (int a = 0, b = next_[0]; b >= 0; a = b, b = next_[b]) {
    sides.span(h(a), h(b), knots_[a], knots_[b], c_, 0.0);
    for (std::size_t p = stretch_.first[a]; p < stretch_.first[b]; ++p) {
      const Eigen::Vector3f& point = stretch_.points[p];
      const float s = std::clamp(point.x() - from_m, 0.0f, to_m);
      float max_excess = kBelowAll_m;
      int side = 0;
      for (int k = 0; k < c_; ++k) {
        const float excess = sides.value(k, point) - sides.at[k] - sides.rise[k] * s;
        if (excess > max_excess) {
          max_excess = excess;
          side = k;
        }
      }
      const double step =
          (static_cast<double>(max_excess) - ExcessCounts::kLow_m) / ExcessCounts::kStep_m;
      const int bin =
          static_cast<int>(std::clamp(step, 0.0, static_cast<double>(ExcessCounts::kSteps - 1)));
      ++counts.all[bin];
      ++counts.by_side[side][bin];
    }
  }
}

void HullFit::find_above(double excess_m, std::vector<Eigen::Vector3f>& points) const {
  SideLines sides(directions_);
  const auto from_m = static_cast<float>(stretch_.from_m);
  const auto to_m = static_cast<float>(stretch_.to_m - stretch_.from_m);
  for (int a = 0, b = next_[0]; b >= 0; a = b, b = next_[b]) {
    sides.span(h(a), h(b), knots_[a], knots_[b], c_, excess_m);
    for (std::size_t p = stretch_.first[a]; p < stretch_.first[b]; ++p) {
      const Eigen::Vector3f& point = stretch_.points[p];
      // Points beyond an end may be too far from the end face: the caller has to look at them all.
      const float beyond = point.x() - from_m;
      const float s = std::clamp(beyond, 0.0f, to_m);
      bool above = s != beyond;
      for (int k = 0; k < c_; ++k) {
        above |= sides.value(k, point) > sides.level(k, s);
      }
      if (above) points.push_back(point);
    }
  }
}

/// Number of pairs (point, side) outside between sections a and b, those below weighted by
/// down_price.
std::int64_t HullFit::outside(int a, int b, double tolerance_m) const {
  std::int64_t count = 0;
  const double per_m = 1.0 / (knots_[b] - knots_[a]);
  for (int k = 0; k < c_; ++k) {
    const double rise = (h(b)[k] - h(a)[k]) * per_m;
    const double at = h(a)[k] - rise * knots_[a] + tolerance_m;
    std::int64_t own = 0;
    for (int i = a; i < b; ++i) {
      const std::size_t list = static_cast<std::size_t>(i) * c_ + k;
      const double last_v_m =
          std::min(at + rise * knots_[i], at + rise * knots_[i + 1]) - kRounding_m;
      for (std::uint32_t p = begins_[list]; p < begins_[list + 1]; ++p) {
        if (candidates_[p].v_m < last_v_m) break;
        own += candidates_[p].v_m > at + rise * candidates_[p].s_m;
      }
    }
    const bool looks_down = directions_.normal(k).y() < options_.looks_down;
    count += looks_down ? static_cast<std::int64_t>(options_.down_price) * own : own;
  }
  return count;
}

/// Volume between sections a and b plus price of the points outside. The area is quadratic in s, so
/// that Simpson's rule  (s_b - s_a) / 6 (A_a + 4 A_middle + A_b)  is exact.
double HullFit::cost(int a, int b, double price_m3, double tolerance_m) const {
  std::array<double, kMaxSides> middle{};
  for (int k = 0; k < c_; ++k) middle[k] = 0.5 * (h(a)[k] + h(b)[k]);
  const double volume = (knots_[b] - knots_[a]) / 6.0 *
                        (directions_.area_m2(h(a)) + 4.0 * directions_.area_m2(middle.data()) +
                         directions_.area_m2(h(b)));
  return volume + price_m3 * static_cast<double>(outside(a, b, tolerance_m));
}

void HullFit::drop(int j) {
  next_[prev_[j]] = next_[j];
  prev_[next_[j]] = prev_[j];
  --left_;
}

/// Cost of removing section j, over the up to four spans around it. The hull is restored.
/// @param made  if not null: the removal
double HullFit::try_without(int j, double price_m3, double tolerance_m, Removal* made) {
  const int a = prev_[j], b = next_[j];
  const auto sum = [&] {
    double total = cost(a, b, price_m3, tolerance_m);
    if (prev_[a] >= 0) total += cost(prev_[a], a, price_m3, tolerance_m);
    if (next_[b] >= 0) total += cost(b, next_[b], price_m3, tolerance_m);
    return total;
  };
  double with = cost(a, j, price_m3, tolerance_m) + cost(j, b, price_m3, tolerance_m);
  if (prev_[a] >= 0) with += cost(prev_[a], a, price_m3, tolerance_m);
  if (next_[b] >= 0) with += cost(b, next_[b], price_m3, tolerance_m);

  // Join a and b, improve both once, compare, and undo.
  std::array<double, 2 * kMaxSides> kept{};
  std::copy_n(h(a), c_, kept.begin());
  std::copy_n(h(b), c_, kept.begin() + c_);
  next_[a] = b;
  prev_[b] = a;
  for (int k = 0; k < c_; ++k) {
    improve(a, k, price_m3, tolerance_m, options_.removal_move_m);
    improve(b, k, price_m3, tolerance_m, options_.removal_move_m);
  }
  const double without = sum();
  if (made != nullptr) {
    *made = {without - with, j, a, b, std::vector<double>(h(a), h(a) + c_)};
    made->h_m.insert(made->h_m.end(), h(b), h(b) + c_);
  }
  next_[a] = j;
  prev_[b] = j;
  std::copy_n(kept.begin(), c_, h(a));
  std::copy_n(kept.begin() + c_, c_, h(b));
  return without - with;
}

std::vector<Removal> HullFit::find_removals(double price_m3, double tolerance_m, double max_m3,
                                            int fewest,
                                            const std::function<bool(double, double)>& may_join) {
  const auto kept_h = h_;
  const auto kept_prev = prev_, kept_next = next_;
  const int kept_left = left_;
  struct Entry {
    double added_m3;
    int knot, version;
    bool operator<(const Entry& other) const {  // the cheapest is on top, ties by knot
      if (added_m3 != other.added_m3) return added_m3 > other.added_m3;
      return knot > other.knot;
    }
  };
  std::vector<int> versions(knots_.size(), 0);
  std::priority_queue<Entry> queue;
  const auto enqueue = [&](int j) {
    if (j < 0 || prev_[j] < 0 || next_[j] < 0) return;
    ++versions[j];
    if (!may_join(stretch_.from_m + knots_[prev_[j]], stretch_.from_m + knots_[next_[j]])) return;
    queue.push({try_without(j, price_m3, tolerance_m, nullptr), j, versions[j]});
  };
  for (int j = next_[0]; j >= 0; j = next_[j]) enqueue(j);
  std::vector<Removal> removals;
  double level_m3 = 0.0;
  while (!queue.empty() && left_ > 2) {
    const Entry entry = queue.top();
    queue.pop();
    if (entry.version != versions[entry.knot]) continue;
    if (entry.added_m3 > max_m3 && left_ <= fewest) break;
    Removal removal;
    try_without(entry.knot, price_m3, tolerance_m, &removal);
    // A cheap removal that only an expensive one made possible counts as expensive as that one.
    level_m3 = std::max(level_m3, removal.added_m3);
    removal.added_m3 = level_m3;
    drop(entry.knot);
    versions[entry.knot] = -1;
    std::copy_n(removal.h_m.begin(), c_, h(removal.before));
    std::copy_n(removal.h_m.begin() + c_, c_, h(removal.behind));
    const int a = removal.before, b = removal.behind;
    if (prev_[a] >= 0) enqueue(prev_[a]);
    enqueue(a);
    enqueue(b);
    if (next_[b] >= 0) enqueue(next_[b]);
    removals.push_back(std::move(removal));
  }
  h_ = kept_h;
  prev_ = kept_prev;
  next_ = kept_next;
  left_ = kept_left;
  return removals;
}

void HullFit::apply(const std::vector<Removal>& removals, std::size_t count) {
  for (std::size_t n = 0; n < count; ++n) {
    const Removal& removal = removals[n];
    drop(removal.knot);
    std::copy_n(removal.h_m.begin(), c_, h(removal.before));
    std::copy_n(removal.h_m.begin() + c_, c_, h(removal.behind));
  }
}

HullChain HullFit::chain() const {
  HullChain result{directions_, {}, {}};
  for (int j = 0; j >= 0; j = next_[j]) {
    result.s_m.push_back(next_[j] < 0 ? stretch_.to_m : stretch_.from_m + knots_[j]);
    result.h_m.insert(result.h_m.end(), h(j), h(j) + c_);
  }
  return result;
}

}  // namespace vinerow::mapping

#include "engine/sim/alley_stretches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/messages/path.h"
#include "engine/math/polyline.h"

namespace vinerow {
namespace {

// A chord longer than this share of the diameter does not fit the arc of its point's curvature, so
// that it is measured as a straight line.
constexpr double kLargestChordShare = 0.999;

double calc_arc_m(double chord_m, double curvature_per_m) {
  const double half = 0.5 * curvature_per_m * chord_m;
  if (std::abs(half) < 1e-8 || std::abs(half) > kLargestChordShare) return chord_m;
  return 2.0 * std::asin(half) / curvature_per_m;
}

/// Consecutive segments [first, last) of the plan with the same role.
struct Part {
  enum class What { kLeg, kLink, kAbove };
  What what = What::kLink;
  int first = 0, last = 0;
  int alley = -1;            ///< of a leg
  bool leads_there = false;  ///< a flying vehicle's path to the rows
};

class StretchFinder {
 public:
  StretchFinder(const PlannedPath& plan, const std::vector<Alley>& alleys, const AlleyUse& use)
      : points_(plan.points), alleys_(alleys), use_(use), at_m_(measure_plan(plan, use.flies)) {
    for (const Alley& alley : alleys) {
      const std::vector<Eigen::Vector2d> line = from_above(alley.line_W);
      lines_.emplace_back(line);
      extended_.push_back(extend(line));
    }
  }

  std::vector<AlleyStretch> find() {
    part();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Part& part = parts_[i];
      const double start_m = at_m_[part.first], end_m = at_m_[part.last];
      if (part.what == Part::What::kLeg) {
        add(start_m, end_m, {part.alley});
        continue;
      }
      const int before = i > 0 ? parts_[i - 1].alley : -1;
      const int after = i + 1 < parts_.size() ? parts_[i + 1].alley : -1;
      const bool is_above = part.what == Part::What::kAbove;
      if (!is_above && before >= 0 && after >= 0) {
        add_path(start_m, end_m, {before, after});
      } else if (after >= 0 && (!is_above || part.leads_there)) {
        add_path(std::max(start_m, end_m - use_.approach_m), end_m, {after});
      } else if (before >= 0 && !is_above) {
        add_path(start_m, std::min(end_m, start_m + use_.approach_m), {before});
      }
    }
    return std::move(stretches_);
  }

 private:
  std::vector<Eigen::Vector2d> extend(std::vector<Eigen::Vector2d> line) const {
    if (line.size() < 2) return line;
    const Eigen::Vector2d out = (line.front() - line[1]).stableNormalized();
    const Eigen::Vector2d on = (line.back() - line[line.size() - 2]).stableNormalized();
    line.front() += use_.headland_m * out;
    line.back() += use_.headland_m * on;
    return line;
  }

  Eigen::Vector2d p(int i) const { return points_[i].p_W.head<2>(); }

  /// @returns -1 if no alley is near
  int nearest_alley(double middle_m, int first, int last) const {
    int i = first;
    while (i + 1 < last && at_m_[i + 1] < middle_m) ++i;
    const double length_m = at_m_[i + 1] - at_m_[i];
    const double share = length_m > 0.0 ? (middle_m - at_m_[i]) / length_m : 0.0;
    const Eigen::Vector2d middle = p(i) + std::clamp(share, 0.0, 1.0) * (p(i + 1) - p(i));
    int best = -1;
    double min_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      const double away_m = lines_[k].nearest(middle).distance_m;
      if (away_m > alleys_[k].width_m || away_m >= min_m) continue;
      min_m = away_m;
      best = static_cast<int>(k);
    }
    return best;
  }

  /// Cuts the plan into parts.
  void part() {
    const int segments = static_cast<int>(points_.size()) - 1;
    for (int i = 0; i < segments; ++i) {
      if (points_[i].kind != PathKind::kLeg) continue;
      first_leg_ = std::min(first_leg_, i);
      last_leg_ = i;
    }
    for (int i = 0; i < segments;) {
      Part next;
      next.first = i;
      const PathPoint& point = points_[i];
      const auto is_same = [&](int k) {
        return points_[k].kind == point.kind && points_[k].alley == point.alley;
      };
      // A leg without an alley number may lead through several alleys, so its segments stay apart.
      do ++i;
      while (i < segments && is_same(i) && !(point.kind == PathKind::kLeg && point.alley < 0));
      next.last = i;
      classify(point.kind, next);
      append(next);
    }
  }

  void classify(PathKind kind, Part& part) const {
    switch (kind) {
      case PathKind::kLeg:
        part.alley =
            nearest_alley(0.5 * (at_m_[part.first] + at_m_[part.last]), part.first, part.last);
        part.what = Part::What::kLeg;
        if (part.alley < 0) part.what = use_.flies ? Part::What::kAbove : Part::What::kLink;
        return;
      case PathKind::kTurn:
        part.what = Part::What::kLink;
        return;
      case PathKind::kTransit:
        // Between its first and last leg a flight is as low as in the rows.
        part.leads_there = use_.flies && part.first < first_leg_;
        part.what = part.leads_there || (use_.flies && part.first > last_leg_) ? Part::What::kAbove
                                                                               : Part::What::kLink;
        return;
      case PathKind::kVertical:
      case PathKind::kReturn:
        part.what = Part::What::kAbove;
        return;
    }
  }

  void append(const Part& part) {
    if (!parts_.empty()) {
      Part& last = parts_.back();
      if (last.what == part.what && last.alley == part.alley &&
          last.leads_there == part.leads_there) {
        last.last = part.last;
        return;
      }
    }
    parts_.push_back(part);
  }

  void add(double start_m, double end_m, std::vector<int> needs) {
    if (!(end_m > start_m)) return;
    if (!stretches_.empty() && stretches_.back().needs == needs &&
        stretches_.back().end_m == start_m) {
      stretches_.back().end_m = end_m;
      return;
    }
    stretches_.push_back({start_m, end_m, std::move(needs)});
  }

  /// Adds a path between alleys, which also needs the alleys whose mouths it passes.
  void add_path(double start_m, double end_m, std::vector<int> needs) {
    for (int i = 0; i + 1 < static_cast<int>(points_.size()); ++i) {
      if (at_m_[i + 1] <= start_m || at_m_[i] >= end_m) continue;
      for (std::size_t k = 0; k < extended_.size(); ++k) {
        if (crosses(p(i), p(i + 1), extended_[k])) needs.push_back(static_cast<int>(k));
      }
    }
    std::sort(needs.begin(), needs.end());
    needs.erase(std::unique(needs.begin(), needs.end()), needs.end());
    add(start_m, end_m, std::move(needs));
  }

  static bool crosses(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                      const std::vector<Eigen::Vector2d>& line) {
    const auto side = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                         const Eigen::Vector2d& at) {
      const Eigen::Vector2d along = to - from, off = at - from;
      return along.x() * off.y() - along.y() * off.x();
    };
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const double a_side = side(line[i], line[i + 1], a), b_side = side(line[i], line[i + 1], b);
      const double from = side(a, b, line[i]), to = side(a, b, line[i + 1]);
      if ((a_side > 0.0) != (b_side > 0.0) && (from > 0.0) != (to > 0.0)) return true;
    }
    return false;
  }

  const std::vector<PathPoint>& points_;
  const std::vector<Alley>& alleys_;
  const AlleyUse& use_;
  std::vector<double> at_m_;
  std::vector<Polyline> lines_;
  std::vector<std::vector<Eigen::Vector2d>> extended_;
  int first_leg_ = std::numeric_limits<int>::max(), last_leg_ = -1;
  std::vector<Part> parts_;
  std::vector<AlleyStretch> stretches_;
};

}  // namespace

std::vector<double> measure_plan(const PlannedPath& plan, bool flies) {
  std::vector<double> at_m;
  at_m.reserve(plan.points.size());
  double sum_m = 0.0;
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    if (i > 0) {
      const PathPoint& from = plan.points[i - 1];
      const Eigen::Vector3d displacement = plan.points[i].p_W - from.p_W;
      const double arc_m = calc_arc_m(displacement.head<2>().norm(), from.curvature_per_m);
      sum_m += flies ? std::hypot(arc_m, displacement.z()) : arc_m;
    }
    at_m.push_back(sum_m);
  }
  return at_m;
}

std::vector<AlleyStretch> find_alley_stretches(const PlannedPath& plan,
                                               const std::vector<Alley>& alleys,
                                               const AlleyUse& use) {
  return StretchFinder(plan, alleys, use).find();
}

}  // namespace vinerow

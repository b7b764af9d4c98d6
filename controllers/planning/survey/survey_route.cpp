#include "controllers/planning/survey/survey_route.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/parts/paths/pose2.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;

/// Length by which the turns at a line's corners do not fit between each other, m.
double calc_misfit_m(const std::vector<Vector2d>& line, double turn_radius_m) {
  constexpr double kSharpest_rad = 2.6;  // beyond, the tangents become too long
  double misfit_m = 0.0, before_m = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vector2d displacement = line[i + 1] - line[i];
    double after_m = 0.0;
    if (i + 2 < line.size()) {
      const Vector2d next = line[i + 2] - line[i + 1];
      const double angle = std::abs(std::atan2(cross(displacement, next), displacement.dot(next)));
      after_m = turn_radius_m * std::tan(0.5 * std::min(angle, kSharpest_rad));
      misfit_m += 20.0 * turn_radius_m * std::max(0.0, angle - kSharpest_rad);
    }
    misfit_m += std::max(0.0, before_m + after_m - displacement.norm());
    before_m = after_m;
  }
  return misfit_m;
}

class RouteMaker {
 public:
  RouteMaker(const RouteTask& task, const LaneFrame& frame) : task_(task), frame_(frame) {}

  void add(const Vector2d& p_W, PathKind kind, int lane = -1) {
    constexpr double kSame_m = 1e-3;
    auto& points = route_.points;
    // Two corners at one place become one, with the kind and lane of the later one.
    if (!points.empty() && (points.back().p_W - p_W).norm() < kSame_m) {
      points.back().kind = kind;
      points.back().lane = lane;
    } else {
      points.push_back({p_W, kind, lane});
    }
  }

  /// From the start to the run-in of the first lane, which heads along `sign` s.
  void approach(double s, double t, double sign) {
    const Vector2d to_W = frame_.to_world(s, t), along_W = sign * frame_.along();
    add(task_.start_W, PathKind::kTransit);
    for (const Vector2d& corner :
         find_approach(task_.start_W, std::nullopt, to_W, along_W, task_.turn_radius_m)) {
      add(corner, PathKind::kTransit);
    }
    add(to_W, PathKind::kTransit);
    route_.first_lane_point = route_.points.size() - 1;
  }

  void fly(const SurveyLane& lane, int index, bool up) {
    std::vector<LaneSegment> pieces = lane.pieces;
    if (!up) {
      std::reverse(pieces.begin(), pieces.end());
      for (LaneSegment& piece : pieces) std::swap(piece.from_m, piece.to_m);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      add(frame_.to_world(pieces[i].from_m, lane.across_m), PathKind::kLeg, index);
      const bool is_last = i + 1 == pieces.size();
      add(frame_.to_world(pieces[i].to_m, lane.across_m),
          is_last ? PathKind::kTurn : PathKind::kTransit);
    }
  }

  /// Between the ends of two lanes, on the side of `sign` s.
  void turn(const LaneEnds& from, const LaneEnds& to, double sign) {
    const double s = sign > 0.0 ? std::max(from.high_m, to.high_m) : std::min(from.low_m, to.low_m);
    const double radius_m = task_.turn_radius_m;
    add(frame_.to_world(s, from.across_m), PathKind::kTurn);
    if (is_wide_turn(from, to, radius_m)) {
      ++route_.wide_turns;
      // Away from the next lane first, then ahead, and back across it.
      const double away = to.across_m > from.across_m ? -2.0 * radius_m : 2.0 * radius_m;
      const double on = s + sign * 2.0 * radius_m;
      add(frame_.to_world(s, from.across_m + away), PathKind::kTurn);
      add(frame_.to_world(on, from.across_m + away), PathKind::kTurn);
      add(frame_.to_world(on, to.across_m), PathKind::kTurn);
    } else {
      add(frame_.to_world(s, to.across_m), PathKind::kTurn);
    }
  }

  void go_home(double s, double t, double sign) {
    route_.points.back().kind = PathKind::kReturn;
    add(frame_.to_world(s, t), PathKind::kReturn);
    if (!task_.returns) return;
    // The approach to the place, reversed.
    const std::vector<Vector2d> corners =
        find_approach(task_.start_W, std::nullopt, frame_.to_world(s, t), -sign * frame_.along(),
                      task_.turn_radius_m);
    for (auto corner = corners.rbegin(); corner != corners.rend(); ++corner) {
      add(*corner, PathKind::kReturn);
    }
    add(task_.start_W, PathKind::kReturn);
  }

  SurveyRoute take() { return std::move(route_); }

 private:
  const RouteTask& task_;
  const LaneFrame& frame_;
  SurveyRoute route_;
};

}  // namespace

SurveyRoute make_survey_route(const RouteTask& task, const LaneFrame& frame,
                              const std::vector<SurveyLane>& lanes, const LaneOrder& order) {
  RouteMaker maker(task, frame);
  const auto ends_of = [&](int lane) {
    return LaneEnds{lanes[lane].across_m, lanes[lane].low_m() - task.run_out_m,
                    lanes[lane].high_m() + task.run_out_m};
  };
  bool up = order.starts_up;
  const LaneEnds first = ends_of(order.lanes.front()), last = ends_of(order.lanes.back());
  maker.approach(up ? first.low_m : first.high_m, first.across_m, up ? 1.0 : -1.0);
  for (std::size_t i = 0; i < order.lanes.size(); ++i, up = !up) {
    maker.fly(lanes[order.lanes[i]], order.lanes[i], up);
    const double sign = up ? 1.0 : -1.0;
    if (i + 1 < order.lanes.size()) {
      maker.turn(ends_of(order.lanes[i]), ends_of(order.lanes[i + 1]), sign);
    } else {
      maker.go_home(up ? last.high_m : last.low_m, last.across_m, sign);
    }
  }
  return maker.take();
}

std::vector<Vector2d> find_approach(const Vector2d& from_W,
                                    const std::optional<Vector2d>& heading_W, const Vector2d& to_W,
                                    const Vector2d& along_W, double turn_radius_m) {
  const Vector2d aside_W = left_of(along_W);
  std::vector<std::vector<Vector2d>> paths = {{}};
  const double level_m = std::abs((from_W - to_W).dot(aside_W));
  for (const double b : {2.0 * turn_radius_m, 3.0 * turn_radius_m, 5.0 * turn_radius_m, level_m}) {
    for (const double side : {1.0, -1.0}) {
      const Vector2d abeam_W = to_W + side * b * aside_W;
      paths.push_back({abeam_W});
      for (const double a : {2.0 * turn_radius_m, 4.0 * turn_radius_m}) {
        paths.push_back({Vector2d(abeam_W - a * along_W)});
        paths.push_back({Vector2d(abeam_W + a * along_W), abeam_W});  // along the lane, and back
        paths.push_back({Vector2d(abeam_W - a * along_W), Vector2d(to_W - a * along_W)});
      }
    }
  }
  constexpr double kOn_m = 1e3;  // the lane is long enough for its turn
  double best_m = std::numeric_limits<double>::infinity();
  std::vector<Vector2d> best;
  for (const std::vector<Vector2d>& candidate : paths) {
    std::vector<Vector2d> line;
    if (heading_W) line.push_back(from_W - kOn_m * *heading_W);
    line.push_back(from_W);
    line.insert(line.end(), candidate.begin(), candidate.end());
    line.push_back(to_W);
    line.push_back(to_W + kOn_m * along_W);
    double length_m = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) length_m += (line[i] - line[i - 1]).norm();
    constexpr double kMisfit = 100.0;  // any path that fits is better than one that does not
    const double worth_m = length_m + kMisfit * calc_misfit_m(line, turn_radius_m);
    if (worth_m >= best_m - 1e-6) continue;
    best_m = worth_m;
    best = candidate;
  }
  return best;
}

std::vector<Vector2d> make_climb_laps(const Vector2d& start_W, double yaw_rad,
                                      const Vector2d& target_W, double min_length_m,
                                      double turn_radius_m, bool to_left) {
  constexpr double kLongest_m = 400.0;  // of a lap's long side
  const Vector2d ahead = direction(yaw_rad);
  const Vector2d aside = (to_left ? 1.0 : -1.0) * left_of(ahead);
  const double wide_m = 2.5 * turn_radius_m, shortest_m = 3.0 * turn_radius_m;
  const double extra_m = std::max(0.0, min_length_m - (target_W - start_W).norm());
  const int laps =
      std::max(1, static_cast<int>(std::ceil(extra_m / (2.0 * (kLongest_m + wide_m)))));
  std::vector<Vector2d> corners;
  double length_m = 0.0;
  constexpr double kLonger = 1.05;
  // The last lap turns to the target at its third corner, so its length is not known in advance.
  for (double side_m = std::max(shortest_m, 0.5 * extra_m / laps - wide_m); length_m < min_length_m;
       side_m *= kLonger) {
    corners.clear();
    for (int lap = 0; lap < laps; ++lap) {
      if (lap > 0) corners.push_back(start_W);
      corners.push_back(start_W + side_m * ahead);
      corners.push_back(start_W + side_m * ahead + wide_m * aside);
      corners.push_back(start_W + wide_m * aside);
    }
    length_m = (corners.front() - start_W).norm() + (target_W - corners.back()).norm();
    for (std::size_t i = 1; i < corners.size(); ++i) {
      length_m += (corners[i] - corners[i - 1]).norm();
    }
  }
  return corners;
}

}  // namespace vinerow::controllers

#include "controllers/trajectory/simple_flights.h"

#include <algorithm>

namespace vinerow::controllers {
namespace {

// A vehicle nearer than this is at a place.
constexpr double kAt_m = 0.05;

PathPoint make_point(const Eigen::Vector3d& p_W, PathKind kind) {
  PathPoint point;
  point.p_W = p_W;
  point.kind = kind;
  return point;
}

Eigen::Vector3d at_height(const Eigen::Vector3d& p, double height_m) {
  return {p.x(), p.y(), height_m};
}

}  // namespace

bool has_vertical(const PlannedPath& plan) {
  return std::any_of(plan.points.begin(), plan.points.end(),
                     [](const PathPoint& point) { return point.kind == PathKind::kVertical; });
}

PlannedPath lift_plan(const PlannedPath& plan, const Eigen::Vector3d& start_W, double height_m,
                      double rest_height_m) {
  PlannedPath flight;
  const Eigen::Vector3d first = plan.points.front().p_W;
  flight.points.push_back(make_point(start_W, PathKind::kVertical));
  if ((first - start_W).head<2>().norm() > kAt_m) {
    flight.points.push_back(
        make_point(at_height(start_W, first.z() + height_m), PathKind::kTransit));
  }
  for (PathPoint point : plan.points) {
    point.p_W.z() += height_m;
    flight.points.push_back(point);
  }
  flight.points.back().kind = PathKind::kVertical;
  const Eigen::Vector3d last = plan.points.back().p_W;
  flight.points.push_back(
      make_point(at_height(last, last.z() + rest_height_m), PathKind::kVertical));
  return flight;
}

PlannedPath make_hover_plan(const Eigen::Vector3d& start_W, const Eigen::Vector3d& hover_W) {
  PlannedPath flight;
  flight.points.push_back(make_point(start_W, PathKind::kVertical));
  flight.points.push_back(make_point(at_height(start_W, hover_W.z()), PathKind::kTransit));
  Eigen::Vector3d place = flight.points.back().p_W;
  if ((hover_W - start_W).head<2>().norm() > kAt_m) {
    place = hover_W;
    flight.points.push_back(make_point(place, PathKind::kTransit));
  }
  flight.points.back().kind = PathKind::kVertical;
  flight.points.push_back(make_point(at_height(place, start_W.z()), PathKind::kVertical));
  return flight;
}

}  // namespace vinerow::controllers

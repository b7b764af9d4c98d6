#include "controllers/trajectory/simple_flights.h"

#include <algorithm>

#include "controllers/parts/paths/verticals.h"

namespace vinerow::controllers {

bool has_vertical(const PlannedPath& plan) {
  return std::any_of(plan.points.begin(), plan.points.end(),
                     [](const PathPoint& point) { return point.kind == PathKind::kVertical; });
}

PlannedPath lift_plan(const PlannedPath& plan, const Eigen::Vector3d& start_W, double height_m,
                      double rest_height_m) {
  PlannedPath flight = plan;
  const double last_m = plan.points.back().p_W.z();
  for (PathPoint& point : flight.points) point.p_W.z() += height_m;
  add_take_off(start_W, flight);
  add_landing(last_m + rest_height_m, flight);
  return flight;
}

PlannedPath make_hover_plan(const Eigen::Vector3d& start_W, const Eigen::Vector3d& hover_W) {
  PathPoint place;
  place.p_W = hover_W;
  place.kind = PathKind::kTransit;
  if ((hover_W - start_W).head<2>().norm() <= kAtPlace_m) place.p_W.head<2>() = start_W.head<2>();
  PlannedPath flight;
  flight.points.push_back(place);
  add_take_off(start_W, flight);
  add_landing(start_W.z(), flight);
  return flight;
}

}  // namespace vinerow::controllers

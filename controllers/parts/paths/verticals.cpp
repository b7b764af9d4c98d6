#include "controllers/parts/paths/verticals.h"

#include <cmath>
#include <vector>

namespace vinerow::controllers {
namespace {

PathPoint make_point(const Eigen::Vector3d& p_W, PathKind kind) {
  PathPoint point;
  point.p_W = p_W;
  point.kind = kind;
  return point;
}

}  // namespace

void add_take_off(const Eigen::Vector3d& start_W, PlannedPath& plan) {
  const Eigen::Vector3d first_W = plan.points.front().p_W;
  std::vector<PathPoint> points = {make_point(start_W, PathKind::kVertical)};
  const double across_m = (first_W - start_W).head<2>().norm();
  if (across_m > kAtPlace_m) {
    points.push_back(make_point({start_W.x(), start_W.y(), first_W.z()}, PathKind::kTransit));
  }
  plan.points.insert(plan.points.begin(), points.begin(), points.end());
  plan.length_m += std::abs(first_W.z() - start_W.z()) + across_m;
}

void add_landing(double rest_z_m, PlannedPath& plan) {
  plan.points.back().kind = PathKind::kVertical;
  const Eigen::Vector3d last_W = plan.points.back().p_W;
  plan.points.push_back(make_point({last_W.x(), last_W.y(), rest_z_m}, PathKind::kVertical));
  plan.length_m += std::abs(last_W.z() - rest_z_m);
}

}  // namespace vinerow::controllers

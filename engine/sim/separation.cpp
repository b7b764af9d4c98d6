#include "engine/sim/separation.h"

#include "engine/core/check.h"
#include "engine/physics/box_distance.h"

namespace vinerow {

Separation::Separation(int vehicles)
    : boxes_(static_cast<std::size_t>(vehicles)),
      closest_(boxes_.size()),
      pairs_(boxes_.size() * boxes_.size()) {
  VINEROW_DEMAND(vehicles > 0);
}

void Separation::place(int vehicle, const Pose& X_WB, const Eigen::Vector3d& centre_B,
                       const Eigen::Vector3d& half_extents_m) {
  Box& box = boxes_[vehicle];
  box.is_there = true;
  box.X_WC = {X_WB.q, X_WB * centre_B};
  box.half_m = half_extents_m;
  box.radius_m = half_extents_m.norm();
}

void Separation::update(Time now) {
  for (int a = 0; a < vehicles(); ++a) {
    for (int b = a + 1; b < vehicles(); ++b) {
      const Box &A = boxes_[a], &B = boxes_[b];
      if (!A.is_there || !B.is_there) continue;
      MinDistance& there = pairs_[pair(a, b)];
      const double spheres_m = (A.X_WC.p - B.X_WC.p).norm() - A.radius_m - B.radius_m;
      if (spheres_m >= there.distance_m) continue;
      const double distance_m = physics::box_distance_m(A.X_WC, A.half_m, B.X_WC, B.half_m);
      if (distance_m >= there.distance_m) continue;
      there = {distance_m, b, now, A.X_WC.p};
      pairs_[pair(b, a)] = {distance_m, a, now, B.X_WC.p};
      if (distance_m < closest_[a].distance_m) closest_[a] = there;
      if (distance_m < closest_[b].distance_m) closest_[b] = pairs_[pair(b, a)];
    }
  }
}

Separation::MinDistance Separation::closest(int a, int b) const {
  VINEROW_DEMAND(a != b);
  return pairs_[pair(a, b)];
}

const std::vector<ResultSpec>& separation_results() {
  static const std::vector<ResultSpec> results = {
      {"min_vehicle_distance_m", "m", ResultRange::from_zero(), "min distance between vehicles",
       "Smallest true distance between the box of this vehicle and that of any other, measured at "
       "20 Hz from the start of the run. Null if no other vehicle was present.",
       ""}};
  return results;
}

}  // namespace vinerow

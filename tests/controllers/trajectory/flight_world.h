#pragma once
/// A hillside with vine rows and a quadrotor's data sheet, for tests of planner `row_flight` and
/// guidance `trajectory`; and a run of the guidance without vehicle or controller.

#include <functional>
#include <memory>

#include "engine/api/messages/event.h"
#include "engine/api/messages/flight.h"
#include "engine/api/registry.h"
#include "tests/controllers/support/block_map.h"
#include "tests/controllers/support/mission.h"
#include "tests/support/plain_scene.h"

namespace vinerow::test {

using Phase = ReferenceTrajectory::Phase;

PlainScene make_flat(double height_m = 0.0);
/// 16 % uphill along y, with bumps of 0.15 m, 12 m from crest to crest.
PlainScene make_bumpy_slope();

/// Sets the rows' and alleys' points onto the ground.
RowMap put_on(RowMap map, const PlainScene& hill);

/// The Q4T-like quadrotor of the reference, section 5: tips 0.50 m from the centre.
VehicleDescription make_quadrotor_description();

/// Planner `row_flight` on a block of rows (block_map.h).
struct FlightBench {
  explicit FlightBench(BlockSetup block = {}, PlainScene ground = make_flat());

  /// From a place in the block's coordinates, standing on the ground.
  Result<PlannedPath> plan(double x, double y, double yaw_rad = 0.0);
  std::unique_ptr<Planner> make() const;
  double number(const char* name) const { return planner->report()->numbers.at(name); }

  BlockSetup setup;
  PlainScene hill;
  RowMap map;
  VehicleDescription vehicle = make_quadrotor_description();
  const SceneQuery* scene = &hill;
  Values values;
  std::unique_ptr<Planner> planner;
};

/// A point of a plan in between: arcs in the plane, straight in height.
struct PlanSample {
  Eigen::Vector3d p_W;
  PathKind kind;
};
/// Samples along a plan, at most step_m apart, made without the code under test.
std::vector<PlanSample> sample_plan(const PlannedPath& plan, double step_m);

/// Guidance `trajectory` between its signals, in a loop of 50 ms.
class GuideBench : public Loop {
 public:
  explicit GuideBench(const Values& values = {}, const std::string& type = "trajectory",
                      VehicleDescription vehicle = make_quadrotor_description());

  const ReferenceTrajectory& reference() const { return read<ReferenceTrajectory>("reference"); }
  /// The loop's, with what the guidance wants then.
  const ReferenceTrajectory& step() { return Loop::step(), reference(); }
  const ReferenceTrajectory& step(const Odometry& at) { return Loop::step(at), reference(); }
  /// Ticks until kDone or longest_s with a vehicle that is where the reference wants it and is
  /// stopped by a floor. `each` sees every reference.
  void fly(const Eigen::Vector3d& start, double longest_s, double floor_m,
           const std::function<void(double time_s, const ReferenceTrajectory&)>& each);
};

}  // namespace vinerow::test

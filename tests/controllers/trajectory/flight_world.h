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

namespace vinerow::test {

using Phase = ReferenceTrajectory::Phase;

/// Ground in closed form.
class Hill final : public SceneQuery {
 public:
  using Height = std::function<double(double x, double y)>;
  explicit Hill(Height height) : height_(std::move(height)) {}

  double at(const Eigen::Vector2d& p) const { return height_(p.x(), p.y()); }
  std::optional<RayHit> cast_ray(const Eigen::Vector3d&, const Eigen::Vector3d&, double,
                                 SurfaceMask) const override {
    return std::nullopt;
  }
  std::optional<double> ground_height_m(double x, double y, double) const override {
    return height_(x, y);
  }
  double distance_to_box_m(const vinerow::Pose&, const Eigen::Vector3d&, double max_distance_m,
                           SurfaceMask) const override {
    return max_distance_m;
  }

 private:
  Height height_;
};

Hill make_flat(double height_m = 0.0);
/// 16 % uphill along y, with bumps of 0.15 m, 12 m from crest to crest.
Hill make_bumpy_slope();

/// Sets the rows' and alleys' points onto the ground.
RowMap put_on(RowMap map, const Hill& hill);

/// The Q4T-like quadrotor of the reference, section 5: tips 0.50 m from the centre.
VehicleDescription make_quadrotor_description();

/// Planner `row_flight` on a block of rows (block_map.h).
struct FlightBench {
  explicit FlightBench(BlockSetup block = {}, Hill ground = make_flat());

  /// From a place in the block's coordinates, standing on the ground.
  Result<PlannedPath> plan(double x, double y, double yaw_rad = 0.0);
  std::unique_ptr<Planner> make() const;
  double number(const char* name) const { return planner->report()->numbers.at(name); }

  BlockSetup setup;
  Hill hill;
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

/// Guidance `trajectory` between its signals.
class GuideBench {
 public:
  explicit GuideBench(const Values& values = {}, const std::string& type = "trajectory",
                      VehicleDescription vehicle = make_quadrotor_description());

  void give_plan(const PlannedPath& plan);
  /// Until told otherwise.
  void give_authority(double stop_at_m) { authority_.write(now_, {stop_at_m, -1, ""}); }
  /// One tick of 50 ms with this estimate.
  const ReferenceTrajectory& step(const Odometry& estimate);
  const ReferenceTrajectory& step_blind();
  /// Ticks until kDone or longest_s with a vehicle that is where the reference wants it and is
  /// stopped by a floor. `each` sees every reference.
  void fly(const Eigen::Vector3d& start, double longest_s, double floor_m,
           const std::function<void(double time_s, const ReferenceTrajectory&)>& each);
  const std::vector<Event>& events() const { return events_; }
  double time_s() const { return 1e-9 * static_cast<double>(now_.ns); }

 private:
  void take_event();

  VehicleDescription vehicle_;
  SignalBus bus_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<PlannedPath> plan_;
  SignalWriter<MovementAuthority> authority_;
  SignalReader<ReferenceTrajectory> reference_;
  SignalReader<Event> news_;
  std::uint64_t news_seen_ = 0;
  std::unique_ptr<Guidance> guidance_;
  std::vector<Event> events_;
  Time now_;
};

}  // namespace vinerow::test

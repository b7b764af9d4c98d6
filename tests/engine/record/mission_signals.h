#pragma once
/// The signals of a rover's mission with the rates and the noise of a real run, without simulating
/// one: for the size and speed of logs, and for the sample logs that other readers check.

#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/flight.h"
#include "engine/api/messages/grid.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/path.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/signal.h"
#include "engine/core/random.h"

namespace vinerow::test {

/// Truth, links, wheels, contacts and battery 20 Hz, GPS 5 Hz, IMU 100 Hz, four ultrasounds 20 Hz,
/// follower, command and actuators 40 Hz, local command and a flyer's reference 5 Hz, once a map, a
/// path and its planner's tree, an event every ten seconds.
class MissionSignals {
 public:
  /// Divides every period.
  static constexpr Duration kTick{5'000'000};

  /// @param path_points  in the plan, which is written once
  explicit MissionSignals(int path_points = 100);

  /// Writes what is due. @param now  multiple of kTick
  void write(Time now);
  const std::vector<std::unique_ptr<SignalBase>>& signals() const { return bus_.signals(); }

 private:
  void write_motion(Time now);
  void write_wheels(Time now);
  void write_control(Time now);
  void write_planning(Time now);
  Eigen::Vector3d noise(double sigma);

  int path_points_;
  SignalBus bus_;
  RandomStream random_{1, "test", "mission"};
  Odometry truth_;
  LinkPoses links_;
  NamedValues wheels_, actuators_, contacts_;
  FollowerState follower_;
  BatteryState battery_;
  ReferenceTrajectory reference_;
  SignalWriter<Odometry> truth_out_;
  SignalWriter<LinkPoses> links_out_;
  SignalWriter<NamedValues> wheels_out_, actuators_out_, contacts_out_;
  SignalWriter<BatteryState> battery_out_;
  SignalWriter<GnssFix> gps_out_;
  SignalWriter<ImuSample> imu_out_;
  std::vector<SignalWriter<RangeSample>> range_outs_;
  SignalWriter<VelocityCommand> command_out_;
  SignalWriter<FollowerState> follower_out_;
  SignalWriter<PlannedPath> plan_out_;
  SignalWriter<LineList> tree_out_;
  SignalWriter<LocalCommand> local_command_out_;
  SignalWriter<ReferenceTrajectory> reference_out_;
  SignalWriter<OccupancyGrid> map_out_;
  SignalWriter<Event> event_out_;
};

}  // namespace vinerow::test

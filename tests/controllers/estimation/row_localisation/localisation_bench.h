#pragma once
/// An estimator on a map of rows between signals that a test writes by hand, every 10 ms.

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "controllers/estimation/row_localisation/range_prediction.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/registry.h"
#include "tests/controllers/support/mission.h"

namespace vinerow::test {

struct LocalisationBench {
  static constexpr Duration kTick{10'000'000};
  struct TimedEvent {
    Time time;
    Event event;
  };

  /// @param type  of the estimator  @param sensors  mounted as ultrasounds
  LocalisationBench(const std::string& type, const Values& values, const RowMap* map,
                    const std::vector<controllers::RangeSensorModel>& sensors,
                    const VehicleDescription* vehicle = nullptr, std::uint64_t seed = 1) {
    Ports world(bus, "robot", "test");
    truth_out = world.write<Odometry>("truth");
    ins_out = world.write<Odometry>("ins");
    gps_out = world.write<GnssFix>("gps");
    for (const controllers::RangeSensorModel& sensor : sensors) {
      ranges_out.push_back(world.write<RangeSample>(sensor.name));
      context.sensors.push_back({sensor.name, "ultrasound", sensor.X_BS});
    }
    context.vehicle = "robot";
    context.part = "robot.estimator";
    context.seed = seed;
    context.period = kTick;
    context.map = map;
    context.vehicle_description = vehicle;
    const PartSpec& spec = parts().spec(PartKind::kEstimator, type);
    estimator = parts().make_estimator(type, make_parameters(spec, values), context);
    Ports ports(bus, "robot", "robot.estimator");
    estimator->connect(ports);
    bus.check_connected();
    estimate = world.read<Odometry>("estimate");
    state = world.read<NamedValues>("estimator_state");
    event = world.read<Event>("estimator_event");
  }

  void write_motion(const Odometry& truth, const Odometry& ins) {
    truth_out.write(now, truth);
    ins_out.write(now, ins);
  }
  void write_fix(const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m) {
    GnssFix fix;
    fix.valid = true;
    fix.p_W = p_W;
    fix.std_m = std_m;
    gps_out.write(now, fix);
  }
  void write_range(int sensor, double range_m) { write_range(sensor, range_m, now); }
  void write_range(int sensor, double range_m, Time stamp) {
    RangeSample sample;
    sample.range_m = range_m;
    sample.max_range_m = 4.0;
    sample.half_angle_rad = half_angle_rad;
    ranges_out[sensor].write(stamp, sample);
  }
  /// The estimator's tick; then time goes on.
  void step() {
    estimator->step(now);
    if (event.is_newer_than(seen_event)) events.push_back({now, event.value()});
    now = now + kTick;
  }

  double half_angle_rad = 0.0;  ///< of the range sensors

  /// Of the estimator's state; NaN where it has no such number.
  double value(const std::string& name) const {
    const NamedValues& all = state.value();
    for (std::size_t i = 0; i < all.names.size(); ++i) {
      if (all.names[i] == name) return all.values[i];
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
  /// Events whose text contains `words`.
  std::vector<TimedEvent> events_with(const std::string& words) const {
    std::vector<TimedEvent> found;
    for (const TimedEvent& one : events) {
      if (one.event.text.find(words) != std::string::npos) found.push_back(one);
    }
    return found;
  }
  Eigen::Vector3d p_W() const { return estimate.value().X_WB.p; }

  SignalBus bus;
  EstimatorContext context;
  std::unique_ptr<Estimator> estimator;
  Time now;
  SignalWriter<Odometry> truth_out, ins_out;
  SignalWriter<GnssFix> gps_out;
  std::vector<SignalWriter<RangeSample>> ranges_out;
  SignalReader<Odometry> estimate;
  SignalReader<NamedValues> state;
  SignalReader<Event> event;
  std::uint64_t seen_event = 0;
  std::vector<TimedEvent> events;
};

/// Looking at an angle to the left of x of B, from its origin.
inline controllers::RangeSensorModel make_range_sensor(const std::string& name, double angle_rad) {
  controllers::RangeSensorModel sensor;
  sensor.name = name;
  sensor.X_BS.q = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ());
  return sensor;
}

}  // namespace vinerow::test

#pragma once
/// Any registered sensor on a bench with a wall, the ground, a lane and a vehicle that drives.

#include <memory>
#include <string>

#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sensors/sensor_parts.h"

namespace vinerow::test {

/// One wheel on each side in place of the steered axle.
inline void give_wheels(FixedVehicle& vehicle) {
  VehicleDescription& about = vehicle.description_;
  about.actuators = {{"wheel_l_speed_radps", "rad/s", -8.0, 8.0},
                     {"wheel_r_speed_radps", "rad/s", -8.0, 8.0}};
  about.wheeled = WheeledVehicle{.track_m = 1.0,
                                 .wheel_base_m = 1.0,
                                 .wheel_radius_m = 0.2,
                                 .wheel_speed_limit_radps = 8.0,
                                 .wheels = {{0, {0.0, 0.5}}, {1, {0.0, -0.5}}}};
}

/// With what works on lanes only: one along x from -100 m to 100 m.
struct ConformanceBench : SensorBench {
  /// @param type  of a registered sensor; it ticks at its default rate
  explicit ConformanceBench(const std::string& type, const SensorValues& values = {},
                            std::uint64_t seed = 1) {
    scene.add_wall(40.0);
    PlannedPath lane;
    lane.points.resize(2);
    lane.points[0].p_W = {-100, 0, 1};
    lane.points[1].p_W = {100, 0, 1};
    plan.write(Time{0}, lane);
    const double rate_Hz = sensor_registry().spec(PartKind::kSensor, type).default_rate_Hz;
    period = period_of_rate(rate_Hz);
    ParameterSet parameters = sensor_parameters(type, values);
    // A few of its 28,800 pulses a frame, so that thousands of frames take seconds.
    if (type == "lidar_3d") parameters.set("columns", std::int64_t{60});
    if (type == "camera") {
      parameters.set("width_px", std::int64_t{16}).set("height_px", std::int64_t{16});
    }
    if (type == "wheel_odometry") give_wheels(vehicle);
    sensor = sensor_registry().make_sensor(type, parameters, context(rate_Hz, seed));
    connect(*sensor);
    reading = bus.find("rover/s");
    exact = bus.find("rover/s_truth");
  }

  Time time_of(std::int64_t tick) const { return Time{tick * period.ns}; }

  /// Measures on a way to and fro before the wall; a sensor with a delay does not deliver yet.
  void step(std::int64_t tick) {
    Odometry state;
    state.X_WB.p = {38.5 + 0.01 * static_cast<double>(tick % 50), 0.0, 1.0};
    state.v_WB_B = {0.5, 0.0, 0.0};
    const Duration sampling = sensor->sampling();
    if (sampling.ns > 0) {
      // On the way from the last tick to this one.
      const Time from = tick > 0 ? time_of(tick - 1) + sampling : Time{0};
      for (Time now = from; now <= time_of(tick); now = now + sampling) {
        truth.write(now, state);
        sensor->sample(now);
      }
    } else {
      truth.write(time_of(tick), state);
    }
    sensor->step(time_of(tick));
  }

  Duration period;
  std::unique_ptr<Sensor> sensor;
  SignalBase* reading = nullptr;
  SignalBase* exact = nullptr;  ///< the truth beside it
};

/// Name, time and value of what a signal holds.
inline std::string digest_of(SignalBase& signal) {
  Hasher hasher;
  signal.hash_into(hasher);
  return hasher.hex();
}

}  // namespace vinerow::test

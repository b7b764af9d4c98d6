#include "controllers/estimation/error_state_options.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {

// Noise defaults: VectorNav VN-100/VN-200 data sheet (gyro 0.0035 deg/s/rtHz and 10 deg/h in-run,
// accelerometer 0.14 mg/rtHz and 0.04 mg in-run). The walks reach the in-run figure within 100 s.
std::vector<ParameterSpec> ErrorStateOptions::parameters() {
  return {
      text_parameter("imu", "imu", "signal of the inertial unit"),
      text_parameter("gnss", "gps", "signal of the satellite receiver"),
      text_parameter("barometer", "", "signal of the barometer; empty = none"),
      text_parameter("magnetometer", "", "signal of the magnetometer; empty = none"),
      text_parameter("wheels", "",
                     "signal of the wheel speeds of a ground vehicle; empty = none. With it the "
                     "vehicle is also taken not to slide sideways or to leave the ground"),
      choice_parameter("start", "drawn", {"drawn", "levelling"},
                       "drawn: about the truth at the first tick; levelling: tilt by the "
                       "accelerometer at rest, place by the first fix, heading by the magnetometer "
                       "or start_yaw_deg"),
      positive_parameter("levelling_s", "s", 1.0, "how long levelling takes a mean"),
      number_parameter("start_yaw_deg", "deg", 0.0, -360.0, 360.0,
                       "heading at the start (levelling without magnetometer)"),
      positive_parameter("start_std_m", "m", 0.5, "1 sigma of each coordinate at the start"),
      number_parameter("start_height_std_m", "m", 0.0, 0.0, 1e3,
                       "1 sigma of the height at the start; 0 = as start_std_m"),
      positive_parameter("start_velocity_std_mps", "m/s", 0.05,
                         "1 sigma of each velocity at the start"),
      positive_parameter("start_tilt_std_deg", "deg", 1.0,
                         "1 sigma of roll and pitch at the start"),
      positive_parameter("start_yaw_std_deg", "deg", 2.0, "1 sigma of the heading at the start"),
      positive_parameter("gyro_bias_std_dps", "deg/s", 0.02,
                         "1 sigma of the rate gyro's bias at the start"),
      positive_parameter("accel_bias_std_mps2", "m/s2", 0.02,
                         "1 sigma of the accelerometer's bias at the start"),
      positive_parameter("gyro_noise_dps_rtHz", "deg/s/sqrt(Hz)", 0.0035,
                         "white noise density of the rate gyro"),
      positive_parameter("accel_noise_mps2_rtHz", "m/s2/sqrt(Hz)", 0.00137,
                         "white noise density of the accelerometer"),
      number_parameter("gyro_walk_dps2_rtHz", "deg/s2/sqrt(Hz)", 2.8e-4, 0.0, 10.0,
                       "random walk of the gyro's bias"),
      number_parameter("accel_walk_mps3_rtHz", "m/s3/sqrt(Hz)", 3.9e-5, 0.0, 10.0,
                       "random walk of the accelerometer's bias"),
      positive_parameter("imu_timeout_s", "s", 0.1,
                         "after so long without a reading the vehicle is taken to go straight on"),
      positive_parameter("gate_sigma", "", 5.0, "measurements farther off are refused"),
      positive_parameter("restart_after_s", "s", 5.0,
                         "position begins anew at a fix when none was accepted for so long"),
      number_parameter("gnss_std_m", "m", 0.0, 0.0, 100.0,
                       "1 sigma of a fix; 0 = as the receiver states"),
      number_parameter("gnss_velocity_std_mps", "m/s", 0.0, 0.0, 100.0,
                       "1 sigma of the satellite velocity; 0 = as the receiver states, not used "
                       "where it states none"),
      number_parameter("gnss_correlation_s", "s", 0.0, 0.0, 1e4,
                       "how long an error of the position stays; its variance is taken times "
                       "2 correlation / period"),
      positive_parameter("barometer_std_m", "m", 0.5, "1 sigma of the barometer's height"),
      number_parameter("barometer_correlation_s", "s", 10.0, 0.0, 1e4,
                       "how long an error of that stays"),
      positive_parameter("magnetometer_std_deg", "deg", 3.0,
                         "1 sigma of the direction of the magnetic field"),
      number_parameter("magnetometer_correlation_s", "s", 1.0, 0.0, 1e4,
                       "how long an error of that stays"),
      number_parameter("declination_deg", "deg", 0.0, -180.0, 180.0,
                       "magnetic north from true north, positive to the east"),
      positive_parameter("wheel_std_mps", "m/s", 0.1, "1 sigma of the wheels' speed: slip"),
      positive_parameter("lateral_std_mps", "m/s", 0.1, "1 sigma of the speed sideways"),
      positive_parameter("vertical_std_mps", "m/s", 0.1, "1 sigma of the speed along body z"),
      number_parameter("wheel_correlation_s", "s", 2.0, 0.0, 1e4, "how long slip and sliding stay"),
      number_list_parameter("constraint_point_m", "m", {0.0, 0.0, 0.0},
                            "place in B that does not slide sideways (x, y, z)", 3),
      choice_parameter(
          "zero_velocity", "off", {"off", "wheels", "imu"},
          "how a standing vehicle is known: by its wheels, or by a quiet IMU while the "
          "estimate is slow"),
      positive_parameter("standing_s", "s", 0.5, "so long it must be quiet"),
      positive_parameter("standing_std_mps", "m/s", 0.01, "1 sigma of a standing vehicle's speed"),
  };
}

ErrorStateOptions ErrorStateOptions::read(const ParameterSet& parameters, const std::string& who) {
  const auto number = [&](const char* name) { return parameters.number(name); };
  const auto angle = [&](const char* name) { return rad_from_deg(parameters.number(name)); };
  ErrorStateOptions o;
  o.imu = parameters.text("imu");
  o.gnss = parameters.text("gnss");
  o.barometer = parameters.text("barometer");
  o.magnetometer = parameters.text("magnetometer");
  o.wheels = parameters.text("wheels");
  o.filter.imu = {angle("gyro_noise_dps_rtHz"), number("accel_noise_mps2_rtHz"),
                  angle("gyro_walk_dps2_rtHz"), number("accel_walk_mps3_rtHz")};
  o.filter.longest_step_s = number("imu_timeout_s");
  o.starts_level = parameters.text("start") == "levelling";
  o.levelling_s = number("levelling_s");
  o.start_yaw_rad = angle("start_yaw_deg");
  o.start_std_m = number("start_std_m");
  o.start_height_std_m = number("start_height_std_m");
  if (o.start_height_std_m == 0.0) o.start_height_std_m = o.start_std_m;
  o.start_velocity_std_mps = number("start_velocity_std_mps");
  o.start_tilt_std_rad = angle("start_tilt_std_deg");
  o.start_yaw_std_rad = angle("start_yaw_std_deg");
  o.gyro_bias_std_radps = angle("gyro_bias_std_dps");
  o.accel_bias_std_mps2 = number("accel_bias_std_mps2");
  o.gate_sigma = number("gate_sigma");
  o.restart_after_s = number("restart_after_s");
  o.gnss_std_m = number("gnss_std_m");
  o.gnss_velocity_std_mps = number("gnss_velocity_std_mps");
  o.gnss_correlation_s = number("gnss_correlation_s");
  o.barometer_std_m = number("barometer_std_m");
  o.barometer_correlation_s = number("barometer_correlation_s");
  o.magnetometer_std_rad = angle("magnetometer_std_deg");
  o.magnetometer_correlation_s = number("magnetometer_correlation_s");
  o.declination_rad = angle("declination_deg");
  o.wheel_std_mps = number("wheel_std_mps");
  o.lateral_std_mps = number("lateral_std_mps");
  o.vertical_std_mps = number("vertical_std_mps");
  o.wheel_correlation_s = number("wheel_correlation_s");
  const std::vector<double>& point = parameters.numbers("constraint_point_m");
  o.constraint_point_B = {point[0], point[1], point[2]};
  const std::string& standing = parameters.text("zero_velocity");
  o.standing = standing == "wheels" ? Standing::kWheels
               : standing == "imu"  ? Standing::kImu
                                    : Standing::kOff;
  o.standing_s = number("standing_s");
  o.standing_std_mps = number("standing_std_mps");
  if (o.standing == Standing::kWheels && o.wheels.empty()) {
    throw ConfigError(fmt::format(
        "{} (error_state_kalman): zero_velocity = wheels, but no signal is named in 'wheels'",
        who));
  }
  return o;
}

}  // namespace vinerow

#include "controllers/estimation/inertial/error_state_options.h"

#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

const ParameterTable<ErrorStateOptions>& error_state_table() {
  using P = ErrorStateOptions;
  using Filter = ErrorStateKalmanParams;
  const auto imu = [](auto member) { return inside(&P::filter, &Filter::imu, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("imu", &P::imu, "signal of the inertial unit")
          .text("gps", &P::gps, "signal of the satellite receiver")
          .formerly("gnss")
          .text("barometer", &P::barometer, "signal of the barometer; empty = none")
          .text("magnetometer", &P::magnetometer, "signal of the magnetometer; empty = none")
          .text("wheels", &P::wheels,
                "signal of the wheel speeds of a ground vehicle; empty = none. If set, the filter "
                "also assumes that the vehicle does not slide sideways or leave the ground")
          .text("heading", &P::heading,
                "signal of two satellite antennas (gnss_heading); empty = none")
          .choice("start", &P::starts_level, {{"drawn", false}, {"levelling", true}},
                  "drawn: about the truth at the first tick; levelling: tilt from the "
                  "accelerometer at rest, position from the first fix, heading from two antennas, "
                  "the magnetometer or start_yaw_deg")
          .number("levelling_s", "s", &P::levelling_s, kPositive, "averaging time of levelling")
          .degrees("start_yaw_deg", &P::start_yaw_rad, between(-360.0, 360.0),
                   "heading at the start (levelling without antennas and magnetometer)")
          .number("start_std_m", "m", &P::start_std_m, kPositive,
                  "1 sigma of each coordinate at the start")
          .number("start_height_std_m", "m", &P::start_height_std_m, between(0.0, 1e3),
                  "1 sigma of the height at the start; 0 = as start_std_m")
          .number("start_velocity_std_mps", "m/s", &P::start_velocity_std_mps, kPositive,
                  "1 sigma of each velocity at the start")
          .degrees("start_tilt_std_deg", &P::start_tilt_std_rad, kPositive,
                   "1 sigma of roll and pitch at the start")
          .degrees("start_yaw_std_deg", &P::start_yaw_std_rad, kPositive,
                   "1 sigma of the heading at the start")
          .number("gyro_bias_std_dps", "deg/s", &P::gyro_bias_std_radps, kPositive,
                  "1 sigma of the rate gyro's bias at the start", kDegrees)
          .number("accel_bias_std_mps2", "m/s2", &P::accel_bias_std_mps2, kPositive,
                  "1 sigma of the accelerometer's bias at the start")
          .number("gyro_noise_dps_rtHz", "deg/s/sqrt(Hz)", imu(&ImuNoise::gyro_radps_rtHz),
                  kPositive, "white noise density of the rate gyro", kDegrees)
          .number("accel_noise_mps2_rtHz", "m/s2/sqrt(Hz)", imu(&ImuNoise::accel_mps2_rtHz),
                  kPositive, "white noise density of the accelerometer")
          .number("gyro_walk_dps2_rtHz", "deg/s2/sqrt(Hz)", imu(&ImuNoise::gyro_walk_radps2_rtHz),
                  between(0.0, 10.0), "random walk of the gyro's bias", kDegrees)
          .number("accel_walk_mps3_rtHz", "m/s3/sqrt(Hz)", imu(&ImuNoise::accel_walk_mps3_rtHz),
                  between(0.0, 10.0), "random walk of the accelerometer's bias")
          .number("imu_timeout_s", "s", inside(&P::filter, &Filter::longest_step_s), kPositive,
                  "time without a reading after which the filter assumes straight motion")
          .number("gate_sigma", "", &P::gate_sigma, kPositive,
                  "limit of the innovation; measurements beyond it are rejected")
          .number("restart_after_s", "s", &P::restart_after_s, kPositive,
                  "time without an accepted fix after which the position restarts at a fix")
          .number("gnss_std_m", "m", &P::gnss_std_m, between(0.0, 100.0),
                  "1 sigma of a fix; 0 = as the receiver states")
          .number("gnss_velocity_std_mps", "m/s", &P::gnss_velocity_std_mps, between(0.0, 100.0),
                  "1 sigma of the satellite velocity; 0 = as the receiver states, not used if it "
                  "states none")
          .number("gnss_correlation_s", "s", &P::gnss_correlation_s, between(0.0, 1e4),
                  "correlation time of the position's error; inflates its variance by 2 "
                  "correlation / period")
          .number("barometer_std_m", "m", &P::barometer_std_m, kPositive,
                  "1 sigma of the barometer's height")
          .number("barometer_correlation_s", "s", &P::barometer_correlation_s, between(0.0, 1e4),
                  "correlation time of the error of the height")
          .degrees("magnetometer_std_deg", &P::magnetometer_std_rad, kPositive,
                   "1 sigma of the direction of the magnetic field")
          .number("magnetometer_correlation_s", "s", &P::magnetometer_correlation_s,
                  between(0.0, 1e4), "correlation time of the error of the direction")
          .number("heading_correlation_s", "s", &P::heading_correlation_s, between(0.0, 1e4),
                  "correlation time of the error of the two antennas' baseline")
          .degrees("declination_deg", &P::declination_rad, between(-180.0, 180.0),
                   "angle from true north to magnetic north, positive to the east")
          .number("wheel_std_mps", "m/s", &P::wheel_std_mps, kPositive,
                  "1 sigma of the wheels' speed: slip")
          .number("lateral_std_mps", "m/s", &P::lateral_std_mps, kPositive,
                  "1 sigma of the speed sideways")
          .number("vertical_std_mps", "m/s", &P::vertical_std_mps, kPositive,
                  "1 sigma of the speed along body z")
          .number("wheel_correlation_s", "s", &P::wheel_correlation_s, between(0.0, 1e4),
                  "correlation time of slip and sliding")
          .numbers("constraint_point_m", "m", &P::constraint_point_B, kAnyNumber,
                   "point in B that does not slide sideways (x, y, z)")
          .choice("zero_velocity", &P::stationary,
                  {{"off", P::Standing::kOff},
                   {"wheels", P::Standing::kWheels},
                   {"imu", P::Standing::kImu}},
                  "detector of a stationary vehicle: by its wheels, or by a quiet IMU while the "
                  "estimated speed is low")
          .number("standing_s", "s", &P::standing_s, kPositive,
                  "quiet time before the vehicle counts as stationary")
          .number("standing_std_mps", "m/s", &P::standing_std_mps, kPositive,
                  "1 sigma of a stationary vehicle's speed")
          .include(&P::initial_pose, initial_pose_table())
          .rule([](const P& p) -> std::string {
            return p.stationary == P::Standing::kWheels && p.wheels.empty()
                       ? "zero_velocity = wheels, but no signal is named in 'wheels'"
                       : "";
          });
  return table;
}

}  // namespace

void ErrorStateOptions::add_parameters(PartSpec& spec) {
  error_state_table().add_to(spec);
}

ErrorStateOptions ErrorStateOptions::read(const ParameterSet& parameters, const std::string& who) {
  ErrorStateOptions o = error_state_table().read(parameters, who + " (error_state_kalman)");
  if (o.start_height_std_m == 0.0) o.start_height_std_m = o.start_std_m;
  return o;
}

}  // namespace vinerow::controllers

#include "controllers/autopilot/ardupilot/ardupilot_dialect.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "controllers/autopilot/firmware/sensor_mounting.h"
#include "controllers/autopilot/frames/body_state.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

constexpr int kOutputs = 32;

}  // namespace

ArdupilotDialect::ArdupilotDialect(FirmwareParams params, const AutopilotContext& context,
                                   const std::string& who)
    : params_(std::move(params)),
      period_(context.period),
      vehicle_(*context.vehicle_truth),
      q_B_imu_(q_BS_of(params_.imu, context.sensors)),
      outputs_(*context.vehicle_description, params_.mixer, params_.channels, kOutputs, who) {
  constexpr std::size_t kRanges = std::tuple_size_v<decltype(ArdupilotState::ranges_m)>;
  if (params_.ranges.size() > kRanges) {
    throw ConfigError(fmt::format("{}: ranges has {} sensors; an autopilot takes {}", who,
                                  params_.ranges.size(), kRanges));
  }
  std::stable_sort(params_.sticks.begin(), params_.sticks.end(),
                   [](const StickMove& a, const StickMove& b) { return a.at_s < b.at_s; });
  for (int i = 1; i <= kOutputs; ++i) pulses_.names.push_back(fmt::format("servo_{}_us", i));
  pulses_.values.assign(kOutputs, 0.0);
}

void ArdupilotDialect::connect(Ports& ports) {
  truth_ = ports.read<Odometry>("truth");
  if (!params_.imu.empty()) imu_ = ports.read<ImuSample>(params_.imu);
  for (const std::string& sensor : params_.ranges) {
    ranges_.push_back(ports.read<RangeSample>(sensor));
  }
  if (!params_.airspeed.empty()) airspeed_ = ports.read<AirData>(params_.airspeed);
  if (params_.battery_V > 0.0) battery_ = ports.read<BatteryState>("battery");
}

std::string ArdupilotDialect::begin(Time now, Bytes outputs) {
  begin_ = now;
  const auto packet = parse_servo_packet(outputs);
  return packet ? std::string() : packet.reason();
}

Result<FirmwareState> ArdupilotDialect::write_state(Time now) {
  ++steps_;
  fill(now);
  const std::string_view line = line_.write(state_);
  if (line.empty()) return Failure{"would get a state that is not finite"};
  return FirmwareState{{reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}};
}

std::string ArdupilotDialect::take_outputs(Bytes outputs, NamedValues& actuators) {
  const auto packet = parse_servo_packet(outputs);
  if (!packet) return packet.reason();
  for (std::size_t i = 0; i < packet->pwm_us.size(); ++i) pulses_.values[i] = packet->pwm_us[i];
  outputs_.apply_pulses(std::span(packet->pwm_us).first(packet->channels), actuators);
  return {};
}

/// Without a sensor: what ideal gyroscopes and accelerometers show on the mean since the last
/// state, so that the firmware's estimator, which integrates them, gets the motion whole.
///   f_B = R_BW (dv_W / dt + g z), w_B dt = rotation vector of q_last^-1 q
/// with R at half the rotation. The first state has the values of the instant.
void ArdupilotDialect::measure_motion(Time now, const Odometry& truth) {
  const Eigen::Quaterniond& q_WB = truth.X_WB.q;
  const Eigen::Vector3d v_W = q_WB * truth.v_WB_B;
  Eigen::Vector3d w_B = truth.w_WB_B, f_B = vehicle_.specific_force_B();
  if (steps_ > 1) {
    const double dt_s = (now - last_time_).s();
    const Eigen::AngleAxisd turn(last_q_WB_.conjugate() * q_WB);
    w_B = turn.angle() / dt_s * turn.axis();
    const Eigen::Vector3d force_W =
        (v_W - last_v_W_) / dt_s + kStandardGravity_mps2 * Eigen::Vector3d::UnitZ();
    f_B = last_q_WB_.slerp(0.5, q_WB).conjugate() * force_W;
  }
  last_time_ = now;
  last_q_WB_ = q_WB;
  last_v_W_ = v_W;
  state_.gyro_FRD_radps = swap_frd_and_B(w_B);
  state_.specific_force_FRD_mps2 = swap_frd_and_B(f_B);
}

void ArdupilotDialect::fill(Time now) {
  const Odometry& truth = truth_.value();
  // ArduPilot adds each step truncated to whole microseconds. A nanosecond more in each keeps
  // rounding from losing one.
  state_.timestamp_s =
      1e-9 * static_cast<double>(static_cast<std::int64_t>(steps_) * (period_.ns + 1));
  state_.q_NED_FRD = q_NED_FRD_from(truth.X_WB.q);
  state_.position_NED_m = swap_ned_and_W(truth.X_WB.p);
  state_.velocity_NED_mps = swap_ned_and_W(truth.X_WB.q * truth.v_WB_B);
  if (imu_.connected()) {
    state_.gyro_FRD_radps = swap_frd_and_B(q_B_imu_ * imu_.value().w_WS_S);
    state_.specific_force_FRD_mps2 = swap_frd_and_B(q_B_imu_ * imu_.value().f_WS_S);
  } else {
    measure_motion(now, truth);
  }
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    // A field that is left out would keep its last value in the autopilot.
    constexpr double kNothing_m = 1.0;
    if (!ranges_[i].has_value()) {
      state_.ranges_m[i] = 0.0;
      continue;
    }
    const RangeSample& range = ranges_[i].value();
    state_.ranges_m[i] = std::min(range.range_m, range.max_range_m + kNothing_m);
  }
  if (airspeed_.has_value()) state_.airspeed_mps = airspeed_.value().v_air_B.x();
  if (battery_.has_value()) {
    state_.battery_V = params_.battery_V;
    state_.battery_A = battery_.value().power_W / params_.battery_V;
  }
  const double time_s = (now - begin_).s();
  while (next_stick_ < params_.sticks.size() && params_.sticks[next_stick_].at_s <= time_s) {
    const StickMove& move = params_.sticks[next_stick_++];
    state_.sticks_us[static_cast<std::size_t>(move.channel - 1)] =
        static_cast<std::uint16_t>(move.pulse_us);
  }
}

}  // namespace vinerow::controllers

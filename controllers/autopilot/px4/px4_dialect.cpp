#include "controllers/autopilot/px4/px4_dialect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "controllers/autopilot/firmware/sensor_mounting.h"
#include "controllers/autopilot/frames/body_state.h"
#include "controllers/autopilot/px4/hil_gps.h"
#include "controllers/autopilot/px4/px4_outputs.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/mavlink/enums.h"

namespace vinerow::controllers {
namespace {

/// Bits of HIL_SENSOR's fields_updated.
constexpr std::uint32_t kAccelerometerAndGyroscope = 0x3F, kMagnetometer = 0x1C0,
                        kDifferentialPressure = 0x400, kBarometer = 0x1A00;

constexpr double kGaussPerTesla = 1e4, kHectopascalPerPascal = 1e-2;

/// Between two states while PX4 boots: its sensors' rate is 250 Hz.
constexpr std::uint64_t kBootStep_us = 4000;

Eigen::Vector3f to_float(const Eigen::Vector3d& v) {
  return v.cast<float>();
}

constexpr double kZeroCelsius_K = 273.15;

struct StandardAir {
  double altitude_m, temperature_K, density_kgm3;
};

/// US Standard Atmosphere 1976 below 11 km at a pressure, which no thermometer of ours completes:
/// T = T0 (p / p0)^(R L / g), altitude (T0 - T) / L, density p / (R T).
StandardAir standard_air(double pressure_Pa) {
  constexpr double kSeaLevel_Pa = 101'325.0, kSeaLevel_K = 288.15, kLapse_Kpm = 0.0065;
  constexpr double kGasConstant_JpkgK = 287.053;
  constexpr double kExponent = kGasConstant_JpkgK * kLapse_Kpm / kStandardGravity_mps2;
  const double temperature_K = kSeaLevel_K * std::pow(pressure_Pa / kSeaLevel_Pa, kExponent);
  return {(kSeaLevel_K - temperature_K) / kLapse_Kpm, temperature_K,
          pressure_Pa / (kGasConstant_JpkgK * temperature_K)};
}

void check_sensors(const FirmwareParams& params, const std::string& who) {
  const std::pair<const char*, const std::string&> needed[] = {
      {"imu", params.imu},
      {"magnetometer", params.magnetometer},
      {"barometer", params.barometer},
      {"gnss", params.gnss}};
  for (const auto& [name, sensor] : needed) {
    if (!sensor.empty()) continue;
    throw ConfigError(fmt::format(
        "{}: {} is missing: PX4 makes up no readings, so name the vehicle's sensor for it "
        "(needed: imu, magnetometer, barometer, gnss)",
        who, name));
  }
}

/// Centimetres of a distance, at most what the message holds.
std::uint16_t centimetres(double metres) {
  return static_cast<std::uint16_t>(std::clamp(std::round(100.0 * metres), 0.0, 65535.0));
}

}  // namespace

Px4Dialect::Px4Dialect(FirmwareParams params, const AutopilotContext& context,
                       const std::string& who)
    : params_(std::move(params)),
      period_(context.period),
      frame_(context.origin),
      q_B_imu_(q_BS_of(params_.imu, context.sensors)),
      q_B_magnetometer_(q_BS_of(params_.magnetometer, context.sensors)),
      outputs_(*context.vehicle_description, params_.mixer,
               px4_output_channels(params_, *context.vehicle_description, who), kPx4Outputs, who) {
  check_sensors(params_, who);
  std::stable_sort(params_.sticks.begin(), params_.sticks.end(),
                   [](const StickMove& a, const StickMove& b) { return a.at_s < b.at_s; });
  for (const std::string& sensor : params_.ranges) {
    orientations_.push_back(range_orientation(sensor, context.sensors).value_or(0));
  }
  for (int i = 1; i <= kPx4Outputs; ++i) shares_.names.push_back(fmt::format("output_{}", i));
  shares_.values.assign(kPx4Outputs, 0.0);
}

void Px4Dialect::connect(Ports& ports) {
  truth_ = ports.read<Odometry>("truth");
  imu_ = ports.read<ImuSample>(params_.imu);
  magnetometer_ = ports.read<MagneticSample>(params_.magnetometer);
  barometer_ = ports.read<PressureSample>(params_.barometer);
  gnss_ = ports.read<GnssFix>(params_.gnss);
  if (!params_.airspeed.empty()) airspeed_ = ports.read<AirData>(params_.airspeed);
  for (std::size_t i = 0; i < params_.ranges.size(); ++i) {
    ranges_.push_back({ports.read<RangeSample>(params_.ranges[i]), orientations_[i]});
  }
}

std::string_view Px4Dialect::missing_sensor() const {
  if (!imu_.has_value()) return params_.imu;
  if (!magnetometer_.has_value()) return params_.magnetometer;
  return barometer_.has_value() ? std::string_view() : params_.barometer;
}

template <class M>
void Px4Dialect::add(const M& message) {
  const auto frame = writer_.write(message);
  bytes_.insert(bytes_.end(), frame.begin(), frame.end());
}

mavlink::HilSensor Px4Dialect::read_sensors(std::uint64_t stamp_us, bool sends_all) {
  mavlink::HilSensor message;
  message.time_usec = stamp_us;
  message.fields_updated = kAccelerometerAndGyroscope;
  const auto force = to_float(swap_frd_and_B(q_B_imu_ * imu_.value().f_WS_S));
  const auto rate = to_float(swap_frd_and_B(q_B_imu_ * imu_.value().w_WS_S));
  message.xacc = force.x(), message.yacc = force.y(), message.zacc = force.z();
  message.xgyro = rate.x(), message.ygyro = rate.y(), message.zgyro = rate.z();
  if (magnetometer_.is_newer_than(last_field_) || sends_all) {
    const auto field = to_float(
        kGaussPerTesla * swap_frd_and_B(q_B_magnetometer_ * magnetometer_.value().field_S_T));
    message.xmag = field.x(), message.ymag = field.y(), message.zmag = field.z();
    message.fields_updated |= kMagnetometer;
  }
  if (barometer_.is_newer_than(last_pressure_) || sends_all) {
    const StandardAir air = standard_air(barometer_.value().pressure_Pa);
    message.abs_pressure =
        static_cast<float>(kHectopascalPerPascal * barometer_.value().pressure_Pa);
    message.pressure_alt = static_cast<float>(air.altitude_m);
    message.temperature = static_cast<float>(air.temperature_K - kZeroCelsius_K);
    message.fields_updated |= kBarometer;
  }
  if (airspeed_.has_value() && (airspeed_.is_newer_than(last_air_) || sends_all)) {
    // A pitot tube measures the dynamic pressure of the air where it flies. Our sensor gives the
    // true speed; PX4 finds it back with pressure and temperature.
    const double speed_mps = std::max(0.0, airspeed_.value().v_air_B.x());
    const double density_kgm3 = standard_air(barometer_.value().pressure_Pa).density_kgm3;
    message.diff_pressure =
        static_cast<float>(kHectopascalPerPascal * 0.5 * density_kgm3 * speed_mps * speed_mps);
    message.fields_updated |= kDifferentialPressure;
  }
  return message;
}

FirmwareState Px4Dialect::boot_state(std::uint64_t number) {
  // The vehicle stands still and its sensors repeat their first readings. PX4 takes equal readings
  // for a broken sensor, so every second one differs by a little.
  bytes_.clear();
  const std::uint64_t stamp_us = number * kBootStep_us;
  constexpr std::uint64_t kPerFix = 25;
  if (gnss_.has_value() && number % kPerFix == 1) add(make_hil_gps(gnss_.value(), gnss_.stamp()));
  mavlink::HilSensor sensors = read_sensors(stamp_us, true);
  const float sign = number % 2 == 0 ? 1.0F : -1.0F;
  const float force = 0.01F * sign, rate = 0.001F * sign, field = 0.0005F * sign;
  sensors.xacc += force, sensors.yacc += force, sensors.zacc += force;
  sensors.xgyro += rate, sensors.ygyro += rate, sensors.zgyro += rate;
  sensors.xmag += field, sensors.ymag += field, sensors.zmag += field;
  sensors.abs_pressure += 0.01F * sign;
  add(sensors);
  return finish(stamp_us);
}

std::string Px4Dialect::begin(Time now, Bytes outputs) {
  begin_ = now;
  // How many states the boot took depends on the machine. Nothing of it stays but PX4's clock.
  writer_ = mavlink::FrameWriter(kSimulator);
  last_field_ = last_pressure_ = last_air_ = 0;
  std::string fault = "sent no outputs";
  reader_.read(outputs, [&](const mavlink::Frame& frame) {
    const auto controls = mavlink::read<mavlink::HilActuatorControls>(frame);
    if (!controls) return;
    boot_us_ = controls->time_usec;
    fault.clear();
  });
  return fault;
}

void Px4Dialect::add_truth(std::uint64_t stamp_us) {
  const Odometry& truth = truth_.value();
  const Geodetic place = frame_.to_geodetic(truth.X_WB.p);
  const Eigen::Quaterniond q = q_NED_FRD_from(truth.X_WB.q);
  const Eigen::Vector3d v = 100.0 * swap_ned_and_W(truth.X_WB.q * truth.v_WB_B);
  const auto rate = to_float(swap_frd_and_B(truth.w_WB_B));
  const auto degrees_e7 = [](double rad) {
    return static_cast<std::int32_t>(std::lround(1e7 * deg_from_rad(rad)));
  };
  mavlink::HilStateQuaternion message;
  message.time_usec = stamp_us;
  message.attitude_quaternion = {static_cast<float>(q.w()), static_cast<float>(q.x()),
                                 static_cast<float>(q.y()), static_cast<float>(q.z())};
  message.rollspeed = rate.x(), message.pitchspeed = rate.y(), message.yawspeed = rate.z();
  message.lat = degrees_e7(place.latitude_rad);
  message.lon = degrees_e7(place.longitude_rad);
  message.alt = static_cast<std::int32_t>(std::lround(1e3 * place.altitude_m));
  message.vx = static_cast<std::int16_t>(v.x());
  message.vy = static_cast<std::int16_t>(v.y());
  message.vz = static_cast<std::int16_t>(v.z());
  add(message);
}

void Px4Dialect::add_ranges(std::uint64_t stamp_us) {
  constexpr std::uint8_t kUltrasound = 1;  // MAV_DISTANCE_SENSOR
  constexpr double kNothing_m = 1.0;       // beyond the sensor's range
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    Rangefinder& finder = ranges_[i];
    if (!finder.reader.is_newer_than(finder.last)) continue;
    const RangeSample& range = finder.reader.value();
    mavlink::DistanceSensor message;
    message.time_boot_ms = static_cast<std::uint32_t>(stamp_us / 1000);
    message.min_distance = centimetres(range.min_range_m);
    message.max_distance = centimetres(range.max_range_m);
    message.current_distance = centimetres(std::min(range.range_m, range.max_range_m + kNothing_m));
    message.type = kUltrasound;
    message.id = static_cast<std::uint8_t>(i + 1);
    message.orientation = finder.orientation;
    message.covariance = 0;
    add(message);
  }
}

void Px4Dialect::add_sticks(Time now, std::uint64_t stamp_us) {
  if (params_.sticks.empty()) return;
  std::uint16_t* const places[] = {&pilot_.chan1_raw,  &pilot_.chan2_raw,  &pilot_.chan3_raw,
                                   &pilot_.chan4_raw,  &pilot_.chan5_raw,  &pilot_.chan6_raw,
                                   &pilot_.chan7_raw,  &pilot_.chan8_raw,  &pilot_.chan9_raw,
                                   &pilot_.chan10_raw, &pilot_.chan11_raw, &pilot_.chan12_raw};
  const double time_s = (now - begin_).s();
  while (next_stick_ < params_.sticks.size() && params_.sticks[next_stick_].at_s <= time_s) {
    const StickMove& move = params_.sticks[next_stick_++];
    *places[move.channel - 1] = static_cast<std::uint16_t>(move.pulse_us);
  }
  // A receiver of a remote control sends at about 50 Hz.
  constexpr std::uint64_t kStatesPerFrame = 5;
  if (next_stick_ == 0 || states_ % kStatesPerFrame != 0) return;
  pilot_.time_boot_ms = static_cast<std::uint32_t>(stamp_us / 1000);
  pilot_.chancount = static_cast<std::uint8_t>(std::size(places));
  add(pilot_);
}

Result<FirmwareState> Px4Dialect::write_state(Time now) {
  bytes_.clear();
  // The first state follows the last one of the boot.
  stamp_us_ = boot_us_ + static_cast<std::uint64_t>((now - begin_ + period_).ns / 1000);
  ++states_;
  add_truth(stamp_us_);
  add_ranges(stamp_us_);
  add_sticks(now, stamp_us_);
  if (gnss_.is_newer_than(last_fix_)) add(make_hil_gps(gnss_.value(), gnss_.stamp()));
  const mavlink::HilSensor sensors = read_sensors(stamp_us_, false);
  for (const float value :
       {sensors.xacc, sensors.yacc, sensors.zacc, sensors.xgyro, sensors.ygyro, sensors.zgyro,
        sensors.xmag, sensors.ymag, sensors.zmag, sensors.abs_pressure, sensors.diff_pressure}) {
    if (!std::isfinite(value)) return Failure{"would get a state that is not finite"};
  }
  add(sensors);
  return finish(stamp_us_);
}

std::string Px4Dialect::take_outputs(Bytes outputs, NamedValues& actuators) {
  std::string fault = "sent no outputs";
  reader_.read(outputs, [&](const mavlink::Frame& frame) {
    const auto controls = mavlink::read<mavlink::HilActuatorControls>(frame);
    if (!controls) return;
    fault.clear();
    if (controls->time_usec != stamp_us_) {
      fault = fmt::format("answered the state of its clock's {:.6f} s with outputs of {:.6f} s",
                          1e-6 * static_cast<double>(stamp_us_),
                          1e-6 * static_cast<double>(controls->time_usec));
      return;
    }
    for (std::size_t i = 0; i < controls->controls.size(); ++i) {
      const float share = controls->controls[i];
      if (!std::isfinite(share)) {
        fault = fmt::format("sent {} as output {}", share, i + 1);
        return;
      }
      shares_.values[i] = share;
    }
    // Disarmed, its outputs are zeros, which would be full for a reversed motor.
    const bool is_armed = (controls->mode & mavlink::kModeFlagArmed) != 0;
    if (!is_armed) return outputs_.apply_neutral(actuators);
    outputs_.apply_shares(controls->controls, actuators);
  });
  return fault;
}

}  // namespace vinerow::controllers

/// Mappings of sensor readings, battery and events.

#include <limits>

#include "engine/math/angles.h"
#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {
namespace {

// Constants of the ROS 2 definitions.
constexpr std::int8_t kStatusNoFix = -1;
constexpr std::int8_t kStatusFix = 0;
constexpr std::int8_t kStatusSbas = 1;
constexpr std::int8_t kStatusGbas = 2;  // corrections from the ground: RTK
constexpr std::uint16_t kServiceGps = 1;
constexpr std::uint8_t kCovarianceDiagonalKnown = 2;
constexpr std::uint8_t kUltrasound = 0;
constexpr std::uint8_t kCharging = 1;
constexpr std::uint8_t kDischarging = 2;
constexpr std::uint8_t kNotCharging = 3;

std::int8_t status_of(const GnssFix& fix) {
  if (!fix.valid) return kStatusNoFix;
  if (fix.mode == GnssFix::Mode::kSbas) return kStatusSbas;
  return fix.mode >= GnssFix::Mode::kFloat ? kStatusGbas : kStatusFix;
}

constexpr float kNotMeasured = std::numeric_limits<float>::quiet_NaN();

}  // namespace

void RosMapping<ImuSample>::write(CdrWriter& out, const WriteContext& to, const ImuSample& value) {
  write_header(out, to.stamp, to.frames.own);
  // No orientation: identity, marked by -1 as the first covariance.
  const double orientation[4 + 9] = {0, 0, 0, 1, -1};
  out.add_doubles(orientation, 4 + 9);
  out.add(value.w_WS_S);
  out.add_zero_doubles(9);
  out.add(value.f_WS_S);
  out.add_zero_doubles(9);
}

bool RosMapping<ImuSample>::read(CdrReader& in, const FrameNames&, ImuSample& value) {
  skip_header(in);
  in.skip_doubles(4 + 9);
  in.read(value.w_WS_S);
  in.skip_doubles(9);
  in.read(value.f_WS_S);
  in.skip_doubles(9);
  return in.ok();
}

void RosMapping<GnssFix>::write(CdrWriter& out, const WriteContext& to, const GnssFix& value) {
  write_header(out, to.stamp, to.frames.own);
  out.add(status_of(value));
  out.add(kServiceGps);
  out.add(deg_from_rad(value.latitude_rad));
  out.add(deg_from_rad(value.longitude_rad));
  out.add(value.altitude_m);
  const double covariance[9] = {variance(value.std_m.x()), 0, 0, 0,
                                variance(value.std_m.y()), 0, 0, 0,
                                variance(value.std_m.z())};
  out.add_doubles(covariance, 9);
  out.add(kCovarianceDiagonalKnown);
}

void RosMapping<RangeSample>::write(CdrWriter& out, const WriteContext& to,
                                    const RangeSample& value) {
  write_header(out, to.stamp, to.frames.own);
  out.add(kUltrasound);
  out.add(static_cast<float>(2 * value.half_angle_rad));
  out.add(static_cast<float>(value.min_range_m));
  out.add(static_cast<float>(value.max_range_m));
  out.add(static_cast<float>(value.range_m));
}

void RosMapping<PressureSample>::write(CdrWriter& out, const WriteContext& to,
                                       const PressureSample& value) {
  write_header(out, to.stamp, to.frames.own);
  out.add(value.pressure_Pa);
  out.add(variance(value.std_Pa));
}

bool RosMapping<PressureSample>::read(CdrReader& in, const FrameNames&, PressureSample& value) {
  skip_header(in);
  value.pressure_Pa = in.read<double>();
  value.std_Pa = std_of_variance(in.read<double>());
  return in.ok();
}

void RosMapping<MagneticSample>::write(CdrWriter& out, const WriteContext& to,
                                       const MagneticSample& value) {
  write_header(out, to.stamp, to.frames.own);
  out.add(value.field_S_T);
  const double var = variance(value.std_T);
  const double covariance[9] = {var, 0, 0, 0, var, 0, 0, 0, var};
  out.add_doubles(covariance, 9);
}

bool RosMapping<MagneticSample>::read(CdrReader& in, const FrameNames&, MagneticSample& value) {
  skip_header(in);
  in.read(value.field_S_T);
  value.std_T = std_of_variance(in.read<double>());
  in.skip_doubles(8);
  return in.ok();
}

void RosMapping<LaserScan>::write(CdrWriter& out, const WriteContext& to, const LaserScan& value) {
  write_header(out, to.stamp, to.frames.own);
  const auto steps = value.ranges_m.empty() ? 0.0 : static_cast<double>(value.ranges_m.size() - 1);
  out.add(static_cast<float>(value.first_angle_rad));
  out.add(static_cast<float>(value.first_angle_rad + steps * value.angle_step_rad));
  out.add(static_cast<float>(value.angle_step_rad));
  out.add(0.0f);  // time_increment: all rays have the same time
  out.add(0.0f);  // scan_time
  out.add(static_cast<float>(value.min_range_m));
  out.add(static_cast<float>(value.max_range_m));
  out.add_count(value.ranges_m.size());
  for (const double range_m : value.ranges_m) out.add(static_cast<float>(range_m));
  out.add_count(0);  // intensities
}

void RosMapping<BatteryState>::write(CdrWriter& out, const WriteContext& to,
                                     const BatteryState& value) {
  write_header(out, to.stamp, to.frames.body);
  // voltage, temperature, current, charge, capacity, design_capacity: the model has only power and
  // energy.
  for (int i = 0; i < 6; ++i) out.add(kNotMeasured);
  out.add(static_cast<float>(value.charge));
  out.add(value.power_W > 0 ? kDischarging : value.power_W < 0 ? kCharging : kNotCharging);
  out.add(std::uint8_t{0});  // health unknown
  out.add(std::uint8_t{0});  // technology unknown
  out.add(true);             // present
  out.add_count(0);          // cell_voltage
  out.add_count(0);          // cell_temperature
  out.add(std::string_view());
  out.add(std::string_view());
}

void RosMapping<Event>::write(CdrWriter& out, const WriteContext& to, const Event& value) {
  write_time(out, to.stamp);
  out.add(static_cast<std::uint8_t>(value.level));
  out.add(std::string_view(value.source));
  out.add(std::string_view(value.text));
  out.add(std::string_view());  // file
  out.add(std::string_view());  // function
  out.add(std::uint32_t{0});    // line
}

bool RosMapping<Event>::read(CdrReader& in, const FrameNames&, Event& value) {
  skip_time(in);
  const auto level = in.read<std::uint8_t>();
  if (level != 20 && level != 30 && level != 40) return false;
  value.level = static_cast<Event::Level>(level);
  in.read(value.source);
  in.read(value.text);
  in.read_text();
  in.read_text();
  in.read<std::uint32_t>();
  return in.ok();
}

}  // namespace vinerow::record

#include "controllers/autopilot/px4/hil_gps.h"

#include <cmath>

#include "controllers/autopilot/mavlink/gps_input.h"
#include "controllers/autopilot/mavlink/parameter_value.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
mavlink::HilGps make_hil_gps(const GnssFix& fix, Time now) {
  const mavlink::GpsInput input = make_gps_input(fix, now);
  mavlink::HilGps gps;
  // PX4 takes it for the time of day.
  gps.time_usec = static_cast<std::uint64_t>(kFirmwareStart_s * 1'000'000 + now.ns / 1000);
  gps.fix_type = input.fix_type;
  gps.lat = input.lat;
  gps.lon = input.lon;
  gps.satellites_visible = input.satellites_visible;
  constexpr std::uint16_t kUnknown = 65535;
  gps.eph = gps.epv = gps.vel = gps.cog = kUnknown;
  if (!fix.valid) return gps;
  constexpr double kMillimetres = 1e3, kCentimetres = 1e2, kCentidegrees = 1e2;
  gps.alt = nearest<std::int32_t>(kMillimetres * fix.altitude_m);
  gps.eph = nearest<std::uint16_t>(kCentimetres * input.horiz_accuracy);
  gps.epv = nearest<std::uint16_t>(kCentimetres * input.vert_accuracy);
  gps.vn = nearest<std::int16_t>(kCentimetres * input.vn);
  gps.ve = nearest<std::int16_t>(kCentimetres * input.ve);
  gps.vd = nearest<std::int16_t>(kCentimetres * input.vd);
  gps.vel = nearest<std::uint16_t>(kCentimetres * std::hypot(input.vn, input.ve));
  const double course_deg = deg_from_rad(std::atan2(input.ve, input.vn));
  gps.cog =
      nearest<std::uint16_t>(kCentidegrees * (course_deg < 0.0 ? course_deg + 360.0 : course_deg));
  return gps;
}

}  // namespace vinerow::controllers

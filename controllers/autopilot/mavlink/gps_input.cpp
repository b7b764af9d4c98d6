#include "controllers/autopilot/mavlink/gps_input.h"

#include <algorithm>
#include <cmath>

#include "engine/io/missions/mission_items.h"
#include "engine/mavlink/enums.h"

namespace vinerow::controllers {
namespace {

std::uint8_t fix_type_of(const GnssFix& fix) {
  return mavlink::fix_type(fix.valid, static_cast<int>(fix.mode));
}

}  // namespace

mavlink::GpsInput make_gps_input(const GnssFix& fix, Time now) {
  mavlink::GpsInput input;
  // GPS time counts weeks since 6 January 1980 and is 18 s ahead of UTC.
  constexpr std::int64_t kGpsEpoch_s = 315'964'800, kLeap_s = 18, kWeek_s = 604'800;
  const std::int64_t gps_ms =
      (kFirmwareStart_s - kGpsEpoch_s + kLeap_s) * 1000 + now.ns / 1'000'000;
  input.time_usec = static_cast<std::uint64_t>(now.ns / 1000);
  input.time_week = static_cast<std::uint16_t>(gps_ms / (1000 * kWeek_s));
  input.time_week_ms = static_cast<std::uint32_t>(gps_ms % (1000 * kWeek_s));
  input.fix_type = fix_type_of(fix);
  if (!fix.valid) return input;
  const io::PlaceE7 place = io::place_e7({fix.latitude_rad, fix.longitude_rad, fix.altitude_m});
  input.lat = place.latitude;
  input.lon = place.longitude;
  input.alt = static_cast<float>(fix.altitude_m);
  input.vn = static_cast<float>(fix.v_W.y());
  input.ve = static_cast<float>(fix.v_W.x());
  input.vd = static_cast<float>(-fix.v_W.z());
  const double horizontal_m = std::hypot(fix.std_m.x(), fix.std_m.y());
  input.horiz_accuracy = static_cast<float>(horizontal_m);
  input.vert_accuracy = static_cast<float>(fix.std_m.z());
  // A receiver without its own figure is taken as a good one: 0.1 m/s.
  constexpr double kSpeedStd_mps = 0.1;
  const double speed_mps = fix.velocity_std_mps > 0.0 ? fix.velocity_std_mps : kSpeedStd_mps;
  input.speed_accuracy = static_cast<float>(speed_mps);
  // Models without satellites count as one with a good view of the sky. The dilution follows from
  // it only roughly; autopilots use it to refuse bad fixes.
  constexpr std::int32_t kManySatellites = 14;
  const std::int32_t satellites = fix.satellites > 0 ? fix.satellites : kManySatellites;
  input.satellites_visible = static_cast<std::uint8_t>(std::min(satellites, 255));
  input.hdop = 10.0F / static_cast<float>(std::max(satellites, 4));
  input.vdop = 1.5F * input.hdop;
  return input;
}

}  // namespace vinerow::controllers

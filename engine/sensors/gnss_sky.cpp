#include "engine/sensors/gnss_sky.h"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/math/angles.h"

// Direction to a satellite at the instant t. Frames: E turns with the Earth (x through the equator
// at Greenwich, z through the north pole), W is east, north, up at the world's origin.
//
//   u    = phase_rad + phase_rate age              argument of latitude, age = t - epoch
//   node = node_rad + node_rate age - theta(t)     longitude of the ascending node
//   p_E  = radius Rz(node) (cos u, sin u cos i, sin u sin i)
//   direction_W = R_WE (p_E - origin_E), normalised
//
// theta is the sidereal angle of Greenwich, i the inclination.

namespace vinerow::sensors {
namespace {

using Eigen::Vector3d;

constexpr double kDay_s = 86'400.0;
/// Sidereal angle of Greenwich at 2000-01-01 12:00 UTC, and its rate. Meeus, eq. (12.4).
constexpr double kSiderealAngle2000_deg = 280.46061837;
constexpr double kEarthTurn_degpd = 360.98564736629;

/// Seconds since 2000-01-01 12:00.
double instant_of(std::chrono::year_month_day day, double seconds_of_day) {
  using std::chrono::sys_days;
  constexpr std::chrono::year_month_day kReference{std::chrono::year{2000}, std::chrono::month{1},
                                                   std::chrono::day{1}};
  const auto days = (sys_days{day} - sys_days{kReference}).count();
  return static_cast<double>(days) * kDay_s + seconds_of_day - kDay_s / 2.0;
}

double instant_of(int year, unsigned month, unsigned day) {
  return instant_of({std::chrono::year{year}, std::chrono::month{month}, std::chrono::day{day}},
                    0.0);
}

/// Position in E of a point on the WGS84 ellipsoid or above it:
///   ((N + h) cos lat cos lon, (N + h) cos lat sin lon, (N (1 - e^2) + h) sin lat)
/// with the prime vertical radius N = a / sqrt(1 - e^2 sin^2 lat).
Vector3d position_on_earth(const GeoOrigin& place) {
  constexpr double kRadius_m = 6'378'137.0, kFlattening = 1.0 / 298.257223563;
  constexpr double kE2 = kFlattening * (2.0 - kFlattening);
  const double sin_lat = std::sin(place.latitude_rad), cos_lat = std::cos(place.latitude_rad);
  const double normal_m = kRadius_m / std::sqrt(1.0 - kE2 * sin_lat * sin_lat);
  const double across_m = (normal_m + place.altitude_m) * cos_lat;
  return {across_m * std::cos(place.longitude_rad), across_m * std::sin(place.longitude_rad),
          (normal_m * (1.0 - kE2) + place.altitude_m) * sin_lat};
}

/// R_WE: its rows are east, north and up in E.
Eigen::Matrix3d local_axes(const GeoOrigin& place) {
  const double sin_lat = std::sin(place.latitude_rad), cos_lat = std::cos(place.latitude_rad);
  const double sin_lon = std::sin(place.longitude_rad), cos_lon = std::cos(place.longitude_rad);
  Eigen::Matrix3d R_WE;
  R_WE << -sin_lon, cos_lon, 0.0,                       //
      -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat,  //
      cos_lat * cos_lon, cos_lat * sin_lon, sin_lat;
  return R_WE;
}

}  // namespace

double sidereal_angle_rad(double instant_s) {
  const double turned_deg = kSiderealAngle2000_deg + kEarthTurn_degpd * (instant_s / kDay_s);
  return rad_from_deg(std::remainder(turned_deg, 360.0));
}

double read_utc(std::string_view text, std::string_view name) {
  // Fixed columns: 2024-06-15T10:00:00
  constexpr std::string_view kForm = "0000-00-00T00:00:00";
  bool fits = text.size() == kForm.size();
  for (std::size_t i = 0; fits && i < kForm.size(); ++i) {
    fits = kForm[i] == '0' ? text[i] >= '0' && text[i] <= '9' : text[i] == kForm[i];
  }
  const auto field = [&](std::size_t at, std::size_t length) {
    unsigned value = 0;
    std::from_chars(text.data() + at, text.data() + at + length, value);
    return value;
  };
  if (fits) {
    const std::chrono::year_month_day day{std::chrono::year{static_cast<int>(field(0, 4))},
                                          std::chrono::month{field(5, 2)},
                                          std::chrono::day{field(8, 2)}};
    const unsigned hour = field(11, 2), minute = field(14, 2), second = field(17, 2);
    if (day.ok() && hour < 24 && minute < 60 && second < 60) {
      return instant_of(day, 3600.0 * hour + 60.0 * minute + second);
    }
  }
  throw ConfigError(fmt::format(
      "{} = '{}', must be a date and time in UTC like 2024-06-15T10:00:00", name, text));
}

Vector3d CircularOrbit::position_E(double instant_s) const {
  // remainder() keeps the angles small, so that sin and cos lose no digits after years.
  const double age_s = instant_s - epoch_s;
  const double u = std::remainder(phase_rad + phase_rate_radps * age_s, 2.0 * kPi);
  const double node = node_rad + node_rate_radps * age_s - sidereal_angle_rad(instant_s);
  const double along = std::cos(u), across = std::sin(u) * std::cos(inclination_rad);
  return radius_m * Vector3d(std::cos(node) * along - std::sin(node) * across,
                             std::sin(node) * along + std::cos(node) * across,
                             std::sin(u) * std::sin(inclination_rad));
}

std::vector<CircularOrbit> gps_orbits() {
  // Per plane: right ascension of the node and arguments of latitude of its four slots, deg.
  constexpr double kPlanes[6][5] = {
      {272.847, 268.126, 161.786, 11.676, 41.806},  {332.847, 80.956, 173.336, 309.976, 204.376},
      {32.847, 111.876, 11.796, 339.666, 241.556},  {92.847, 135.226, 265.446, 35.156, 167.356},
      {152.847, 197.046, 302.596, 66.066, 333.686}, {212.847, 238.886, 345.226, 105.206, 135.346}};
  // Table A-2-1 of the standard: the node regresses by 4.4874e-7 deg/s.
  constexpr double kNodeRate_degpd = -4.4874e-7 * kDay_s;
  // Two turns per turn of the Earth relative to the node: the ground track repeats every day.
  constexpr double kPhaseRate_degpd = 2.0 * (kEarthTurn_degpd - kNodeRate_degpd);
  constexpr double kRadius_m = 26'559'700.0, kInclination_deg = 55.0;  // of the standard
  std::vector<CircularOrbit> orbits;
  for (const auto& plane : kPlanes) {
    for (int slot = 1; slot <= 4; ++slot) {
      CircularOrbit orbit;
      orbit.radius_m = kRadius_m;
      orbit.inclination_rad = rad_from_deg(kInclination_deg);
      orbit.epoch_s = instant_of(1993, 7, 1);
      orbit.node_rad = rad_from_deg(plane[0]);
      orbit.node_rate_radps = rad_from_deg(kNodeRate_degpd) / kDay_s;
      orbit.phase_rad = rad_from_deg(plane[slot]);
      orbit.phase_rate_radps = rad_from_deg(kPhaseRate_degpd) / kDay_s;
      orbits.push_back(orbit);
    }
  }
  return orbits;
}

std::vector<CircularOrbit> galileo_orbits() {
  // Walker 24/3/1: planes 120 deg apart, slots 45 deg apart, and a phase shift of 360 / 24 = 15 deg
  // from one plane to the next. Numbers of the reference constellation (gnss_sky.h).
  constexpr double kRadius_m = 29'600'318.0, kInclination_deg = 56.0;
  constexpr double kFirstNode_deg = 25.0, kPlaneSpacing_deg = 120.0;
  constexpr double kFirstPhase_deg = 338.333, kSlotSpacing_deg = 45.0, kPhaseShift_deg = 15.0;
  constexpr double kNodeRate_degpd = -0.02764398, kPhaseRate_degpd = 613.72253566;
  std::vector<CircularOrbit> orbits;
  for (int plane = 0; plane < 3; ++plane) {
    for (int slot = 0; slot < 8; ++slot) {
      CircularOrbit orbit;
      orbit.radius_m = kRadius_m;
      orbit.inclination_rad = rad_from_deg(kInclination_deg);
      orbit.epoch_s = instant_of(2010, 3, 21);
      orbit.node_rad = rad_from_deg(kFirstNode_deg + kPlaneSpacing_deg * plane);
      orbit.node_rate_radps = rad_from_deg(kNodeRate_degpd) / kDay_s;
      orbit.phase_rad =
          rad_from_deg(kFirstPhase_deg + kSlotSpacing_deg * slot + kPhaseShift_deg * plane);
      orbit.phase_rate_radps = rad_from_deg(kPhaseRate_degpd) / kDay_s;
      orbits.push_back(orbit);
    }
  }
  return orbits;
}

GnssSky::GnssSky(const GeoOrigin& origin, std::vector<CircularOrbit> orbits, double start_s)
    : orbits_(std::move(orbits)),
      start_s_(start_s),
      origin_E_(position_on_earth(origin)),
      R_WE_(local_axes(origin)) {}

Vector3d GnssSky::direction_W(std::size_t satellite, double time_s) const {
  const Vector3d away_E = orbits_[satellite].position_E(start_s_ + time_s) - origin_E_;
  return (R_WE_ * away_E).normalized();
}

const ParameterTable<GnssSkyParams>& gnss_sky_table() {
  using P = GnssSkyParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .texts("constellations", &P::constellations, "constellations it receives: gps, galileo")
          .text("epoch_utc", &P::epoch_utc,
                "date and time at the start of the run, which determine the satellites' positions");
  return table;
}

GnssSky make_gnss_sky(const GnssSkyParams& params, const GeoOrigin& origin,
                      const std::string& who) {
  static const std::vector<std::string> kKnown = {"gps", "galileo"};
  std::vector<CircularOrbit> orbits;
  std::vector<std::string> seen;
  for (const std::string& name : params.constellations) {
    if (std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end()) {
      throw ConfigError(fmt::format("{}: constellations: unknown constellation '{}'{} (known: {})",
                                    who, name, did_you_mean(name, kKnown), join(kKnown)));
    }
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
      throw ConfigError(fmt::format("{}: constellations: '{}' is given twice", who, name));
    }
    seen.push_back(name);
    const std::vector<CircularOrbit> more = name == "gps" ? gps_orbits() : galileo_orbits();
    orbits.insert(orbits.end(), more.begin(), more.end());
  }
  if (orbits.empty()) {
    throw ConfigError(
        fmt::format("{}: constellations is empty, must name one of: {}", who, join(kKnown)));
  }
  return GnssSky(origin, std::move(orbits), read_utc(params.epoch_utc, who + ": epoch_utc"));
}

}  // namespace vinerow::sensors

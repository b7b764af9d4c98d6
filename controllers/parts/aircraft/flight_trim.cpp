#include "controllers/parts/aircraft/flight_trim.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/parts/aircraft/trim_solver.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kSpeedAccuracy_mps = 1e-3;
constexpr double kSearchRatio = 1.05;
constexpr double kSearchSpan = 5.0;
constexpr const char* kNoBalance = "lift, thrust and moments do not balance";

bool is_in_range(const Aircraft& aircraft, const AircraftControls& controls) {
  const AircraftControls limited = aircraft.limit(controls);
  return limited.throttle == controls.throttle &&
         std::abs(limited.elevator_rad - controls.elevator_rad) +
                 std::abs(limited.aileron_rad - controls.aileron_rad) <
             1e-12;
}

std::optional<Trim> solve_in_range(const Aircraft& aircraft, TrimSolver& solver,
                                   const TrimRequest& request) {
  std::optional<Trim> trim = solver.solve(request);
  return trim && is_in_range(aircraft, trim->controls) ? trim : std::nullopt;
}

std::string say_request(const TrimRequest& request) {
  return fmt::format("{:.2f} m/s, climb {:.1f} deg, bank {:.1f} deg", request.airspeed_mps,
                     deg_from_rad(request.climb_angle_rad), deg_from_rad(request.bank_rad));
}

/// By how much the elevons are beyond their range; empty if they are within it.
std::string say_elevons(const Aircraft& aircraft, const AircraftControls& controls) {
  const auto said = [&](const char* side, int index, double angle_rad) -> std::string {
    const ActuatorSpec& spec = aircraft.actuators[static_cast<std::size_t>(index)];
    if (angle_rad >= spec.min && angle_rad <= spec.max) return "";
    return fmt::format("it takes the {} elevon at {:.1f} deg, which reaches {:.1f} to {:.1f} deg",
                       side, deg_from_rad(angle_rad), deg_from_rad(spec.min),
                       deg_from_rad(spec.max));
  };
  const std::string left =
      said("left", aircraft.elevon_left, controls.elevator_rad + controls.aileron_rad);
  return left.empty()
             ? said("right", aircraft.elevon_right, controls.elevator_rad - controls.aileron_rad)
             : left;
}

/// Lift that the wings lack; empty if it suffices.
std::string say_lift(const Aircraft& aircraft, TrimSolver& solver, const TrimRequest& request) {
  const double needed_N = aircraft.flight_model->mass_kg() * aircraft.gravity_mps2 *
                          std::cos(request.climb_angle_rad) / std::cos(request.bank_rad);
  const TrimSolver::Lift max_lift =
      solver.largest_lift(request.airspeed_mps, request.climb_angle_rad);
  if (max_lift.lift_N >= needed_N) return "";
  if (max_lift.lift_N <= 0.0) {
    return fmt::format("the elevons, {:.1f} to {:.1f} deg, balance it at no incidence",
                       deg_from_rad(aircraft.elevon_min_rad()),
                       deg_from_rad(aircraft.elevon_max_rad()));
  }
  std::string said = fmt::format(
      "it takes {:.1f} N of lift and the wings give at most {:.1f} N at {:.1f} deg of "
      "incidence",
      needed_N, max_lift.lift_N, deg_from_rad(max_lift.alpha_rad));
  if (aircraft.wing_area_m2 > 0.0) {
    const double coefficient_N = 0.5 * aircraft.air_density_kgm3 * request.airspeed_mps *
                                 request.airspeed_mps * aircraft.wing_area_m2;
    said += fmt::format(" (lift coefficient {:.2f} of at most {:.2f})", needed_N / coefficient_N,
                        max_lift.lift_N / coefficient_N);
  }
  return said;
}

/// Reason for the missing trim, without the request.
std::string say_reason(const Aircraft& aircraft, TrimSolver& solver, const TrimRequest& request) {
  const std::string lift = say_lift(aircraft, solver, request);
  if (!lift.empty()) return lift;
  const std::optional<Trim> beyond = solver.solve(request);
  if (beyond) {
    const std::string elevons = say_elevons(aircraft, beyond->controls);
    if (!elevons.empty()) return elevons;
  }
  const std::optional<Trim> full = solver.solve_at_throttle(request, aircraft.throttle_max());
  if (full && full->request.climb_angle_rad < request.climb_angle_rad) {
    const std::string throttle =
        beyond ? fmt::format("it takes throttle {:.3f} of at most {:g}, ",
                             beyond->controls.throttle, aircraft.throttle_max())
               : "";
    return fmt::format("{}full throttle gives a climb of {:.2f} deg", throttle,
                       deg_from_rad(full->request.climb_angle_rad));
  }
  const std::optional<Trim> idle = solver.solve_at_throttle(request, aircraft.throttle_min());
  if (idle && idle->request.climb_angle_rad > request.climb_angle_rad) {
    return fmt::format("even the least throttle, {:g}, gives a climb of {:.2f} deg",
                       aircraft.throttle_min(), deg_from_rad(idle->request.climb_angle_rad));
  }
  return kNoBalance;
}

}  // namespace

Result<Trim> find_trim(const Aircraft& aircraft, const TrimRequest& request) {
  TrimSolver solver(aircraft);
  if (std::optional<Trim> trim = solve_in_range(aircraft, solver, request)) return *trim;
  const Result<SpeedRange> range =
      find_speed_range(aircraft, request.climb_angle_rad, request.bank_rad);
  return Failure{fmt::format("no steady flight at {}: {}; {}", say_request(request),
                             say_reason(aircraft, solver, request),
                             range ? fmt::format("it can fly so from {:.2f} to {:.2f} m/s",
                                                 range->slowest_mps, range->fastest_mps)
                                   : "no speed is better")};
}

Result<Trim> find_trim_at_throttle(const Aircraft& aircraft, const TrimRequest& request,
                                   double throttle) {
  TrimSolver solver(aircraft);
  const std::optional<Trim> trim = solver.solve_at_throttle(request, throttle);
  if (!trim) {
    const std::string lift = say_lift(aircraft, solver, request);
    return Failure{fmt::format("no steady flight at {:.2f} m/s, throttle {:g}, bank {:.1f} deg: {}",
                               request.airspeed_mps, throttle, deg_from_rad(request.bank_rad),
                               lift.empty() ? kNoBalance : lift)};
  }
  const std::string elevons = say_elevons(aircraft, trim->controls);
  if (!elevons.empty()) {
    return Failure{fmt::format("no steady flight at {:.2f} m/s, throttle {:g}, bank {:.1f} deg: {}",
                               request.airspeed_mps, throttle, deg_from_rad(request.bank_rad),
                               elevons)};
  }
  return *trim;
}

Result<SpeedRange> find_speed_range(const Aircraft& aircraft, double climb_angle_rad,
                                    double bank_rad) {
  TrimSolver solver(aircraft);
  const auto flies = [&](double speed_mps) {
    return solve_in_range(aircraft, solver, {speed_mps, climb_angle_rad, bank_rad}).has_value();
  };
  // A speed with a trim, near the cruise speed; then outwards until no trim exists.
  const double cruise = aircraft.cruise_speed_mps;
  double inside = 0.0;
  for (double ratio = 1.0; ratio < kSearchSpan && inside == 0.0; ratio *= kSearchRatio) {
    if (flies(cruise * ratio))
      inside = cruise * ratio;
    else if (flies(cruise / ratio))
      inside = cruise / ratio;
  }
  if (inside == 0.0) {
    return Failure{
        fmt::format("no steady flight with climb {:.1f} deg, bank {:.1f} deg at any "
                    "speed from {:.1f} to {:.1f} m/s",
                    deg_from_rad(climb_angle_rad), deg_from_rad(bank_rad), cruise / kSearchSpan,
                    cruise * kSearchSpan)};
  }
  const auto edge = [&](double ratio) {
    double good = inside, bad = inside * ratio;
    while (flies(bad)) {
      good = bad;
      bad *= ratio;
      if (bad > kSearchSpan * cruise || bad < cruise / kSearchSpan) return good;
    }
    while (std::abs(bad - good) > kSpeedAccuracy_mps) {
      const double middle = 0.5 * (good + bad);
      (flies(middle) ? good : bad) = middle;
    }
    return good;
  };
  return SpeedRange{edge(1.0 / kSearchRatio), edge(kSearchRatio)};
}

}  // namespace vinerow::controllers

#include "controllers/planning/survey/survey_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/pose2.h"
#include "engine/io/geo/area_file.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

/// Airspeed at which the speed over ground along a lane is at most `ground_mps` in both directions.
std::optional<double> find_airspeed_mps(const SurveyRequest& request, double yaw_rad,
                                        double ground_mps) {
  const double along = std::abs(request.wind_W.dot(direction(yaw_rad)));
  const double aside = cross(direction(yaw_rad), request.wind_W);
  if (ground_mps <= along) return std::nullopt;
  const double airspeed_mps = std::hypot(ground_mps - along, aside);
  // At an airspeed below the wind's it would make no progress in the other direction.
  return std::sqrt(std::max(0.0, airspeed_mps * airspeed_mps - aside * aside)) > along
             ? std::optional(airspeed_mps)
             : std::nullopt;
}

/// "fly at most 5.9 m/s at 59.0 m, which is below the stall speed of 8.4 m/s"
std::string describe_slower(const SurveyRequest& request, double yaw_rad, double ground_mps) {
  const std::optional<double> airspeed_mps = find_airspeed_mps(request, yaw_rad, ground_mps);
  const bool has_wind = request.wind_W.norm() > 0.0;
  if (!airspeed_mps) {
    return fmt::format("at most {:.1f} m/s over ground at {:.0f} m, which this wind does not allow",
                       ground_mps, request.height_m);
  }
  std::string text = fmt::format("at most {:.1f} m/s{} at {:.0f} m", *airspeed_mps,
                                 has_wind ? " through this wind" : "", request.height_m);
  if (request.stall_speed_mps > *airspeed_mps) {
    text += fmt::format(" (below the stall speed of {:.1f} m/s)", request.stall_speed_mps);
  }
  return text;
}

}  // namespace

std::optional<double> calc_ground_speed_mps(double airspeed_mps, const Eigen::Vector2d& wind_W,
                                            const Eigen::Vector2d& along_W) {
  const double along = wind_W.dot(along_W), aside = cross(along_W, wind_W);
  if (std::abs(aside) >= airspeed_mps) return std::nullopt;
  const double speed_mps = along + std::sqrt(airspeed_mps * airspeed_mps - aside * aside);
  constexpr double kSlowest_mps = 0.1;
  return speed_mps > kSlowest_mps ? std::optional(speed_mps) : std::nullopt;
}

double calc_turn_radius_m(const SurveyRequest& request) {
  if (request.rotorcraft) return 0.0;
  const double fastest_mps = request.speed_mps + request.wind_W.norm();
  return std::max(request.min_radius_m,
                  fastest_mps * fastest_mps / (request.gravity_mps2 * std::tan(request.bank_rad)));
}

std::optional<std::string> find_survey_fault(const SurveyRequest& request, double lane_yaw_rad) {
  if (const auto fault = io::find_area_fault(request.polygon_W)) {
    return fmt::format("the polygon cannot be surveyed: {}", *fault);
  }
  if (request.speed_mps <= request.stall_speed_mps) {
    return fmt::format("speed_mps = {:.1f} m/s must be above the stall speed of {:.1f} m/s",
                       request.speed_mps, request.stall_speed_mps);
  }
  const Eigen::Vector2d along = direction(lane_yaw_rad);
  const auto up_mps = calc_ground_speed_mps(request.speed_mps, request.wind_W, along);
  const auto down_mps = calc_ground_speed_mps(request.speed_mps, request.wind_W, -along);
  if (!up_mps || !down_mps || request.wind_W.norm() >= request.speed_mps) {
    return fmt::format("speed_mps = {:g} m/s must be above the wind's {:g} m/s", request.speed_mps,
                       request.wind_W.norm());
  }
  const double ground_mps = std::max(*up_mps, *down_mps);
  const SurveyCamera& camera = request.camera;
  const double step_m =
      (1.0 - request.forward_overlap) * camera.footprint_length_m(request.height_m);
  const double needed_Hz = ground_mps / step_m;
  if (needed_Hz <= camera.max_rate_Hz * (1.0 + 1e-9)) return std::nullopt;
  const double needed_height_m =
      request.height_m * needed_Hz / camera.max_rate_Hz;  // the footprint grows with the height
  return fmt::format(
      "{:.0f} % forward overlap at {:.0f} m and {:.1f} m/s over ground{} needs a picture every "
      "{:.1f} m, but camera '{}' takes {:g} a second and reaches {:.1f} %: it needs {}, or a "
      "camera "
      "with {:.2f} Hz, or at least {:.0f} m for {:.1f} m/s (GSD {:.0f} mm)",
      100.0 * request.forward_overlap, request.height_m, ground_mps,
      request.wind_W.norm() > 0.0 ? " (wind from behind)" : "", step_m, camera.name,
      camera.max_rate_Hz,
      100.0 * camera.forward_overlap(request.height_m, ground_mps / camera.max_rate_Hz),
      describe_slower(request, lane_yaw_rad, step_m * camera.max_rate_Hz),
      std::ceil(100.0 * needed_Hz - 1e-6) / 100.0, std::ceil(needed_height_m - 1e-6),
      request.speed_mps, kMmPerM * camera.gsd_m(needed_height_m));
}

}  // namespace vinerow::controllers

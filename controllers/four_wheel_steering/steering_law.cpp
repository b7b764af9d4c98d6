#include "controllers/four_wheel_steering/steering_law.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {

// Kinematics of the corrected form: with tan dF = (sin g + a kappa) / cos g and
// tan dR = (sin g - b kappa) / cos g, the numbers of axle_roll.h are
//   k = (tan dF - tan dR) / (a + b) = kappa / cos g,
//   s = (b tan dF + a tan dR) / (a + b) = tan g.
// So g is the direction of travel seen from B, and kappa = k / sqrt(1 + s^2) the curvature of the
// track.
//
// Limits: |tan dF| <= tan(max) is |sin g + a kappa| <= tan(max) cos g. With
// sin g -+ tan(max) cos g = sin(g -+ max) / cos(max) its two sides are
//   -max - asin(a kappa cos(max)) <= g <= max - asin(a kappa cos(max)),
// and the same with -b for the rear axle. Both together are the range of g for a kappa.
//
// Largest curvature: both axles at opposite limits, k = 2 tan(max) / (a + b) and
// s = tan(max) (b - a) / (a + b), so
//   1 / kappa^2 = ((a + b) / (2 tan(max)))^2 + ((b - a) / 2)^2.

/// Range of gamma.
struct Range {
  double low, high;
};
Range calc_steer_range(const AxleGeometry& geometry, double max_axle_rad, double curvature_per_m) {
  const double shrink = std::cos(max_axle_rad);
  const auto turn = [&](double lever_m) {
    return std::asin(std::clamp(lever_m * curvature_per_m * shrink, -1.0, 1.0));
  };
  const double front = turn(geometry.front_m), rear = turn(-geometry.rear_m);
  return {std::max(-max_axle_rad - front, -max_axle_rad - rear),
          std::min(max_axle_rad - front, max_axle_rad - rear)};
}

/// Eq. 24-26 as printed, each angle clamped separately.
AxleAngles steer_as_printed(const AxleGeometry& geometry, const SteeringParams& params,
                            const SteeringInput& input) {
  const double gamma = -params.lateral_gain_radpm * input.lateral_error_m;
  const double kappa = -params.heading_gain_per_m * input.heading_error_rad;
  const double cosine = std::cos(gamma), sine = std::sin(gamma);
  const auto cut = [&](double angle_rad) {
    return std::clamp(angle_rad, -params.max_axle_rad, params.max_axle_rad);
  };
  return {cut(std::atan((geometry.front_m * kappa + sine) / cosine)),
          cut(std::atan((geometry.rear_m * kappa - sine) / cosine))};
}

}  // namespace

double calc_largest_curvature(const AxleGeometry& geometry, double max_axle_rad) {
  // Both axles at their limit; if a != b, the origin then travels at an angle.
  const double half_base = 0.5 * geometry.wheel_base_m() / std::tan(max_axle_rad);
  const double half_skew = 0.5 * (geometry.rear_m - geometry.front_m);
  return 1.0 / std::sqrt(half_base * half_base + half_skew * half_skew);
}

SteeringCommand steer(const AxleGeometry& geometry, const SteeringParams& params,
                      const SteeringInput& input) {
  SteeringCommand command;
  if (params.form == SteeringForm::kPrinted) {
    command.axles = steer_as_printed(geometry, params, input);
    return command;
  }
  // Curvature first: the heading determines the path in the end.
  const double largest = calc_largest_curvature(geometry, params.max_axle_rad);
  const double kappa =
      std::clamp(input.reference_per_m - params.heading_gain_per_m * input.heading_error_rad -
                     input.slip_curvature_per_m,
                 -largest, largest);
  const double wanted = -params.lateral_gain_radpm * input.lateral_error_m -
                        params.course_share * input.heading_error_rad - input.slip_rad;
  const Range range = calc_steer_range(geometry, params.max_axle_rad, kappa);
  // Gamma gets the remaining range. At the largest curvature it is one point, up to rounding.
  const double gamma = range.low < range.high ? std::clamp(wanted, range.low, range.high)
                                              : 0.5 * (range.low + range.high);
  const double cosine = std::cos(gamma), sine = std::sin(gamma);
  const auto cut = [&](double angle_rad) {
    return std::clamp(angle_rad, -params.max_axle_rad, params.max_axle_rad);
  };
  command.steer_rad = gamma;
  command.curvature_per_m = kappa;
  command.axles = {cut(std::atan((sine + geometry.front_m * kappa) / cosine)),
                   cut(std::atan((sine - geometry.rear_m * kappa) / cosine))};
  return command;
}

}  // namespace vinerow::controllers

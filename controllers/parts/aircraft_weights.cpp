#include "controllers/parts/aircraft_weights.h"

#include <fmt/format.h>

#include "controllers/parts/riccati.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

constexpr double kElevator_deg = 4.0, kAileron_deg = 4.0;
constexpr double kQ_degps = 60.0, kTheta_deg = 6.0;
constexpr double kP_degps = 90.0, kR_degps = 60.0, kPhi_deg = 12.0, kPsi_deg = 8.0;

AxisLaw make_law(const LinearAxis& axis, double period_s, const Eigen::VectorXd& states,
                 const Eigen::VectorXd& inputs, const std::string& who, const char* name) {
  AxisLaw law;
  law.model = discretise(axis, period_s);
  law.Q = states.cwiseAbs2().cwiseInverse().asDiagonal();
  law.R = inputs.cwiseAbs2().cwiseInverse().asDiagonal();
  const Result<Eigen::MatrixXd> P = solve_dare(law.model.A, law.model.B, law.Q, law.R);
  if (!P) {
    throw ConfigError(fmt::format("{}: no LQR gain for the {} axis: {}", who, name, P.reason()));
  }
  law.P = *P;
  law.K = -lqr_gain(law.model.A, law.model.B, law.R, law.P);
  return law;
}

}  // namespace

AircraftWeights::AircraftWeights()
    : elevator_rad(rad_from_deg(kElevator_deg)), aileron_rad(rad_from_deg(kAileron_deg)) {
  lon << 0.6, 1.0, rad_from_deg(kQ_degps), rad_from_deg(kTheta_deg), 2.0;
  lat << 1.5, rad_from_deg(kP_degps), rad_from_deg(kR_degps), rad_from_deg(kPhi_deg),
      rad_from_deg(kPsi_deg);
}

ParameterSpec aircraft_weight_parameter() {
  const AircraftWeights weights;
  return group_parameter(
      "weights",
      {
          positive_parameter("u_mps", "m/s", weights.lon(0), "forward speed"),
          positive_parameter("w_mps", "m/s", weights.lon(1), "speed across the wings"),
          positive_parameter("q_degps", "deg/s", kQ_degps, "pitch rate"),
          positive_parameter("theta_deg", "deg", kTheta_deg, "pitch"),
          positive_parameter("h_m", "m", weights.lon(4), "height"),
          positive_parameter("throttle", "", weights.throttle, "throttle"),
          positive_parameter("elevator_deg", "deg", kElevator_deg, "elevator"),
          positive_parameter("v_mps", "m/s", weights.lat(0), "side speed"),
          positive_parameter("p_degps", "deg/s", kP_degps, "roll rate"),
          positive_parameter("r_degps", "deg/s", kR_degps, "yaw rate"),
          positive_parameter("phi_deg", "deg", kPhi_deg, "roll"),
          positive_parameter("psi_deg", "deg", kPsi_deg, "heading"),
          positive_parameter("aileron_deg", "deg", kAileron_deg, "aileron"),
      },
      "deviations that cost as much as each other: Q = diag(1 / x^2), R = diag(1 / u^2)");
}

AircraftWeights read_aircraft_weights(const ParameterSet& parameters) {
  if (!parameters.has("weights")) return {};
  const ParameterSet& group = parameters.group("weights");
  const auto angle = [&](const char* name) { return rad_from_deg(group.number(name)); };
  AircraftWeights weights;
  weights.lon << group.number("u_mps"), group.number("w_mps"), angle("q_degps"), angle("theta_deg"),
      group.number("h_m");
  weights.lat << group.number("v_mps"), angle("p_degps"), angle("r_degps"), angle("phi_deg"),
      angle("psi_deg");
  weights.throttle = group.number("throttle");
  weights.elevator_rad = angle("elevator_deg");
  weights.aileron_rad = angle("aileron_deg");
  return weights;
}

AircraftLaws make_aircraft_laws(const Aircraft& aircraft, const Trim& trim, double period_s,
                                const AircraftWeights& weights, const std::string& who) {
  const AircraftLinear linear = linearise(aircraft, trim);
  const Eigen::Vector2d lon_inputs(weights.throttle, weights.elevator_rad);
  const Eigen::VectorXd lat_inputs = Eigen::VectorXd::Constant(1, weights.aileron_rad);
  return {make_law(linear.longitudinal, period_s, weights.lon, lon_inputs, who, "longitudinal"),
          make_law(linear.lateral, period_s, weights.lat, lat_inputs, who, "lateral")};
}

}  // namespace vinerow

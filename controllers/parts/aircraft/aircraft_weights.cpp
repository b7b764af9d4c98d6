#include "controllers/parts/aircraft/aircraft_weights.h"

#include <fmt/format.h>

#include "controllers/parts/solvers/riccati.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

constexpr AircraftRangesInDeg kDefault = {0.6, 1.0,  60.0, 6.0,  2.0, 0.1, 4.0,
                                          1.5, 90.0, 60.0, 12.0, 8.0, 4.0};

AxisLaw make_law(const LinearAxis& axis, double period_s, const Eigen::VectorXd& states,
                 const Eigen::VectorXd& inputs, const std::string& who, const char* name) {
  AxisLaw law;
  law.model = discretise(axis, period_s);
  law.Q = states.cwiseAbs2().cwiseInverse().asDiagonal();
  law.R = inputs.cwiseAbs2().cwiseInverse().asDiagonal();
  const Result<Eigen::MatrixXd> P = solve_dare(law.model.A, law.model.B, law.Q, law.R);
  if (!P) {
    throw ConfigError(
        fmt::format("{}: 'weights' give no LQR gain for the {} axis: {}", who, name, P.reason()));
  }
  law.P = *P;
  law.K = -lqr_gain(law.model.A, law.model.B, law.R, law.P);
  return law;
}

}  // namespace

AircraftWeights::AircraftWeights() : AircraftRanges(kDefault.to_si()) {}

const ParameterTable<AircraftWeights>& aircraft_weight_table() {
  using W = AircraftWeights;
  static const ParameterTable<W> table = ParameterTable<W>().group(
      "weights", [](W& weights) -> AircraftRanges& { return weights; }, aircraft_range_table(),
      "deviations of equal cost: Q = diag(1 / x^2), R = diag(1 / u^2)");
  return table;
}

AircraftLaws make_aircraft_laws(const Aircraft& aircraft, const Trim& trim, double period_s,
                                const AircraftWeights& weights, const std::string& who) {
  const AircraftLinear linear = linearise(aircraft, trim);
  const Eigen::Vector2d lon_inputs(weights.throttle, weights.elevator_rad);
  const Eigen::VectorXd lat_inputs = Eigen::VectorXd::Constant(1, weights.aileron_rad);
  return {make_law(linear.longitudinal, period_s, weights.lon, lon_inputs, who, "longitudinal"),
          make_law(linear.lateral, period_s, weights.lat, lat_inputs, who, "lateral")};
}

}  // namespace vinerow::controllers

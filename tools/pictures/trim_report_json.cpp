#include <nlohmann/json.hpp>

#include "controllers/parts/solvers/riccati.h"
#include "tools/pictures/trim_report.h"

namespace vinerow::tools {
namespace {

using nlohmann::ordered_json;

ordered_json rows(const Eigen::MatrixXd& matrix) {
  ordered_json all = ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    all.push_back(row);
  }
  return all;
}

ordered_json axis(const std::vector<NamedMode>& modes, const controllers::AxisLaw& law) {
  ordered_json json;
  json["modes"] = ordered_json::array();
  for (const NamedMode& named : modes) {
    json["modes"].push_back({{"name", named.name},
                             {"real_per_s", named.mode.root.real()},
                             {"imaginary_radps", named.mode.root.imag()},
                             {"frequency_radps", named.mode.frequency_radps},
                             {"damping", named.mode.damping}});
  }
  json["A"] = rows(law.model.A);
  json["B"] = rows(law.model.B);
  json["E"] = rows(law.model.E);
  json["K_lqr"] = rows(law.K);
  json["spectral_radius_lqr"] = controllers::spectral_radius(law.model.A + law.model.B * law.K);
  return json;
}

}  // namespace

std::string to_json(const TrimReport& report) {
  const controllers::Trim& t = report.trim;
  ordered_json json;
  json["vehicle"] = {{"type", report.aircraft.type},
                     {"mass_kg", report.aircraft.flight_model->mass_kg()},
                     {"wing_span_m", report.aircraft.span_m},
                     {"air_density_kgm3", report.aircraft.air_density_kgm3},
                     {"gravity_mps2", report.aircraft.gravity_mps2}};
  json["request"] = {{"airspeed_mps", t.request.airspeed_mps},
                     {"climb_angle_rad", t.request.climb_angle_rad},
                     {"bank_rad", t.request.bank_rad}};
  json["trim"] = {{"throttle", t.controls.throttle},
                  {"elevator_rad", t.controls.elevator_rad},
                  {"aileron_rad", t.controls.aileron_rad},
                  {"alpha_rad", t.alpha_rad},
                  {"beta_rad", t.beta_rad},
                  {"roll_rad", t.roll_rad},
                  {"pitch_rad", t.pitch_rad},
                  {"u_mps", t.u_mps},
                  {"v_mps", t.v_mps},
                  {"w_mps", t.w_mps},
                  {"p_radps", t.p_radps},
                  {"q_radps", t.q_radps},
                  {"r_radps", t.r_radps},
                  {"turn_rate_radps", t.turn_rate_radps},
                  {"load_factor", t.load_factor},
                  {"residual", t.residual},
                  {"iterations", t.iterations}};
  const auto number_or_null = [](const std::optional<double>& value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
  };
  json["envelope"] = {{"level_slowest_mps", report.level.slowest_mps},
                      {"level_fastest_mps", report.level.fastest_mps},
                      {"climb_min_rad", number_or_null(report.climb_min_rad)},
                      {"climb_max_rad", number_or_null(report.climb_max_rad)},
                      {"level_bank_max_rad", report.bank_max_rad}};
  json["period_s"] = report.period_s;
  json["longitudinal"] = axis(report.lon_modes, report.laws.lon);
  json["lateral"] = axis(report.lat_modes, report.laws.lat);
  return json.dump(2);
}

}  // namespace vinerow::tools

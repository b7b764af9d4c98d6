#include "tools/pictures/trim_report.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::tools {
namespace {

constexpr double kIntegrator_radps = 1e-6;
constexpr double kBankAccuracy_rad = rad_from_deg(0.01);
constexpr double kSteepestBank_rad = rad_from_deg(85.0);

bool oscillates(const controllers::FlightMode& mode) {
  return mode.root.imag() > 0.0;
}

std::vector<controllers::FlightMode> without_integrators(const controllers::LinearAxis& axis) {
  std::vector<controllers::FlightMode> modes = controllers::calc_modes(axis);
  std::erase_if(modes, [](const controllers::FlightMode& mode) {
    return mode.frequency_radps < kIntegrator_radps;
  });
  return modes;
}

/// Longitudinal modes: of two oscillations the slow one is the phugoid, the fast one the short
/// period.
std::vector<NamedMode> name_lon(const controllers::LinearAxis& axis) {
  std::vector<NamedMode> named;
  const std::vector<controllers::FlightMode> modes = without_integrators(axis);
  const bool usual = modes.size() == 2 && oscillates(modes[0]) && oscillates(modes[1]);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    named.push_back({!usual ? "mode" : i == 0 ? "phugoid" : "short period", modes[i]});
  }
  return named;
}

/// Lateral modes: the oscillation is the dutch roll, the slow real root the spiral, the fast one
/// the roll.
std::vector<NamedMode> name_lat(const controllers::LinearAxis& axis) {
  std::vector<NamedMode> named;
  const std::vector<controllers::FlightMode> modes = without_integrators(axis);
  int real = 0;
  for (const controllers::FlightMode& mode : modes) {
    named.push_back({oscillates(mode) ? "dutch roll" : real++ == 0 ? "spiral" : "roll", mode});
  }
  if (modes.size() != 3 || real != 2) {
    for (NamedMode& mode : named) mode.name = "mode";
  }
  return named;
}

double find_steepest_bank(const controllers::Aircraft& aircraft, double airspeed_mps) {
  double good = 0.0, bad = kSteepestBank_rad;
  const auto flies = [&](double bank_rad) {
    return controllers::find_trim(aircraft, {airspeed_mps, 0.0, bank_rad}).ok();
  };
  if (flies(bad)) return bad;
  while (bad - good > kBankAccuracy_rad) {
    const double middle = 0.5 * (good + bad);
    (flies(middle) ? good : bad) = middle;
  }
  return good;
}

std::string matrix_text(const char* name, const Eigen::MatrixXd& matrix) {
  std::string text;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    text += fmt::format("  {:<3}", i == 0 ? name : "");
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) text += fmt::format(" {:>9.5f}", matrix(i, j));
    text += "\n";
  }
  return text;
}

std::string mode_text(const NamedMode& named) {
  const controllers::FlightMode& mode = named.mode;
  if (!oscillates(mode)) {
    return fmt::format("  {:<14} {:.4f} /s, {} by e in {:.3g} s\n", named.name, mode.root.real(),
                       mode.root.real() > 0.0 ? "grows" : "falls",
                       1.0 / std::abs(mode.root.real()));
  }
  return fmt::format("  {:<14} {:.4g} rad/s, damping {:.3f}\n", named.name, mode.frequency_radps,
                     mode.damping);
}

}  // namespace

TrimReport make_trim_report(const controllers::Aircraft& aircraft,
                            const controllers::TrimRequest& request, double period_s,
                            const std::string& who) {
  const Result<controllers::Trim> trim = controllers::find_trim(aircraft, request);
  if (!trim) throw ConfigError(fmt::format("{}: {}", who, trim.reason()));
  TrimReport report;
  report.aircraft = aircraft;
  report.trim = *trim;
  report.period_s = period_s;
  const controllers::AircraftLinear linear = controllers::linearise(aircraft, *trim);
  report.lon_modes = name_lon(linear.longitudinal);
  report.lat_modes = name_lat(linear.lateral);
  report.laws = controllers::make_aircraft_laws(aircraft, *trim, period_s, {}, who);
  if (const Result<controllers::SpeedRange> level =
          controllers::find_speed_range(aircraft, 0.0, 0.0))
    report.level = *level;
  const controllers::TrimRequest straight{request.airspeed_mps, 0.0, 0.0};
  const auto climb_at = [&](double throttle) -> std::optional<double> {
    const Result<controllers::Trim> found =
        controllers::find_trim_at_throttle(aircraft, straight, throttle);
    if (!found) return std::nullopt;
    return found->request.climb_angle_rad;
  };
  report.climb_max_rad = climb_at(aircraft.throttle_max());
  report.climb_min_rad = climb_at(aircraft.throttle_min());
  report.bank_max_rad = find_steepest_bank(aircraft, request.airspeed_mps);
  return report;
}

std::string to_text(const TrimReport& report) {
  const controllers::Trim& t = report.trim;
  // Avoid "-0.000" from rounding.
  const auto deg = [](double angle_rad) {
    return std::round(deg_from_rad(angle_rad) * 1e6) * 1e-6 + 0.0;
  };
  std::string text;
  const auto line = [&](const char* key, const std::string& value) {
    text += fmt::format("{:<16} {}\n", key, value);
  };
  line("vehicle", fmt::format("{}, {:g} kg, span {:g} m", report.aircraft.type,
                              report.aircraft.flight_model->mass_kg(), report.aircraft.span_m));
  line("flight", fmt::format("{:.2f} m/s, climb {:.2f} deg, bank {:.2f} deg, air {:.4f} kg/m3",
                             t.request.airspeed_mps, deg(t.request.climb_angle_rad),
                             deg(t.request.bank_rad), report.aircraft.air_density_kgm3));
  line("incidence",
       fmt::format("{:.3f} deg, side slip {:.3f} deg", deg(t.alpha_rad), deg(t.beta_rad)));
  line("attitude",
       fmt::format("pitch {:.3f} deg, roll {:.3f} deg", deg(t.pitch_rad), deg(t.roll_rad)));
  line("controls",
       fmt::format("throttle {:.4f}, elevator {:.3f} deg, aileron {:.3f} deg", t.controls.throttle,
                   deg(t.controls.elevator_rad), deg(t.controls.aileron_rad)));
  line("turn",
       fmt::format("{:.3f} deg/s, load factor {:.4f}", deg(t.turn_rate_radps), t.load_factor));
  line("residual", fmt::format("{:.1e} after {} iterations", t.residual, t.iterations));
  line("level flight", fmt::format("{:.2f} m/s (stall) to {:.2f} m/s (full throttle)",
                                   report.level.slowest_mps, report.level.fastest_mps));
  const auto climb = [&](const std::optional<double>& angle_rad) {
    return angle_rad ? fmt::format("{:.2f} deg", deg(*angle_rad)) : std::string("none");
  };
  line("climb", fmt::format("{} at zero throttle to {} at full throttle",
                            climb(report.climb_min_rad), climb(report.climb_max_rad)));
  const double V = t.request.airspeed_mps;
  line("level turn",
       fmt::format("bank at most {:.2f} deg, radius {:.2f} m", deg(report.bank_max_rad),
                   V * V / (report.aircraft.gravity_mps2 * std::tan(report.bank_max_rad))));
  const auto axis = [&](const char* title, const std::vector<NamedMode>& modes,
                        const controllers::AxisLaw& law) {
    text += fmt::format("\n{}\n", title);
    for (const NamedMode& mode : modes) text += mode_text(mode);
    text += matrix_text("A", law.model.A) + matrix_text("B", law.model.B) +
            matrix_text("E", law.model.E) + matrix_text("K", law.K);
  };
  axis(fmt::format("longitudinal, x = [u w q theta h], u = [throttle elevator], d = [u_g w_g], "
                   "sampled at {:g} s; LQR u = K x",
                   report.period_s)
           .c_str(),
       report.lon_modes, report.laws.lon);
  axis("lateral, x = [v p r phi psi], u = [aileron], d = [v_g]", report.lat_modes, report.laws.lat);
  return text;
}

}  // namespace vinerow::tools

#include "vehicles/payloads/sprayer_params.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {
namespace {

/// What files state: the sprayer, and what some of its numbers follow from.
struct SprayerSettings {
  SprayerParams sprayer;
  double hollow_share = 0.5;
  double rated_flow_lps = 0.2 / 60.0;
  double rated_pressure_bar = 3.0;
  double pressure_bar = 4.0;
  std::optional<double> lead_s;
};

constexpr ParameterConversion kPerMinute = {[](double per_minute) { return per_minute / 60.0; },
                                            [](double per_second) { return per_second * 60.0; }};

std::string find_fault_in_nozzles(const SprayerSettings& s) {
  const std::size_t nozzles = s.sprayer.nozzle_heights_m.size();
  const std::size_t elevations = s.sprayer.nozzle_elevation_rad.size();
  if (nozzles == 0) return "nozzle_heights_m = [], must name at least one nozzle";
  if (elevations == 1 || elevations == nozzles) return "";
  return fmt::format(
      "nozzle_elevation_deg has {} entries, must have 1 or as many as nozzle_heights_m ({})",
      elevations, nozzles);
}

std::string find_fault_in_reach(const SprayerSettings& s) {
  if (s.sprayer.row_reach_m > s.sprayer.nozzle_offset_m) return "";
  return fmt::format(
      "row_reach_m = {:g} m, must be > nozzle_offset_m = {:g} m: no row would be in reach",
      s.sprayer.row_reach_m, s.sprayer.nozzle_offset_m);
}

// Sources: docs/models/payloads.md.
const ParameterTable<SprayerSettings>& sprayer_table() {
  using S = SprayerSettings;
  using P = SprayerParams;
  const auto of = [](auto member) { return inside(&S::sprayer, member); };
  const auto jet = [](auto member) { return inside(&S::sprayer, &P::spray, member); };
  static const ParameterTable<S> table =
      ParameterTable<S>()
          .numbers("nozzle_heights_m", "m", of(&P::nozzle_heights_m), between(0.05, 5.0),
                   "heights of the nozzles of a side above level ground")
          .numbers("nozzle_elevation_deg", "deg", of(&P::nozzle_elevation_rad),
                   between(-80.0, 80.0),
                   "elevation of the nozzles' axes, one for all or one each; positive upward", 0,
                   kDegrees)
          .number("boom_x_m", "m", of(&P::boom_x_m), between(-10.0, 10.0),
                  "distance of the nozzles ahead of the body's origin")
          .number("nozzle_offset_m", "m", of(&P::nozzle_offset_m), between(0.0, 5.0),
                  "distance of the nozzles from the body's x axis, to both sides")
          .degrees("spray_half_angle_deg", of(&P::spray_half_angle_rad), between(0.0, 80.0),
                   "half angle of a nozzle's cone in the air stream")
          .number("hollow_share", "", &S::hollow_share, between(0.0, 1.0),
                  "half angle of the empty inner cone, as a fraction of the outer one")
          .number("nozzle_flow_lpm", "l/min", &S::rated_flow_lps, kPositive,
                  "flow of a nozzle at its rated pressure; 0.2 l/min at 3 bar is size 005",
                  kPerMinute)
          .number("rated_pressure_bar", "bar", &S::rated_pressure_bar, kPositive,
                  "pressure of that flow (ISO 10625: 3)")
          .number("pressure_bar", "bar", &S::pressure_bar, kPositive,
                  "working pressure; flow goes with its square root")
          .number("tank_l", "l", of(&P::tank_l), kPositive, "liquid at the start")
          .number("jet_speed_mps", "m/s", jet(&SprayParams::jet_speed_mps), kPositive,
                  "speed of the air at the outlet")
          .number("jet_decay_m", "m", jet(&SprayParams::jet_decay_m), kPositive,
                  "distance after which the jet has half of its speed")
          .number("reach_m", "m", jet(&SprayParams::reach_m), between(0.5, 20.0),
                  "range of the jet, beyond which droplets are lost")
          .number("settling_mps", "m/s", jet(&SprayParams::settling_mps), between(0.0, 5.0),
                  "speed at which the droplets fall")
          .number("loss_length_m", "m", jet(&SprayParams::loss_length_m), kPositive,
                  "distance after which 1/e of the liquid is left in the jet")
          .number("leaf_area_density_m2pm3", "m2/m3", of(&P::leaf_area_density_m2pm3), kPositive,
                  "leaf area (one side) in a cubic metre of canopy; default: that of the world's "
                  "plants, and 6 where the world does not know it")
          .number("leaf_projection", "", jet(&SprayParams::leaf_projection), between(0.05, 1.0),
                  "mean projection of a leaf's area across the jet")
          .choice("switching", of(&P::on_legs_only), {{"rows", false}, {"legs", true}},
                  "sections open beside a row of the map; legs: on the plan's legs only")
          .number("row_reach_m", "m", of(&P::row_reach_m), kPositive,
                  "rows nearer to the boom's middle than this are sprayed")
          .degrees("max_angle_deg", of(&P::max_angle_rad), between(1.0, 89.0),
                   "largest angle between heading and row at which sections open")
          .formerly("most_angle_deg")
          .number("beyond_end_m", "m", of(&P::beyond_end_m), between(-10.0, 10.0),
                  "sections stay open this far beyond a row's end; negative: close before")
          .number("min_speed_mps", "m/s", of(&P::min_speed_mps), between(0.0, 10.0),
                  "speed below which all sections are closed")
          .number("valve_lag_s", "s", of(&P::valve_lag_s), between(0.0, 10.0),
                  "time from the command until a section opens or closes")
          .number("lead_s", "s", &S::lead_s, between(0.0, 10.0),
                  "sections are commanded this much ahead; default: valve_lag_s")
          .integer("rays_per_nozzle", of(&P::rays_per_nozzle), between(1, 100),
                   "portions of liquid per nozzle and tick")
          .number("patch_step_m", "m", of(&P::step_m), between(0.02, 10.0),
                  "size of a patch along the row")
          .number("patch_band_m", "m", of(&P::band_m), between(0.02, 10.0),
                  "size of a patch in height")
          .number("wanted_ml_per_m2", "ml/m2", of(&P::wanted_ml_per_m2), kPositive,
                  "deposit from which on canopy surface counts as covered")
          .rule(find_fault_in_nozzles)
          .rule(find_fault_in_reach);
  return table;
}

}  // namespace

void add_sprayer_parameters(PartSpec& spec) {
  sprayer_table().add_to(spec);
}

SprayerParams read_sprayer(const ParameterSet& parameters, const std::string& who) {
  const SprayerSettings s = sprayer_table().read(parameters, who);
  SprayerParams p = s.sprayer;
  if (p.nozzle_elevation_rad.size() == 1) {
    p.nozzle_elevation_rad.assign(p.nozzle_heights_m.size(), s.sprayer.nozzle_elevation_rad[0]);
  }
  p.hollow_half_angle_rad = s.hollow_share * p.spray_half_angle_rad;
  // Turbulent flow through an orifice.
  p.nozzle_flow_lps = s.rated_flow_lps * std::sqrt(s.pressure_bar / s.rated_pressure_bar);
  p.lead_s = s.lead_s.value_or(p.valve_lag_s);
  return p;
}

}  // namespace vinerow::vehicles

#include "vehicles/payloads/sprayer_params.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::vehicles {
namespace {

ParameterSpec within(ParameterSpec spec, double min, double max) {
  spec.min = min;
  spec.max = max;
  return spec;
}

}  // namespace

std::vector<ParameterSpec> sprayer_parameters() {
  // Sources: docs/payloads.md.
  return {
      within(number_list_parameter("nozzle_heights_m", "m", {0.85, 1.1, 1.4, 1.65},
                                   "heights of the nozzles of a side above level ground"),
             0.05, 5.0),
      within(number_list_parameter("nozzle_elevation_deg", "deg", {0.0},
                                   "elevation of the nozzles' axes, one for all or one each; "
                                   "positive upward"),
             -80.0, 80.0),
      number_parameter("boom_x_m", "m", -0.6, -10.0, 10.0,
                       "place of the nozzles ahead of the body's origin"),
      number_parameter("nozzle_offset_m", "m", 0.3, 0.0, 5.0,
                       "place of the nozzles beside the body's x axis, to both sides"),
      number_parameter("spray_half_angle_deg", "deg", 25.0, 0.0, 80.0,
                       "half angle of a nozzle's cone in the air stream"),
      number_parameter("hollow_share", "", 0.5, 0.0, 1.0,
                       "half angle of the empty inner cone, as a share of the outer one"),
      positive_parameter("nozzle_flow_lpm", "l/min", 0.2,
                         "flow of a nozzle at its rated pressure; 0.2 l/min at 3 bar is size 005"),
      positive_parameter("rated_pressure_bar", "bar", 3.0, "pressure of that flow (ISO 10625: 3)"),
      positive_parameter("pressure_bar", "bar", 4.0,
                         "working pressure; flow goes with its square root"),
      positive_parameter("tank_l", "l", 60.0, "liquid at the start"),
      positive_parameter("jet_speed_mps", "m/s", 25.0, "speed of the air at the outlet"),
      positive_parameter("jet_decay_m", "m", 0.6, "way after which the jet has half of its speed"),
      number_parameter("reach_m", "m", 4.0, 0.5, 20.0, "way of the jet, then droplets are lost"),
      number_parameter("settling_mps", "m/s", 0.3, 0.0, 5.0, "speed at which the droplets fall"),
      positive_parameter("loss_length_m", "m", 15.0,
                         "way after which 1/e of the liquid is left in the jet"),
      positive_parameter("leaf_area_density_m2pm3", "m2/m3", 6.0,
                         "leaf area (one side) in a cubic metre of canopy"),
      number_parameter("leaf_projection", "", 0.5, 0.05, 1.0,
                       "mean projection of a leaf's area across the jet"),
      choice_parameter("switching", "rows", {"rows", "legs"},
                       "sections open beside a row of the map; legs: on the plan's legs only"),
      positive_parameter("row_reach_m", "m", 2.0,
                         "rows nearer to the boom's middle than this are sprayed"),
      number_parameter("most_angle_deg", "deg", 20.0, 1.0, 89.0,
                       "largest angle between heading and row, above it the vehicle turns"),
      number_parameter("beyond_end_m", "m", 0.0, -10.0, 10.0,
                       "sections stay open this far beyond a row's end; negative: close before"),
      number_parameter("min_speed_mps", "m/s", 0.2, 0.0, 10.0,
                       "slower than this all sections are closed"),
      number_parameter("valve_lag_s", "s", 0.2, 0.0, 10.0,
                       "time from the command until a section opens or closes"),
      optional(number_parameter("lead_s", "s", 0.2, 0.0, 10.0,
                                "sections are commanded this much ahead; default: valve_lag_s")),
      integer_parameter("rays_per_nozzle", 2, 1, 100, "portions of liquid of a nozzle and tick"),
      number_parameter("patch_step_m", "m", 0.25, 0.02, 10.0, "size of a patch along the row"),
      number_parameter("patch_band_m", "m", 0.25, 0.02, 10.0, "size of a patch in height"),
      positive_parameter("wanted_ml_per_m2", "ml/m2", 3.0,
                         "deposit on the canopy's surface from which on it counts as covered"),
  };
}

SprayerParams read_sprayer(const ParameterSet& parameters, const std::string& who) {
  SprayerParams p;
  p.nozzle_heights_m = parameters.numbers("nozzle_heights_m");
  if (p.nozzle_heights_m.empty()) {
    throw ConfigError(fmt::format("{}: nozzle_heights_m = [], must name at least one nozzle", who));
  }
  std::vector<double> elevations = parameters.numbers("nozzle_elevation_deg");
  if (elevations.size() == 1) elevations.assign(p.nozzle_heights_m.size(), elevations[0]);
  if (elevations.size() != p.nozzle_heights_m.size()) {
    throw ConfigError(fmt::format(
        "{}: nozzle_elevation_deg has {} entries, must have 1 or as many as nozzle_heights_m ({})",
        who, elevations.size(), p.nozzle_heights_m.size()));
  }
  for (const double elevation_deg : elevations) {
    p.nozzle_elevation_rad.push_back(rad_from_deg(elevation_deg));
  }
  p.boom_x_m = parameters.number("boom_x_m");
  p.nozzle_offset_m = parameters.number("nozzle_offset_m");
  p.spray_half_angle_rad = rad_from_deg(parameters.number("spray_half_angle_deg"));
  p.hollow_half_angle_rad = parameters.number("hollow_share") * p.spray_half_angle_rad;
  // Turbulent flow through an orifice.
  p.nozzle_flow_lps =
      parameters.number("nozzle_flow_lpm") / 60.0 *
      std::sqrt(parameters.number("pressure_bar") / parameters.number("rated_pressure_bar"));
  p.tank_l = parameters.number("tank_l");
  p.spray.jet_speed_mps = parameters.number("jet_speed_mps");
  p.spray.jet_decay_m = parameters.number("jet_decay_m");
  p.spray.reach_m = parameters.number("reach_m");
  p.spray.settling_mps = parameters.number("settling_mps");
  p.spray.loss_length_m = parameters.number("loss_length_m");
  p.spray.extinction_per_m =
      parameters.number("leaf_area_density_m2pm3") * parameters.number("leaf_projection");

  p.on_legs_only = parameters.text("switching") == "legs";
  p.row_reach_m = parameters.number("row_reach_m");
  p.most_angle_rad = rad_from_deg(parameters.number("most_angle_deg"));
  p.beyond_end_m = parameters.number("beyond_end_m");
  p.min_speed_mps = parameters.number("min_speed_mps");
  p.valve_lag_s = parameters.number("valve_lag_s");
  p.lead_s = parameters.has("lead_s") ? parameters.number("lead_s") : p.valve_lag_s;
  if (p.row_reach_m <= p.nozzle_offset_m) {
    throw ConfigError(fmt::format(
        "{}: row_reach_m = {:g} m, must be > nozzle_offset_m = {:g} m: no row would be in reach",
        who, p.row_reach_m, p.nozzle_offset_m));
  }

  p.rays_per_nozzle = static_cast<int>(parameters.integer("rays_per_nozzle"));
  p.step_m = parameters.number("patch_step_m");
  p.band_m = parameters.number("patch_band_m");
  p.wanted_ml_per_m2 = parameters.number("wanted_ml_per_m2");
  return p;
}

}  // namespace vinerow::vehicles

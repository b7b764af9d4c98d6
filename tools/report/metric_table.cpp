#include "tools/report/metric_table.h"

#include <algorithm>
#include <iterator>

#include "tools/report/units.h"

namespace vinerow::tools::report {
namespace {

struct Entry {
  const char* name;  ///< "*" stands for a wheel, source or observer
  const char* title;
  const char* definition;
  const char* source;
};

constexpr const char* kPaperC3 = "paper C, table 3";
constexpr const char* kSurvey = "paper A, §2";
constexpr const char* kRows = "paper A, §4.2";
constexpr const char* kAir = "paper A, §2, fig. 9-11";
constexpr const char* kNees = "Bar-Shalom, Li, Kirubarajan 2001, §5.4";

/// The first that fits is taken.
constexpr Entry kMetrics[] = {
    // Distance from the plan.
    {"average_deviation_m", "mean distance from the plan",
     "ATD: mean distance from the planned polyline over the whole mission", "paper B, §3"},
    {"oscillation_count", "swings about the plan",
     "OF: local maxima of the distance from the plan, prominence at least 1e-6 m, ends excluded",
     "paper B, §3"},
    {"relative_accuracy_per_m", "relative accuracy", "RA = 1 / (ATD · OF)", "paper B, eq. 8"},
    {"deviation_max_m", "largest distance from the plan",
     "Largest distance from the planned polyline, turns included; of a flight in space, else in "
     "the plane",
     ""},
    {"cross_track_rms_m", "typical distance from the row's middle line",
     "Root mean square of the distance from the planned leg between the plants", ""},
    {"cross_track_max_m", "largest distance from the row's middle line",
     "Largest distance from the planned leg between the plants", ""},
    {"heading_error_rms_rad", "typical heading error in the rows",
     "Root mean square of the true heading minus the leg's", ""},
    {"leg_samples", "samples in the rows", "Ticks in which the vehicle was on a leg", ""},
    {"turn_deviation_rms_m", "typical distance from the plan in turns",
     "Root mean square of the distance from the plan's arcs in the turns", ""},
    {"turn_deviation_max_m", "largest distance from the plan in turns",
     "Largest distance from the plan's arcs in the turns", ""},
    {"planned_length_m", "length of the plan", "Length of the planned curve", ""},
    {"alleys_driven", "alleys worked",
     "Alleys driven from end to end: a true pose in each tenth of the planned leg", ""},
    // Clearance and contact.
    {"min_clearance_m", "closest to plants, posts and wires",
     "Least true distance from the vehicle's box to canopy, posts, trunks and wires (looked for "
     "within 3 m)",
     ""},
    {"contact_count", "contacts",
     "Contacts with canopy, posts, trunks, wires, obstacles and vehicles; less than 0.5 s apart "
     "count as one",
     ""},
    {"canopy_contact_count", "contacts with leaves", "Contacts with canopy alone", ""},
    // Place between the true rows.
    {"alley_offset_mean_m", "mean distance to the left of the alley's middle",
     "Mean of the signed distance from the middle between the true walls of the alley, positive to "
     "the left of its own direction: shows a map that lies beside the vineyard",
     ""},
    {"alley_offset_rms_m", "typical distance from the alley's middle",
     "Root mean square of the distance from the middle between the true walls of the alley", ""},
    {"alley_offset_max_m", "largest distance from the alley's middle",
     "Largest distance from the middle between the true walls of the alley", ""},
    {"alley_height_min_m", "least height between the rows",
     "Least height above the true ground between the true rows", ""},
    {"alley_height_max_m", "largest height between the rows",
     "Largest height above the true ground between the true rows", ""},
    {"alleys_passed", "alleys passed", "True alleys passed from end to end", ""},
    // Wheels.
    {"slip_rms", "typical wheel slip",
     "Root mean square over all wheels of the slip along their rolling direction, (Rω - v) / "
     "max(|Rω|, |v|); without wheels that stand or carry no load",
     "paper A, §4.1"},
    {"slip_max", "largest wheel slip", "Largest such slip of any wheel", "paper A, §4.1"},
    {"slip_rms_turn", "typical wheel slip in turns", "The same as slip_rms, in turns between rows",
     "paper A, §4.1"},
    {"slip_max_turn", "largest wheel slip in turns", "Largest slip in turns between rows",
     "paper A, §4.1"},
    {"slip_angle_rms_rad", "typical side slip",
     "Root mean square of the angle between a wheel's direction and its motion, over all wheels",
     ""},
    {"slip_rms_*", "typical slip of one wheel", "The same as slip_rms, of the wheel in the name",
     "paper A, §4.1"},
    {"slip_max_*", "largest slip of one wheel", "Largest slip of the wheel in the name",
     "paper A, §4.1"},
    // Travel and energy.
    {"standing_drift_m", "drift while standing",
     "Largest distance from where a stand began (slower than 5 mm/s for 2 s)", ""},
    {"distance_m", "distance travelled", "Length of the true track", ""},
    {"displacement_m", "start to end", "Straight distance from the start to the end", ""},
    {"time_s", "time", "Simulated time of the run", ""},
    {"mean_speed_mps", "mean speed", "Distance over time", ""},
    {"max_speed_mps", "top speed", "Largest true speed", ""},
    {"energy_J", "energy used", "Electric energy drawn from the battery", ""},
    {"mean_power_W", "mean power", "Energy over time", ""},
    {"battery_hours", "endurance", "Capacity of the battery over the mean power", ""},
    {"finished", "mission completed", "1 when the controller has said that nothing is left to do",
     ""},
    // Flight between the rows.
    {"altitude_error_rms_m", "typical height error in the rows",
     "Root mean square of the true height minus planned height at the nearest place, on the legs",
     kRows},
    {"altitude_error_max_m", "largest height error in the rows",
     "Largest true height minus planned height at the nearest place, on the legs", kRows},
    {"height_above_ground_min_m", "lowest height in the rows",
     "Least height above the true ground, on the legs", kRows},
    {"height_above_ground_max_m", "greatest height in the rows",
     "Largest height above the true ground, on the legs", kRows},
    {"row_speed_mean_mps", "mean speed in the rows", "Mean true speed on the legs", kRows},
    {"row_speed_error_max_mps", "largest speed error in the rows",
     "Largest difference of the true speed from the reference's, where that keeps its speed",
     kRows},
    {"return_clearance_min_m", "closest to the canopy on the flight home",
     "Least height above ground or canopy below, on the flight home without the climb that begins "
     "it",
     kRows},
    {"hover_error_rms_m", "typical drift in hover",
     "Root mean square of the distance from the place to be held, while the guidance hovers", ""},
    {"hover_error_max_m", "largest drift in hover",
     "Largest distance from the place to be held, while the guidance hovers", ""},
    {"tilt_max_deg", "largest tilt", "Largest angle between body z and the vertical in the air",
     ""},
    {"thrust_limit_share", "time with a rotor at its limit",
     "Share of the ticks in the air with a rotor's command at a limit", kRows},
    {"crashed", "crashed", "1 after a crash, else 0", ""},
    // Flight on wings.
    {"height_error_rms_m", "typical height error",
     "Root mean square of the true height minus the reference's, on lanes and turns", kAir},
    {"height_error_max_m", "largest height error",
     "Largest true height minus the reference's, on lanes and turns", kAir},
    {"airspeed_error_rms_mps", "typical airspeed error",
     "Root mean square of the true airspeed minus the reference's", kAir},
    {"heading_error_rms_deg", "typical heading error",
     "Root mean square of the true heading minus the reference's", kAir},
    {"straight_heading_error_rms_deg", "typical heading error, straight",
     "Root mean square of the true heading minus the reference's, while that is straight", kAir},
    {"straight_cross_track_rms_m", "typical distance from the lane",
     "Root mean square of the true distance from the lane in the plane, while straight", kAir},
    {"straight_cross_track_max_m", "largest distance from the lane",
     "Largest true distance from the lane in the plane, while straight", kAir},
    {"landing_distance_m", "distance from the planned touchdown",
     "True distance from where it should land, once it lies on the ground", kAir},
    {"bank_max_deg", "largest bank", "Largest true roll angle", kAir},
    {"load_factor_max", "largest load factor", "Largest specific force along body z, over g", ""},
    {"limit_steps_lon_states", "ticks beyond limits: pitch plane, states",
     "Ticks with a longitudinal state farther from its reference than the controller's limit",
     "paper A, §2.2 (±10 %)"},
    {"limit_steps_lon_inputs", "ticks beyond limits: throttle, elevator",
     "Ticks with throttle or elevator farther from trim than the limit", "paper A, §2.2 (20 %)"},
    {"limit_steps_lat_states", "ticks beyond limits: roll and yaw, states",
     "Ticks with a lateral state farther from its reference than the controller's limit",
     "paper A, §2.2 (±10 %)"},
    {"limit_steps_lat_inputs", "ticks beyond limits: ailerons",
     "Ticks with the aileron farther from trim than the limit", "paper A, §2.2 (20 %)"},
    {"limit_share_max", "largest share of a limit used",
     "Largest share of a limit that any state or input took (1: at it)", "paper A, §2.2"},
    // Survey.
    {"shots", "pictures taken", "Pictures of the survey camera", kSurvey},
    {"shots_off_ground", "pictures beyond the ground",
     "Pictures with a corner beyond the ground or above the horizon, which count nowhere else", ""},
    {"covered_share", "parcel photographed", "Share of the parcel's cells that a picture sees",
     kSurvey},
    {"covered_twice_share", "parcel photographed twice",
     "Share of the parcel's cells that two pictures see", kSurvey},
    {"covered_three_times_share", "parcel photographed three times",
     "Share of the parcel's cells that three pictures see", kSurvey},
    {"overlap_covered_share", "parcel where a pair reaches the wanted overlap",
     "Share of the parcel's cells seen by two consecutive pictures of one lane that overlap as "
     "wanted",
     kSurvey},
    {"overlap_held_share", "parcel where every pair keeps the wanted overlap",
     "Share of the parcel's cells on some lane of which all consecutive pictures overlap as wanted",
     kSurvey},
    {"forward_overlap_min", "least forward overlap",
     "Least area in common of consecutive pictures of one lane, over the first one's, from above",
     kSurvey},
    {"forward_overlap_mean", "mean forward overlap",
     "Mean area in common of consecutive pictures of one lane, over the first one's", kSurvey},
    {"side_overlap_min", "least side overlap",
     "Least share of a picture that the strip of the neighbouring lane covers", kSurvey},
    {"side_overlap_mean", "mean side overlap",
     "Mean share of a picture that the strip of the neighbouring lane covers", kSurvey},
    {"gsd_min_m", "finest ground resolution",
     "Least ground sampling distance along the optical axis, of pictures that touch the parcel",
     kSurvey},
    {"gsd_mean_m", "mean ground resolution",
     "Mean ground sampling distance along the optical axis: metres of ground a pixel", kSurvey},
    {"gsd_max_m", "coarsest ground resolution",
     "Largest ground sampling distance along the optical axis", kSurvey},
    {"gsd_formula_error_mean", "ground resolution against the formula, mean",
     "How much the ground sampling distance is above the formula's for a level camera, mean",
     kSurvey},
    {"gsd_formula_error_max", "ground resolution against the formula, largest",
     "How much the ground sampling distance is above the formula's for a level camera, largest",
     kSurvey},
    // What payloads did; the payload's name stands before.
    {"*_litres_sprayed", "spray used", "Volume that left the nozzles", ""},
    {"*_litres_canopy", "spray on the canopy", "Volume that met canopy", ""},
    {"*_litres_ground", "spray on the ground", "Volume that met the ground", ""},
    {"*_litres_lost", "spray lost", "Volume that drifted away", ""},
    {"*_litres_off_row", "spray beside the rows", "Volume sprayed where no row stands", ""},
    {"*_litres_left", "spray left", "Volume left in the tank", ""},
    {"*_litres_per_ha", "spray for each hectare", "Volume sprayed over the area treated", ""},
    {"*_on_target_share", "spray on target", "Share of the sprayed volume that met canopy", ""},
    {"*_spray_time_s", "time spraying", "Time with a nozzle open", ""},
    {"*_worked_covered_share", "worked canopy that received the target",
     "Share of the canopy surface beside which the vehicle worked that received the target amount",
     ""},
    {"*_worked_deposit_mean_ml_per_m2", "mean deposit on the worked canopy",
     "Mean deposit over the canopy surface beside which the vehicle worked", ""},
    {"*_worked_deposit_cv", "unevenness of the deposit",
     "Coefficient of variation of the deposit over the worked canopy surface", ""},
    {"*_worked_share", "canopy worked",
     "Share of the canopy surface beside which the vehicle worked", ""},
    {"*_deposit_mean_ml_per_m2", "mean deposit", "Mean deposit over the whole canopy surface", ""},
    {"*_canopy_pictures", "pictures of canopy", "Pictures that show canopy", ""},
    {"*_seen_twice_share", "canopy seen twice",
     "Share of the canopy surface that two pictures show well enough", ""},
    {"*_seen_share", "canopy seen", "Share of the canopy surface that a picture shows well enough",
     ""},
    {"*_gsd_mean_mm", "mean resolution on the canopy",
     "Mean over the seen canopy surface of its best ground sampling distance", ""},
    {"*_covered_share", "canopy that received the target",
     "Share of the whole canopy surface that received the target amount", ""},
    {"*_pictures", "pictures taken", "Pictures that the payload's cameras took", ""},
    {"min_vehicle_distance_m", "closest to another vehicle",
     "Least true distance between the boxes of this vehicle and another", ""},
    // What jobs tell of their products.
    {"density_per_m2", "density of the point cloud", "Points of the cloud on each square metre",
     "paper A, §3"},
    {"file_MB", "size of the point cloud", "Bytes of the cloud's file", ""},
    {"gsd_m", "ground resolution of the pictures", "Ground sampling distance of the pictures taken",
     kSurvey},
    {"height_noise_m", "noise of the cloud in height",
     "1 sigma of the points' heights, as photogrammetry gives it", ""},
    {"horizontal_noise_m", "noise of the cloud in the plane",
     "1 sigma of the points along each horizontal axis", ""},
    {"mean_views", "pictures of each point", "Mean number of pictures that show a point", ""},
    {"pictures", "pictures used", "Pictures that the cloud was made of", ""},
    {"points", "points of the cloud", "Points that the job made or read", ""},
    {"rows", "rows on the map", "Plant rows on the map that was made", "paper A, §3"},
    {"alleys", "alleys on the map", "Free strips between rows on the map that was made", ""},
    {"rows_found", "true rows that were found", "Rows of the map that stand for a true one",
     "paper A, §3"},
    {"rows_true", "true rows", "Rows that stand in the vineyard", ""},
    {"rows_extra", "rows on the map that do not exist", "Rows of the map where no true row stands",
     ""},
    {"containment_share", "canopy inside the meshes",
     "Share of the canopy's points within 1 cm of the map's meshes, whose sides are moved outward "
     "until it is 0.985: shows whether that setting was kept",
     "paper A, §3"},
    {"reduction_share", "data saved by the map",
     "Share of the cloud's bytes that the map does without", "paper A, §3"},
    {"mesh_MB", "size of the meshes",
     "Bytes of the map's meshes; follows from the bytes per metre of row that they are allowed",
     "paper A, §3"},
    {"direction_error_deg", "error of the rows' direction",
     "Largest angle between a row on the map and the true one", ""},
    {"spacing_error_m", "error of the distance between rows",
     "Mean distance between rows on the map minus the true one", ""},
    {"end_error_max_m", "largest error of a row's end",
     "Largest distance between a row's end on the map and the true one", ""},
    {"volume_error_share", "error of the canopy's volume",
     "Volume inside the meshes minus that of the true canopy, over that", ""},
    // Estimation.
    {"estimate_lateral_std_m", "spread of the position error across the rows",
     "Standard deviation of estimate minus truth across the nearest row", kPaperC3},
    {"estimate_lateral_rms_m", "typical position error across the rows",
     "Root mean square of estimate minus truth across the nearest row", kPaperC3},
    {"estimate_lateral_max_m", "largest position error across the rows",
     "Largest estimate minus truth across the nearest row", kPaperC3},
    {"estimate_longitudinal_std_m", "spread of the position error along the rows",
     "Standard deviation of estimate minus truth along the nearest row", kPaperC3},
    {"estimate_longitudinal_rms_m", "typical position error along the rows",
     "Root mean square of estimate minus truth along the nearest row", kPaperC3},
    {"estimate_longitudinal_max_m", "largest position error along the rows",
     "Largest estimate minus truth along the nearest row", kPaperC3},
    {"estimate_vertical_rms_m", "typical error of the estimated height",
     "Root mean square of the estimated height minus the true one", "paper C, §3"},
    {"estimate_yaw_rms_deg", "typical error of the estimated heading",
     "Root mean square of the estimated heading minus the true one", "paper C, §3"},
    {"estimate_consistent", "estimator right about its own error",
     "1 where the mean NEES lies within the chi-square bounds (95 %) of as many samples as the "
     "correlated ones are worth, widened by the metric's margin",
     kNees},
    {"nees_mean", "error against its stated covariance",
     "Mean of e'P⁻¹e of the horizontal error e with the covariance P that the estimator states; 2 "
     "where it is right",
     kNees},
    {"nees_in_95_share", "time inside the 95 % ellipse",
     "Share of samples with the true place inside the estimator's 95 % ellipse", kNees},
    {"ellipsoid_containment_share", "time inside the guaranteed set",
     "Share of the estimator's sets that contain the true position", "paper C, fig. 9"},
    {"nis_*_mean", "innovations of one source against their covariance",
     "Mean of the normalised innovations squared; the source's number of components where the "
     "filter is right",
     kNees},
};

/// Whether a name fits a pattern with at most one "*", which stands for one letter or more.
bool fits(const std::string& name, const std::string& pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string::npos) return name == pattern;
  const std::string head = pattern.substr(0, star), tail = pattern.substr(star + 1);
  return name.size() > head.size() + tail.size() && name.starts_with(head) && name.ends_with(tail);
}

const Entry* find(const std::string& name) {
  const auto found = std::find_if(std::begin(kMetrics), std::end(kMetrics),
                                  [&](const Entry& entry) { return fits(name, entry.name); });
  return found == std::end(kMetrics) ? nullptr : found;
}

/// Of "ekf_lateral_rms_m" or "ekf_nees_mean": the entry of the estimate, and the observer's name.
const Entry* find_observed(const std::string& name, std::string& observer) {
  for (std::size_t at = name.find('_'); at != std::string::npos; at = name.find('_', at + 1)) {
    const std::string rest = name.substr(at + 1);
    const Entry* entry = find("estimate_" + rest);
    if (entry == nullptr && (rest.starts_with("nees_") || rest.starts_with("nis_") ||
                             rest == "ellipsoid_containment_share")) {
      entry = find(rest);
    }
    if (entry == nullptr) continue;
    observer = name.substr(0, at);
    return entry;
  }
  return nullptr;
}

}  // namespace

MetricMeaning metric_meaning(const std::string& name) {
  if (const Entry* entry = find(name))
    return {entry->title, entry->definition, entry->source, true};
  std::string observer;
  if (const Entry* entry = find_observed(name, observer)) {
    return {std::string(entry->title) + " (observer " + observer + ")",
            std::string(entry->definition) + ", of the observer " + observer, entry->source, true};
  }
  return {words_of(name), "", "", false};
}

}  // namespace vinerow::tools::report

#pragma once
/// Nadir camera of an aircraft: ground sampling distance, footprint, and the spacing of pictures
/// and lanes. Shared by the survey planner, the camera trigger and metrics.
///
/// Over flat ground, looking straight down from height h, with focal length f, sensor width w
/// (across the track) and height l (along it), both in the same unit as f:
///   GSD = w / columns h / f        footprint = h / f (w across, l along)
/// Forward overlap q at speed V over ground and rate r: V / r <= (1 - q) h l / f. Side overlap p:
/// lanes at most (1 - p) h w / f apart. Paper A, section 2; its GSD of 102 mm at 150 m corresponds
/// to f = 5.5 mm, while f = 5.4 mm gives 104.2 mm.

#include <optional>
#include <string>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/api/parameters.h"

namespace vinerow {

struct SurveyCamera {
  std::string name = "rededge";
  double focal_length_mm = 5.4;
  double sensor_width_mm = 4.8;   ///< across the track
  double sensor_height_mm = 3.6;  ///< along the track
  int columns = 1280;
  int rows = 960;
  double max_rate_Hz = 1.0;  ///< maximum picture rate

  /// m per pixel across the track, looking straight down from `height_m` above flat ground.
  double gsd_m(double height_m) const;
  double footprint_width_m(double height_m) const;
  double footprint_length_m(double height_m) const;
  /// Height above ground for a ground sampling distance.
  double height_for_gsd_m(double gsd_m) const;
  /// Share of consecutive pictures `step_m` apart; may be negative.
  double forward_overlap(double height_m, double step_m) const;
  /// Share of neighbouring lanes `spacing_m` apart; may be negative.
  double side_overlap(double height_m, double spacing_m) const;
  /// Half of the field of view across the track, rad.
  double half_angle_across_rad() const;
  double half_angle_along_rad() const;
};

/// A camera by name, with overrides.
struct SurveyCameraParams {
  std::string camera = "rededge";
  std::optional<double> focal_length_mm;
  std::optional<double> sensor_width_mm;
  std::optional<double> sensor_height_mm;
  std::optional<int> columns;
  std::optional<int> rows;
  std::optional<double> max_rate_Hz;

  SurveyCamera resolve() const;
};

/// `camera` (rededge | rededge_5p5 | rx100) and its overrides: focal_length_mm, sensor_width_mm,
/// sensor_height_mm, image_columns, image_rows, max_rate_Hz.
const ParameterTable<SurveyCameraParams>& survey_camera_table();
/// Specs of that table, and a camera built from its parameters.
std::vector<ParameterSpec> survey_camera_parameters();
SurveyCamera read_survey_camera(const ParameterSet& parameters);

}  // namespace vinerow

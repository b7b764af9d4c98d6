#include "engine/api/survey_camera.h"

#include <cmath>

namespace vinerow {
namespace {

/// Data sheets. MicaSense RedEdge: 5.4 mm, 4.8 x 3.6 mm, 1280 x 960, a capture a second (paper A,
/// section 2; RedEdge-M user manual, 2017, gives the same). rededge_5p5: the focal length behind
/// the paper's 102 mm (5.5 mm: RedEdge 3). Sony DSC-RX100: 8.8 mm at the wide end, sensor 13.2 x
/// 8.8 mm, 5472 x 3648 (Sony's specifications of the DSC-RX100, 2012); one picture a second is
/// what an intervalometer triggers it at.
SurveyCamera make_preset(const std::string& name) {
  SurveyCamera camera;
  camera.name = name;
  if (name == "rededge_5p5") camera.focal_length_mm = 5.5;
  if (name == "rx100") {
    camera.focal_length_mm = 8.8;
    camera.sensor_width_mm = 13.2;
    camera.sensor_height_mm = 8.8;
    camera.columns = 5472;
    camera.rows = 3648;
  }
  return camera;
}

}  // namespace

double SurveyCamera::gsd_m(double height_m) const {
  return sensor_width_mm / columns * height_m / focal_length_mm;
}

double SurveyCamera::footprint_width_m(double height_m) const {
  return height_m * sensor_width_mm / focal_length_mm;
}

double SurveyCamera::footprint_length_m(double height_m) const {
  return height_m * sensor_height_mm / focal_length_mm;
}

double SurveyCamera::height_for_gsd_m(double gsd_m) const {
  return gsd_m * focal_length_mm * columns / sensor_width_mm;
}

double SurveyCamera::forward_overlap(double height_m, double step_m) const {
  return 1.0 - step_m / footprint_length_m(height_m);
}

double SurveyCamera::side_overlap(double height_m, double spacing_m) const {
  return 1.0 - spacing_m / footprint_width_m(height_m);
}

double SurveyCamera::half_angle_across_rad() const {
  return std::atan(0.5 * sensor_width_mm / focal_length_mm);
}

double SurveyCamera::half_angle_along_rad() const {
  return std::atan(0.5 * sensor_height_mm / focal_length_mm);
}

std::vector<ParameterSpec> survey_camera_parameters() {
  constexpr double kMostPixels = 100000.0;
  return {
      choice_parameter("camera", "rededge", {"rededge", "rededge_5p5", "rx100"},
                       "camera that looks straight down, the longer side of its picture across the "
                       "track; the numbers below replace its own"),
      optional(positive_parameter("focal_length_mm", "mm", 5.4, "focal length")),
      optional(positive_parameter("sensor_width_mm", "mm", 4.8, "sensor, across the track")),
      optional(positive_parameter("sensor_height_mm", "mm", 3.6, "sensor, along the track")),
      optional(integer_parameter("image_columns", 1280, 1.0, kMostPixels,
                                 "pixels of a picture across the track")),
      optional(integer_parameter("image_rows", 960, 1.0, kMostPixels,
                                 "pixels of a picture along the track")),
      optional(positive_parameter("max_rate_Hz", "Hz", 1.0, "pictures per second at most")),
  };
}

SurveyCamera read_survey_camera(const ParameterSet& parameters) {
  SurveyCamera camera = make_preset(parameters.text("camera"));
  const auto replace = [&](const char* name, double& value) {
    if (parameters.has(name)) value = parameters.number(name);
  };
  replace("focal_length_mm", camera.focal_length_mm);
  replace("sensor_width_mm", camera.sensor_width_mm);
  replace("sensor_height_mm", camera.sensor_height_mm);
  replace("max_rate_Hz", camera.max_rate_Hz);
  if (parameters.has("image_columns")) {
    camera.columns = static_cast<int>(parameters.integer("image_columns"));
  }
  if (parameters.has("image_rows")) {
    camera.rows = static_cast<int>(parameters.integer("image_rows"));
  }
  return camera;
}

}  // namespace vinerow

#include "engine/api/survey_camera.h"

#include <cmath>

#include "engine/api/parameter_table.h"

namespace vinerow {
namespace {

/// Data sheets. MicaSense RedEdge: 5.4 mm, 4.8 x 3.6 mm, 1280 x 960, one capture per second (paper
/// A, section 2; the RedEdge-M user manual, 2017, has the same). rededge_5p5: the focal length that
/// gives the paper's 102 mm (5.5 mm: RedEdge 3). Sony DSC-RX100: 8.8 mm at the wide end, sensor
/// 13.2 x 8.8 mm, 5472 x 3648 (Sony's specifications of the DSC-RX100, 2012); one picture per
/// second is the rate of an intervalometer.
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

const ParameterTable<SurveyCameraParams>& survey_camera_table() {
  constexpr double kMaxPixels = 100000.0;
  using P = SurveyCameraParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("camera", &P::camera,
                "camera that looks straight down, with the longer side of its picture across the "
                "track; the keys below replace its data")
          .one_of({"rededge", "rededge_5p5", "rx100"})
          .number("focal_length_mm", "mm", &P::focal_length_mm, between(0.1, 10'000.0),
                  "focal length")
          .number("sensor_width_mm", "mm", &P::sensor_width_mm, between(0.1, 1'000.0),
                  "sensor size across the track")
          .number("sensor_height_mm", "mm", &P::sensor_height_mm, between(0.1, 1'000.0),
                  "sensor size along the track")
          .integer("image_columns", &P::columns, between(1.0, kMaxPixels),
                   "pixels of a picture across the track")
          .integer("image_rows", &P::rows, between(1.0, kMaxPixels),
                   "pixels of a picture along the track")
          .number("max_rate_Hz", "Hz", &P::max_rate_Hz, between(1e-3, 1e3), "maximum picture rate");
  return table;
}

SurveyCamera SurveyCameraParams::resolve() const {
  SurveyCamera resolved = make_preset(camera);
  resolved.focal_length_mm = focal_length_mm.value_or(resolved.focal_length_mm);
  resolved.sensor_width_mm = sensor_width_mm.value_or(resolved.sensor_width_mm);
  resolved.sensor_height_mm = sensor_height_mm.value_or(resolved.sensor_height_mm);
  resolved.columns = columns.value_or(resolved.columns);
  resolved.rows = rows.value_or(resolved.rows);
  resolved.max_rate_Hz = max_rate_Hz.value_or(resolved.max_rate_Hz);
  // With other optics it is no longer the named camera.
  if (focal_length_mm || sensor_width_mm || sensor_height_mm || columns || rows) {
    resolved.name = "own";
  }
  return resolved;
}

std::vector<ParameterSpec> survey_camera_parameters() {
  return survey_camera_table().specs();
}

SurveyCamera read_survey_camera(const ParameterSet& parameters) {
  return survey_camera_table().read(parameters, "").resolve();
}

}  // namespace vinerow

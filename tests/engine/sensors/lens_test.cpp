/// Lenses of cameras against the written formulas and their inverse.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/math/angles.h"
#include "engine/sensors/camera/lens.h"
#include "tests/engine/sensors/sensor_parts.h"

namespace vinerow::sensors::lens_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

LensParams wide_angle() {
  LensParams params;
  params.fx_px = 420.0;
  params.fy_px = 415.0;
  params.cx_px = 322.5;
  params.cy_px = 236.0;
  params.distortion = {-0.28, 0.09, 0.0008, -0.0005, -0.012};
  return params;
}

TEST(Lens, PinholeHasItsFieldOfView) {
  LensParams params;
  params.horizontal_fov_rad = rad_from_deg(90.0);
  const Lens lens = make_lens(params, "camera");
  EXPECT_NEAR(lens.info().fx_px, 320.0, 1e-9);
  EXPECT_EQ(lens.info().fx_px, lens.info().fy_px);
  // The middle of the picture lies between its four middle pixels.
  EXPECT_EQ(lens.info().cx_px, 319.5);
  EXPECT_EQ(lens.info().cy_px, 239.5);
  // The outer edge of the first column, half a pixel from its middle, is at 45 degrees.
  const Vector3d edge = lens.direction(-0.5, 239.5).value();
  EXPECT_NEAR(edge.x(), -std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(edge.z(), std::sqrt(0.5), 1e-12);
}

TEST(Lens, BrownConradyIsTheFormulaOfItsCoefficients) {
  const Lens lens = make_lens(wide_angle(), "camera");
  const double x = 0.31, y = -0.22, r2 = x * x + y * y;
  const double radial = 1 - 0.28 * r2 + 0.09 * r2 * r2 - 0.012 * r2 * r2 * r2;
  const double p1 = 0.0008, p2 = -0.0005;
  const double u = 420.0 * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + 322.5;
  const double v = 415.0 * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + 236.0;
  const auto pixel = lens.project({x, y, 1.0});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), u, 1e-10);
  EXPECT_NEAR(pixel->y(), v, 1e-10);
}

TEST(Lens, EquidistantFisheyeSeesBehindItself) {
  LensParams params;
  params.lens = CameraInfo::Lens::kFisheye;
  params.horizontal_fov_rad = rad_from_deg(200.0);
  params.height_px = 640;
  const Lens lens = make_lens(params, "camera");
  // Radius is proportional to the angle: 100 degrees at the outer edge.
  const Vector3d edge = lens.direction(-0.5, 319.5).value();
  EXPECT_NEAR(std::atan2(-edge.x(), edge.z()), rad_from_deg(100.0), 1e-9);
  EXPECT_LT(edge.z(), 0.0);
}

TEST(Lens, PixelsOfDirectionsAreDirectionsOfPixels) {
  LensParams fisheye;
  fisheye.lens = CameraInfo::Lens::kFisheye;
  fisheye.horizontal_fov_rad = rad_from_deg(150.0);
  fisheye.distortion = {-0.04, 0.008, -0.003, 0.0004};
  for (const LensParams& params : {LensParams{}, wide_angle(), fisheye}) {
    const Lens lens = make_lens(params, "camera");
    double worst_px = 0.0;
    for (int y = 0; y < lens.height(); y += 13) {
      for (int x = 0; x < lens.width(); x += 11) {
        const Vector3d direction = lens.direction(x, y).value();
        EXPECT_NEAR(direction.norm(), 1.0, 1e-12);
        const auto back = lens.project(direction);
        ASSERT_TRUE(back);
        worst_px = std::max(worst_px, (*back - Vector2d(x, y)).norm());
      }
    }
    EXPECT_LT(worst_px, 1e-6);
  }
}

TEST(Lens, RefusesWhatHasNoInverse) {
  LensParams folded;
  folded.horizontal_fov_rad = rad_from_deg(100.0);
  folded.distortion = {-0.4, 0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(test::refusal_of([&] { make_lens(folded, "rover.sensors.front"); }),
            "rover.sensors.front: the lens folds: with this distortion and focal length no single "
            "direction belongs to pixel (0, 0)");
  LensParams fisheye;
  fisheye.lens = CameraInfo::Lens::kFisheye;
  fisheye.horizontal_fov_rad = rad_from_deg(180.0);
  fisheye.distortion = {-0.3, 0.0, 0.0, 0.0};
  EXPECT_NE(test::refusal_of([&] { make_lens(fisheye, "rover.sensors.front"); }).find("folds"),
            std::string::npos);
}

TEST(Lens, RefusesAbsurdParameters) {
  const auto refusal = [](const test::SensorValues& values) {
    return test::refusal_of([&] {
      const ParameterSet parameters = test::sensor_parameters("camera", values);
      lens_table().read(parameters, "rover.sensors.front");
    });
  };
  EXPECT_NE(refusal({{"width_px", std::int64_t{0}}}).find("width_px = 0"), std::string::npos)
      << refusal({{"width_px", std::int64_t{0}}});
  EXPECT_EQ(refusal({{"distortion", std::vector<double>{0.1, 0.2}}}),
            "rover.sensors.front: distortion has 2 coefficients, must have 5 for lens "
            "brown_conrady (k1, k2, p1, p2, k3) or none");
  EXPECT_EQ(refusal({{"width_px", std::int64_t{8192}}, {"height_px", std::int64_t{8192}}}),
            "rover.sensors.front: width_px x height_px = 8192 x 8192, must be at most 16777216 "
            "pixels");
  EXPECT_EQ(refusal({{"horizontal_fov_deg", 170.0}}),
            "rover.sensors.front: horizontal_fov_deg = 170, must be at most 160 for lens "
            "brown_conrady; lens fisheye is wider");
  // Each focal length is measured by its own axis: 240 rows, 320 pixels in a row.
  const std::int64_t columns = 320, rows = 240;
  EXPECT_EQ(refusal({{"width_px", columns}, {"height_px", rows}, {"fy_px", 25.0}}), "no error");
  EXPECT_EQ(refusal({{"width_px", columns}, {"height_px", rows}, {"fy_px", 20.0}}),
            "rover.sensors.front: fy_px = 20, must be at least 20.7 for lens brown_conrady with "
            "240 rows, which is a view of 160 deg; lens fisheye is wider");
  EXPECT_EQ(
      refusal({{"width_px", std::int64_t{16}}, {"height_px", std::int64_t{8192}}, {"fx_px", 10.0}}),
      "rover.sensors.front: height_px = 8192, must be at most 115 for lens brown_conrady "
      "with a focal length of 10 pixels, which is a view of 160 deg; lens fisheye is wider");
  EXPECT_EQ(refusal({{"width_px", columns}, {"fx_px", 277.0}, {"cx_px", 9e4}}),
            "rover.sensors.front: cx_px = 90000 with 320 pixels in a row and a focal length of 277 "
            "pixels looks 89.8 deg aside, must be at most 80 deg for lens brown_conrady");
  EXPECT_EQ(refusal({{"width_px", columns}, {"fx_px", 277.0}, {"cx_px", -300.0}}), "no error");
}

}  // namespace
}  // namespace vinerow::sensors::lens_test

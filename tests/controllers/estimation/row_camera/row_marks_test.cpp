/// Marks of rows in pictures that are drawn by the lens's formula, and the filter that uses them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "controllers/estimation/row_camera/row_camera_filter.h"
#include "controllers/estimation/row_camera/row_marks.h"
#include "controllers/estimation/row_camera/soil_colour.h"
#include "engine/api/surface.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "engine/math/srgb.h"
#include "tests/support/no_alloc.h"

namespace vinerow::controllers::row_marks_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHeight_m = 0.15;  // of B above the ground

/// Camera 0.7 m above B, 0.4 m ahead, looking down by 15 degrees.
Pose mounting() {
  return {quaternion_from_rpy({0.0, rad_from_deg(15.0), 0.0}), {0.4, 0.0, 0.7}};
}

CameraInfo camera() {
  CameraInfo info;
  info.width = 320;
  info.height = 240;
  info.fx_px = info.fy_px = 190.0;
  info.cx_px = 159.5;
  info.cy_px = 119.5;
  return info;
}

/// Where the ground plane is at this pixel, m in B; nullopt above the horizon. By hand, not by the
/// code under test.
std::optional<Vector2d> ground_at(int u, int v) {
  const double down = rad_from_deg(15.0);
  const double x = (u - 159.5) / 190.0, y = (v - 119.5) / 190.0;
  // Along the axis, to the left and up, of a ray of length one along the axis.
  const double ahead = std::cos(down) - y * std::sin(down);
  const double up = -std::sin(down) - y * std::cos(down);
  if (up >= 0.0) return std::nullopt;
  const double scale = (0.7 + kHeight_m) / -up;
  return Vector2d(0.4 + scale * ahead, -scale * x);
}

Picture empty_picture(Picture::Format format) {
  Picture picture;
  picture.width = 320;
  picture.height = 240;
  picture.format = format;
  picture.data.resize(320 * 240 * Picture::bytes_per_pixel(format));
  return picture;
}

TEST(RowMarks, FindTheFeetOfPosts) {
  // Posts of 8 cm along y = 1.2 and -1.3: the ground before them, and all above, is as it is.
  Picture labels = empty_picture(Picture::Format::kMono8);
  int drawn = 0;
  for (int u = 0; u < 320; ++u) {
    bool stands = false;
    for (int v = 239; v >= 0; --v) {
      const auto p = ground_at(u, v);
      if (p && !stands) {
        for (const double row : {1.2, -1.3}) {
          for (const double ahead : {2.0, 3.0, 4.0}) {
            stands = stands || (std::abs(p->x() - ahead) < 0.04 && std::abs(p->y() - row) < 0.04);
          }
        }
        drawn += stands ? 1 : 0;
      }
      const Label label = stands ? Label::kPost : p ? Label::kGround : Label::kSky;
      labels.data[static_cast<std::size_t>(v) * 320 + u] = static_cast<std::uint8_t>(label);
    }
  }
  ASSERT_GT(drawn, 10);
  RowMarks marks({}, mounting(), kHeight_m);
  marks.set_camera(camera());
  const std::vector<RowMark>& found = marks.find_feet(labels);
  EXPECT_EQ(found.size(), static_cast<std::size_t>(drawn));
  for (const RowMark& mark : found) {
    EXPECT_LT(std::min(std::abs(mark.p_B.y() - 1.2), std::abs(mark.p_B.y() + 1.3)), 0.041);
  }
}

TEST(RowMarks, LeavesThatHangBeforeTheFootHideIt) {
  Picture labels = empty_picture(Picture::Format::kMono8);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const Label label = v > 180 ? Label::kGround : v > 150 ? Label::kLeaf : Label::kWood;
      labels.data[static_cast<std::size_t>(v) * 320 + u] = static_cast<std::uint8_t>(label);
    }
  }
  RowMarks marks({}, mounting(), kHeight_m);
  marks.set_camera(camera());
  EXPECT_TRUE(marks.find_feet(labels).empty());
}

TEST(RowMarks, AFootHasATrunkAboveIt) {
  // Columns with 1, 2, ... pixels of wood on the ground, leaves above.
  Picture labels = empty_picture(Picture::Format::kMono8);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const int tall_px = u % 8;
      const Label label = v > 180             ? Label::kGround
                          : v > 180 - tall_px ? Label::kWood
                                              : Label::kLeaf;
      labels.data[static_cast<std::size_t>(v) * 320 + u] = static_cast<std::uint8_t>(label);
    }
  }
  for (const int foot_px : {1, 3, 7}) {
    RowMarksParams params;
    params.foot_px = foot_px;
    RowMarks marks(params, mounting(), kHeight_m);
    marks.set_camera(camera());
    EXPECT_EQ(marks.find_feet(labels).size(), 40u * static_cast<std::size_t>(8 - foot_px))
        << foot_px;
  }
}

/// Light from red to blue.
using Light = std::array<double, 3>;
constexpr Light kSun = {1.0, 1.0, 1.0};

/// Linear light of a black body of 10,000 K, as the blue sky, against the sun's 5,500 K by Wien's
/// law: shade, in which red loses most.
Light shade() {
  Light light;
  const std::array<double, 3> wavelength_nm = {610.0, 540.0, 460.0};
  for (std::size_t c = 0; c < 3; ++c) {
    const double ratio_at = 1.4388e7 * (1.0 / 5500.0 - 1.0 / 10000.0);
    light[c] = 0.15 * std::exp(ratio_at / wavelength_nm[c] - ratio_at / 540.0);
  }
  return light;
}

constexpr std::array<double, 3> kSoil = {0.30, 0.22, 0.15}, kGrass = {0.12, 0.16, 0.06};

using PixelColour = std::array<std::uint8_t, 3>;
PixelColour seen(const std::array<double, 3>& surface, const Light& light, double noise = 0.0) {
  PixelColour pixel;
  for (std::size_t c = 0; c < 3; ++c) {
    const double linear = std::clamp(2.0 * surface[c] * light[c] * (1.0 + noise), 0.0, 1.0);
    pixel[c] = static_cast<std::uint8_t>(std::lround(255.0 * srgb_from_linear(linear)));
  }
  return pixel;
}

/// Ground of grass with soil where `is_soil`, in the light of each place; noise of 5 %.
template <class IsSoil, class LightAt>
Picture ground_picture(const IsSoil& is_soil, const LightAt& light_at) {
  Picture colours = empty_picture(Picture::Format::kRgb8);
  RandomStream random(1, "", "colours");
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const auto p = ground_at(u, v);
      const PixelColour pixel =
          p ? seen(is_soil(*p) ? kSoil : kGrass, light_at(*p), 0.05 * random.normal())
            : PixelColour{90, 130, 200};
      std::copy(pixel.begin(), pixel.end(),
                &colours.data[3 * (static_cast<std::size_t>(v) * 320 + u)]);
    }
  }
  return colours;
}
Light sun_everywhere(const Vector2d& /*p*/) {
  return kSun;
}

/// Straight rows at y = 1.2 and -1.3 from the picture's own place.
PolylineIndex rows_aside() {
  std::vector<Polyline> rows;
  for (const double y : {1.2, -1.3}) {
    rows.emplace_back(std::vector<Vector2d>{{-10.0, y}, {0.0, y}, {10.0, y}});
  }
  return PolylineIndex(rows);
}
double off_m(const Vector2d& p) {
  return std::abs(p.y() - 1.2) < std::abs(p.y() + 1.3) ? p.y() - 1.2 : p.y() + 1.3;
}

RowMarks strip_finder() {
  RowMarksParams params;
  params.source = RowMarksParams::Source::kColours;
  RowMarks marks(params, mounting(), kHeight_m);
  marks.set_camera(camera());
  return marks;
}

/// What errors of the estimate leave the vehicle to expect.
const Vector3d kExpected(0.1, 0.15, 0.02);

TEST(SoilColour, OfSoilAndGrassIsThatInShade) {
  for (const auto& surface : {kSoil, kGrass}) {
    const float sun = soil_colour(seen(surface, kSun).data());
    EXPECT_NEAR(soil_colour(seen(surface, shade()).data()), sun, 0.04);
  }
  EXPECT_GT(soil_colour(seen(kSoil, shade()).data()) - soil_colour(seen(kGrass, kSun).data()), 0.3);
}

TEST(SoilColour, SplitsTwoClassesAtTheirMeans) {
  std::vector<float> colours;
  for (int i = 0; i < 300; ++i) colours.push_back((i % 3 == 0 ? 0.0f : -0.5f) + 0.001f * (i % 10));
  const SoilClasses classes = split_soil(colours);
  EXPECT_TRUE(classes.differ());
  EXPECT_NEAR(classes.soil, 0.0045, 0.016);  // half a bin
  EXPECT_NEAR(classes.grass, -0.4955, 0.016);
  EXPECT_NEAR(classes.share(-0.25f), 0.49f, 0.04f);
  EXPECT_EQ(classes.share(0.3f), 1.0f);
  EXPECT_FALSE(split_soil(std::vector<float>(50, -0.3f)).differ());
  EXPECT_FALSE(split_soil({}).differ());
}

TEST(RowMarks, FindTheMiddleOfBareStripsInSunAndShade) {
  // Shadows of the left row: on the near half of its strip, and on the alley before it.
  const auto light_at = [](const Vector2d& p) {
    return p.y() > 0.3 && p.y() < 1.1 ? shade() : kSun;
  };
  const Picture colours =
      ground_picture([](const Vector2d& p) { return std::abs(off_m(p)) < 0.34; }, light_at);
  RowMarks marks = strip_finder();
  const std::vector<RowMark>& found = marks.find_strips(colours, kExpected, rows_aside());
  EXPECT_GT(found.size(), 15u);
  double sum_m = 0.0;
  Vector2d sides(0.0, 0.0);
  for (const RowMark& mark : found) {
    // The map is where the vehicle expects it; the picture, where it is.
    EXPECT_NEAR(off_m(mark.p_B), 0.0, 0.05) << mark.p_B.transpose();
    sum_m += off_m(mark.p_B);
    sides[mark.p_B.y() > 0.0 ? 0 : 1] += 1.0;
  }
  EXPECT_NEAR(sum_m / static_cast<double>(found.size()), 0.0, 0.01);
  EXPECT_GT(sides.minCoeff(), 5.0);
}

TEST(RowMarks, OfStripsWithAnotherWidthAreInTheirMiddleToo) {
  for (const double half_m : {0.26, 0.42}) {
    const Picture colours = ground_picture(
        [&](const Vector2d& p) { return std::abs(off_m(p)) < half_m; }, sun_everywhere);
    RowMarks marks = strip_finder();
    const std::vector<RowMark>& found = marks.find_strips(colours, kExpected, rows_aside());
    EXPECT_GT(found.size(), 15u) << half_m;
    double sum_m = 0.0;
    double squares_m2 = 0.0;
    for (const RowMark& mark : found) {
      sum_m += off_m(mark.p_B);
      squares_m2 += std::pow(off_m(mark.p_B), 2);
    }
    const auto count = static_cast<double>(found.size());
    EXPECT_NEAR(sum_m / count, 0.0, 0.015) << half_m;
    std::printf("half width %.2f m: rms %.3f m\n", half_m, std::sqrt(squares_m2 / count));
    EXPECT_LT(std::sqrt(squares_m2 / count), 0.03) << half_m;
  }
}

TEST(RowMarks, FindAStripThatTheVehicleTurnsTo) {
  // A row through (3.5, 0) that rises to the left by 50 degrees.
  const Vector2d along(std::cos(rad_from_deg(50.0)), std::sin(rad_from_deg(50.0)));
  const auto off = [&](const Vector2d& p) { return along.x() * p.y() - along.y() * (p.x() - 3.5); };
  const Picture colours =
      ground_picture([&](const Vector2d& p) { return std::abs(off(p)) < 0.34; }, sun_everywhere);
  const Vector2d through(3.5, 0.0);
  const PolylineIndex rows(
      {Polyline(std::vector<Vector2d>{through - 5.0 * along, through + 5.0 * along})});
  RowMarks marks = strip_finder();
  const std::vector<RowMark>& found = marks.find_strips(colours, {0.2, -0.1, 0.0}, rows);
  EXPECT_GT(found.size(), 5u);
  // Pixels are up to 0.11 m long there.
  for (const RowMark& mark : found) EXPECT_NEAR(off(mark.p_B), 0.0, 0.07);
}

TEST(RowMarks, OfStripsNeedSoilBetweenGrassNearTheRow) {
  RowMarks marks = strip_finder();
  const auto found = [&](const Picture& colours) {
    return marks.find_strips(colours, {0.0, 0.0, 0.0}, rows_aside()).size();
  };
  EXPECT_EQ(found(ground_picture([](const Vector2d&) { return false; }, sun_everywhere)), 0u);
  EXPECT_EQ(found(ground_picture([](const Vector2d&) { return true; }, sun_everywhere)), 0u);
  // Soil on one side, and a strip that is half a metre and more beside the row.
  EXPECT_EQ(found(ground_picture([](const Vector2d& p) { return p.y() > 1.2; }, sun_everywhere)),
            0u);
  EXPECT_EQ(found(ground_picture([](const Vector2d& p) { return std::abs(p.y() - 0.55) < 0.34; },
                                 sun_everywhere)),
            0u);
}

TEST(RowMarks, OfStripsTakeNoHeap) {
  const Picture colours =
      ground_picture([](const Vector2d& p) { return std::abs(off_m(p)) < 0.34; }, sun_everywhere);
  const PolylineIndex rows = rows_aside();
  RowMarks marks = strip_finder();
  marks.find_strips(colours, kExpected, rows);
  const test::AllocationCounter counter;
  EXPECT_FALSE(marks.find_strips(colours, kExpected, rows).empty());
  EXPECT_EQ(counter.count(), 0u);
}

TEST(RowMarks, IgnorePicturesOfAnotherSize) {
  RowMarks marks({}, mounting(), kHeight_m);
  EXPECT_TRUE(marks.find_feet(empty_picture(Picture::Format::kMono8)).empty());
  marks.set_camera(camera());
  Picture other = empty_picture(Picture::Format::kMono8);
  other.width = 319;
  EXPECT_TRUE(marks.find_feet(other).empty());
  EXPECT_TRUE(marks.find_feet(empty_picture(Picture::Format::kRgb8)).empty());
}

/// Rows along x at y = 1.25 and -1.25.
std::vector<Polyline> two_rows() {
  std::vector<Polyline> rows;
  for (const double y : {1.25, -1.25}) {
    rows.emplace_back(std::vector<Vector2d>{{-100.0, y}, {0.0, y}, {100.0, y}});
  }
  return rows;
}

/// Exact marks of both rows from this pose.
std::vector<RowMark> marks_from(const Vector3d& pose) {
  std::vector<RowMark> marks;
  for (const double y : {1.25, -1.25}) {
    for (double x = 1.0; x < 6.0; x += 0.5) {
      const Vector2d p(pose.x() + x, y);
      const Vector2d d = p - pose.head<2>();
      const double c = std::cos(pose.z()), s = std::sin(pose.z());
      marks.push_back({{c * d.x() + s * d.y(), -s * d.x() + c * d.y()}, Vector2d::Zero()});
    }
  }
  return marks;
}

TEST(RowCameraFilter, FindsPlaceAcrossTheRowsAndHeading) {
  RowCameraFilterParams params;
  params.start_std_m = 0.2;
  params.start_yaw_std_rad = 0.1;
  RowCameraFilter filter(params, two_rows());
  const Vector3d truth(3.0, 0.1, 0.02);
  filter.start({3.3, -0.05, -0.04});
  for (int i = 0; i < 20; ++i) EXPECT_GT(filter.correct(marks_from(truth), filter.state()), 10);
  EXPECT_NEAR(filter.state()[1], 0.1, 0.01);
  EXPECT_NEAR(filter.state()[2], 0.02, 0.005);
  // Along straight rows there is nothing to see.
  EXPECT_NEAR(filter.state()[0], 3.3, 0.02);
  EXPECT_NEAR(filter.covariance()(0, 0), 0.04, 1e-3);
  EXPECT_LT(filter.covariance()(1, 1), 0.001);
}

TEST(RowCameraFilter, IsTheKalmanFilterOfItsMeasurement) {
  // One mark straight to the left: a measurement of y + heading times zero.
  RowCameraFilterParams params;
  params.start_std_m = 0.1;
  params.mark_std_m = 0.1;
  RowCameraFilter filter(params, two_rows());
  filter.start({0.0, 0.0, 0.0});
  EXPECT_EQ(filter.correct({{{0.0, 1.15}, Vector2d::Zero()}}, filter.state()), 1);
  // Equal variances: half of the residual of 0.1 m, and half of the variance.
  EXPECT_NEAR(filter.state()[1], 0.05, 1e-12);
  EXPECT_NEAR(filter.covariance()(1, 1), 0.005, 1e-12);
  EXPECT_NEAR(filter.covariance()(0, 0), 0.01, 1e-12);
}

TEST(RowCameraFilter, LearnsTheGyrosBias) {
  RowCameraFilterParams params;
  params.start_bias_std_radps = 0.02;
  RowCameraFilter filter(params, two_rows());
  filter.start({0.0, 0.0, 0.0});
  Vector3d truth(0.0, 0.0, 0.0);
  for (int i = 0; i < 600; ++i) {
    filter.predict(1.0, 0.01, 0.05);  // it drives straight; the gyro is off by 0.01 rad/s
    truth.x() += 0.05;
    if (i % 4 == 0) filter.correct(marks_from(truth), filter.state());
  }
  EXPECT_NEAR(filter.state()[3], 0.01, 0.001);
  EXPECT_NEAR(filter.state()[1], 0.0, 0.01);
}

TEST(RowCameraFilter, LeavesOutMarksFarFromAnyRowAndBeyondTheirEnds) {
  RowCameraFilter filter({}, two_rows());
  filter.start({0.0, 0.0, 0.0});
  EXPECT_EQ(filter.correct({{{2.0, 0.5}, Vector2d::Zero()}}, filter.state()), 0);
  EXPECT_EQ(filter.correct({{{105.0, 1.25}, Vector2d::Zero()}}, filter.state()), 0);
  EXPECT_EQ(filter.correct({}, filter.state()), 0);
}

}  // namespace
}  // namespace vinerow::controllers::row_marks_test

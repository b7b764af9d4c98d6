/// Marks of rows in pictures that are drawn by the lens's formula, and the filter that uses them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "controllers/estimation/row_camera/row_camera_filter.h"
#include "controllers/estimation/row_camera/row_marks.h"
#include "engine/api/surface.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"

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
  const std::vector<RowMark>& found = marks.find(labels);
  EXPECT_EQ(found.size(), static_cast<std::size_t>(drawn));
  for (const RowMark& mark : found) {
    EXPECT_EQ(mark.before_row_m, 0.0);
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
  EXPECT_TRUE(marks.find(labels).empty());
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
    EXPECT_EQ(marks.find(labels).size(), 40u * static_cast<std::size_t>(8 - foot_px)) << foot_px;
  }
}

TEST(RowMarks, FindTheBordersOfBareStripsInAnyLight) {
  RowMarksParams params;
  params.source = RowMarksParams::Source::kColours;
  for (const double light : {1.0, 0.3}) {
    Picture colours = empty_picture(Picture::Format::kRgb8);
    RandomStream random(1, "", "colours");
    for (int v = 0; v < 240; ++v) {
      for (int u = 0; u < 320; ++u) {
        const auto p = ground_at(u, v);
        const bool is_bare = p && std::min(std::abs(p->y() - 1.2), std::abs(p->y() + 1.3)) < 0.34;
        const double red = is_bare ? 140 : 95, green = is_bare ? 115 : 110;
        std::uint8_t* pixel = &colours.data[3 * (static_cast<std::size_t>(v) * 320 + u)];
        pixel[0] = static_cast<std::uint8_t>(light * (red + 3.0 * random.normal()));
        pixel[1] = static_cast<std::uint8_t>(light * (green + 3.0 * random.normal()));
      }
    }
    RowMarks marks(params, mounting(), kHeight_m);
    marks.set_camera(camera());
    const std::vector<RowMark>& found = marks.find(colours);
    ASSERT_GT(found.size(), 50u);
    int good = 0;
    for (const RowMark& mark : found) {
      const double off_m =
          std::min(std::abs(mark.p_B.y() - (1.2 - 0.34)), std::abs(mark.p_B.y() + 1.3 - 0.34));
      if (off_m < 0.06) ++good;
    }
    EXPECT_GT(good, 0.95 * static_cast<double>(found.size())) << light;
  }
}

TEST(RowMarks, IgnorePicturesOfAnotherSize) {
  RowMarks marks({}, mounting(), kHeight_m);
  EXPECT_TRUE(marks.find(empty_picture(Picture::Format::kMono8)).empty());
  marks.set_camera(camera());
  Picture other = empty_picture(Picture::Format::kMono8);
  other.width = 319;
  EXPECT_TRUE(marks.find(other).empty());
  EXPECT_TRUE(marks.find(empty_picture(Picture::Format::kRgb8)).empty());
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
      marks.push_back({{c * d.x() + s * d.y(), -s * d.x() + c * d.y()}, 0.0, Vector2d::Zero()});
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
  EXPECT_EQ(filter.correct({{{0.0, 1.15}, 0.0, Vector2d::Zero()}}, filter.state()), 1);
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
  EXPECT_EQ(filter.correct({{{2.0, 0.5}, 0.0, Vector2d::Zero()}}, filter.state()), 0);
  EXPECT_EQ(filter.correct({{{105.0, 1.25}, 0.0, Vector2d::Zero()}}, filter.state()), 0);
  EXPECT_EQ(filter.correct({}, filter.state()), 0);
}

}  // namespace
}  // namespace vinerow::controllers::row_marks_test

/// Directions chosen for sections of known polygons.

#include "worlds/mapping/hulls/section_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::mapping::section_directions_test {
namespace {

TEST(SectionDirections, UpperLevelLeavesOneInAHundredAbove) {
  std::vector<float> values;
  for (int k = 0; k < 500; ++k) values.push_back(static_cast<float>((k * 7) % 500));
  EXPECT_EQ(upper_level(values), 494.0f);  // 495 to 499 are above
  std::vector<float> few = {3.0f, 1.0f, 2.0f};
  EXPECT_EQ(upper_level(few), 3.0f);
}

/// Stretch of 4 slices with points on the outline of a polygon with the given corners.
RowStretch outline(const std::vector<Eigen::Vector2d>& corners) {
  RowStretch stretch;
  stretch.to_m = 1.0;
  stretch.first.push_back(0);
  for (int i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Eigen::Vector2d &a = corners[k], &b = corners[(k + 1) % corners.size()];
      // Not at the corners themselves: one point in a hundred is left out.
      for (int n = 0; n < 50; ++n) {
        const Eigen::Vector2d p = a + (b - a) * (n / 49.0);
        stretch.points.emplace_back(0.25f * (static_cast<float>(i) + 0.5f),
                                    static_cast<float>(p.x()), static_cast<float>(p.y()));
      }
    }
    stretch.first.push_back(stretch.points.size());
  }
  return stretch;
}

/// Area of the smallest section in these directions around the corners, over their own area.
double excess_of(const HullDirections& directions, const std::vector<Eigen::Vector2d>& corners,
                 double area_m2) {
  std::vector<double> h;
  for (int k = 0; k < directions.count(); ++k) {
    double most = -1e9;
    for (const Eigen::Vector2d& p : corners) most = std::max(most, directions.normal(k).dot(p));
    h.push_back(most);
  }
  return directions.area_m2(h.data()) / area_m2 - 1.0;
}

TEST(SectionDirections, AnOctagonKeepsItsOwnEight) {
  // Normals at multiples of 45 degrees, among the 32 candidates.
  std::vector<Eigen::Vector2d> corners;
  for (int k = 0; k < 8; ++k) {
    const double angle = (k + 0.5) * kPi / 4.0;
    corners.emplace_back(0.5 * std::cos(angle), 1.2 + 0.5 * std::sin(angle));
  }
  const HullDirections directions = choose_directions({outline(corners)}, 8);
  ASSERT_EQ(directions.count(), 8);
  const double area_m2 = 8.0 * 0.5 * 0.25 * std::sin(kPi / 4.0);
  EXPECT_NEAR(excess_of(directions, corners, area_m2), 0.0, 1e-6);
}

TEST(SectionDirections, AWallKeepsItsFourSidesAmongTheEight) {
  const std::vector<Eigen::Vector2d> corners = {{0.3, 0.6}, {0.3, 2.0}, {-0.3, 2.0}, {-0.3, 0.6}};
  for (const int count : {5, 8, 12}) {
    const HullDirections directions = choose_directions({outline(corners)}, count);
    ASSERT_EQ(directions.count(), count);
    EXPECT_NEAR(excess_of(directions, corners, 0.6 * 1.4), 0.0, 1e-6) << count;
  }
}

TEST(SectionDirections, AllStretchesCount) {
  // A wide flat box and an upright one that is turned by 45 degrees: eight sides in all.
  const double r = 0.4;
  const std::vector<Eigen::Vector2d> box = {{0.3, 0.6}, {0.3, 2.0}, {-0.3, 2.0}, {-0.3, 0.6}};
  const std::vector<Eigen::Vector2d> turned = {{r, 1.2}, {0.0, 1.2 + r}, {-r, 1.2}, {0.0, 1.2 - r}};
  const HullDirections directions = choose_directions({outline(box), outline(turned)}, 8);
  EXPECT_NEAR(excess_of(directions, box, 0.6 * 1.4), 0.0, 1e-6);
  EXPECT_NEAR(excess_of(directions, turned, 2.0 * r * r), 0.0, 1e-6);
}

/// The greedy choice by whole areas, instead of the triangle over each side: removes, one after the
/// other, the direction without which the polygon around the points is the smallest.
std::vector<double> chosen_by_area(const std::vector<Eigen::Vector2d>& points, int count) {
  std::vector<double> angles, h;
  for (int k = 0; k < 32; ++k) angles.push_back(2.0 * kPi * k / 32.0 - kPi);
  for (const double angle : angles) {
    double most = -1e9;
    for (const Eigen::Vector2d& p : points) {
      most = std::max(most, std::cos(angle) * p.x() + std::sin(angle) * p.y());
    }
    h.push_back(most);
  }
  while (static_cast<int>(angles.size()) > count) {
    double min_m2 = 1e9;
    std::size_t out = 0;
    const std::size_t n = angles.size();
    for (std::size_t k = 0; k < n; ++k) {
      // Sides that meet at a sharp angle are excluded, as in the code.
      const double turn = angles[(k + 1) % n] - angles[(k + n - 1) % n];
      if (turn + (turn < 0.0 ? 2.0 * kPi : 0.0) > 0.9 * kPi) continue;
      std::vector<double> fewer = angles, supports = h;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      supports.erase(supports.begin() + static_cast<std::ptrdiff_t>(k));
      const double area_m2 = HullDirections(fewer).area_m2(supports.data());
      if (area_m2 < min_m2) {
        min_m2 = area_m2;
        out = k;
      }
    }
    angles.erase(angles.begin() + static_cast<std::ptrdiff_t>(out));
    h.erase(h.begin() + static_cast<std::ptrdiff_t>(out));
  }
  return angles;
}

TEST(SectionDirections, AreThoseOfTheSmallestAreas) {
  // An egg without symmetry, in fewer than 100 points: none is left out as a stray.
  std::vector<Eigen::Vector2d> points;
  RowStretch stretch;
  stretch.to_m = 1.0;
  stretch.first.push_back(0);
  for (int k = 0; k < 96; ++k) {
    const double angle = 2.0 * kPi * k / 96.0;
    const double r = 0.5 + 0.06 * std::cos(angle) + 0.03 * std::sin(2.0 * angle + 0.3);
    const Eigen::Vector3f p(0.5f, static_cast<float>(r * std::cos(angle)),
                            static_cast<float>(1.2 + 0.7 * r * std::sin(angle)));
    stretch.points.push_back(p);
    points.emplace_back(p.y(), p.z());
  }
  stretch.first.push_back(stretch.points.size());
  for (const int count : {20, 12, 8, 6}) {
    const HullDirections directions = choose_directions({stretch}, count);
    ASSERT_EQ(directions.count(), count);
    const std::vector<double> wanted = chosen_by_area(points, count);
    for (int k = 0; k < count; ++k) {
      EXPECT_NEAR(directions.angle_rad(k), wanted[static_cast<std::size_t>(k)], 1e-9) << count;
    }
  }
}

}  // namespace
}  // namespace vinerow::mapping::section_directions_test

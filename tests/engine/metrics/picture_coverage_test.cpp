/// Coverage and overlap of pictures whose footprints are known in closed form.

#include "engine/metrics/picture_coverage.h"
#include "engine/api/map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/pose.h"

namespace vinerow::metrics::coverage_test {
namespace {

using Eigen::Vector3d;

constexpr double kHeight_m = 150.0, kAcross = 2.4 / 5.4, kAlong = 1.8 / 5.4;
constexpr double kWidth_m = 2 * kHeight_m * kAcross,
                 kLength_m = 2 * kHeight_m * kAlong;  // 133.3, 100

/// A picture over the plane z = slope_x x, by the pinhole model.
CameraShot picture(int index, const Vector3d& p_W, const RollPitchYaw& attitude,
                   double slope_x = 0) {
  CameraShot shot;
  shot.index = index;
  shot.X_WS = {quaternion_from_rpy(attitude) * quaternion_from_rpy({0, std::acos(-1.0) / 2, 0}),
               p_W};
  const auto meet = [&](const Vector3d& dir_S) {
    const Vector3d dir = shot.X_WS.q * dir_S;
    const double t = (p_W.z() - slope_x * p_W.x()) / (slope_x * dir.x() - dir.z());
    return Vector3d(p_W + t * dir);
  };
  shot.corners_W = {meet({1, kAcross, kAlong}), meet({1, -kAcross, kAlong}),
                    meet({1, -kAcross, -kAlong}), meet({1, kAcross, -kAlong})};
  shot.on_ground = true;
  shot.distance_m = (meet({1, 0, 0}) - p_W).norm();
  shot.gsd_m = 4.8 / 1280 / 5.4 * shot.distance_m;
  return shot;
}

struct Survey {
  std::vector<LaneShot> shots;
  RollPitchYaw attitude;
  int index = 0;

  /// Pictures along x at y, from x = from on, `step` apart.
  void lane(int number, double y, double from, double step, int count) {
    for (int i = 0; i < count; ++i) {
      shots.push_back({picture(index++, {from + i * step, y, kHeight_m}, attitude), number});
    }
    ++index;  // one between the lanes that nobody took
  }
};

Polygon box(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

double number(const CoverageMap& map, const char* name) {
  return map.numbers.at(name);
}

TEST(Coverage, OverlapAheadIsOneLessStepByLength) {
  Survey survey;
  survey.lane(0, 0, 0, 12, 20);
  const CoverageMap map = map_coverage(survey.shots, {box(0, -20, 200, 20), 1.0, 0.85});
  EXPECT_NEAR(number(map, "forward_overlap_min"), 1 - 12.0 / kLength_m, 1e-12);
  EXPECT_NEAR(number(map, "forward_overlap_mean"), 0.88, 1e-12);
  EXPECT_EQ(number(map, "shots"), 20);
  EXPECT_EQ(number(map, "shots_off_ground"), 0);
  EXPECT_NEAR(number(map, "gsd_mean_m"), 0.1041666667, 1e-9);
  EXPECT_NEAR(number(map, "gsd_formula_error_max"), 0.0, 1e-12);
  EXPECT_TRUE(std::isnan(number(map, "side_overlap_mean"))) << "one lane has no neighbour";
}

TEST(Coverage, OverlapIsAShareOfTheEarlierPicture) {
  // Half as high: half as long and wide, and within the first one.
  std::vector<LaneShot> shots = {{picture(0, {0, 0, kHeight_m}, {}), 0},
                                 {picture(1, {10, 0, 0.5 * kHeight_m}, {}), 0}};
  const Polygon parcel = box(-20, -20, 20, 20);
  EXPECT_NEAR(number(map_coverage(shots, {parcel, 1.0, 0.85}), "forward_overlap_min"), 0.25, 1e-12);
  std::swap(shots[0].shot, shots[1].shot);
  std::swap(shots[0].shot.index, shots[1].shot.index);
  EXPECT_NEAR(number(map_coverage(shots, {parcel, 1.0, 0.85}), "forward_overlap_min"), 1.0, 1e-12);
}

TEST(Coverage, OverlapAtTheLimitCounts) {
  Survey survey;
  survey.lane(0, 0, 0, 15, 15);  // exactly 85 %, up to rounding
  const Polygon parcel = box(20, -20, 180, 20);
  EXPECT_EQ(number(map_coverage(survey.shots, {parcel, 1.0, 0.85}), "overlap_covered_share"), 1.0);
  EXPECT_EQ(number(map_coverage(survey.shots, {parcel, 1.0, 0.86}), "overlap_covered_share"), 0.0);
}

TEST(Coverage, SideOverlapIsOneLessSpacingByWidth) {
  Survey survey;
  // Lanes by number in the order they are flown, which skips; pictures are not abreast.
  survey.lane(0, 0, 0, 12, 20);
  survey.lane(1, 90, 5, 12, 20);
  survey.lane(2, 45, -3, 12, 21);
  const CoverageMap map = map_coverage(survey.shots, {box(0, 0, 200, 90), 1.0, 0.85});
  EXPECT_NEAR(number(map, "side_overlap_mean"), 1 - 45.0 / kWidth_m, 1e-12);
  EXPECT_NEAR(number(map, "side_overlap_min"), 0.6625, 1e-12);
}

TEST(Coverage, CellsAreCountedByHand) {
  Survey survey;
  survey.lane(0, 0, 0, 40, 3);  // sees x from -50 to 130: twice between -10 and 90
  const CoverageMap map = map_coverage(survey.shots, {box(-100, -50, 100, 50), 1.0, 0.6});
  EXPECT_EQ(map.columns, 200);
  EXPECT_EQ(map.rows, 100);
  // One picture alone: -50 to -10. Two: -10 to 30 (first two) and 50 to 90. Three: 30 to 50.
  EXPECT_DOUBLE_EQ(number(map, "covered_share"), 150.0 / 200);
  EXPECT_DOUBLE_EQ(number(map, "covered_twice_share"), 100.0 / 200);
  EXPECT_DOUBLE_EQ(number(map, "covered_three_times_share"), 20.0 / 200);
  // Pairs with 60 % see -10 to 50 and 30 to 90.
  EXPECT_DOUBLE_EQ(number(map, "overlap_covered_share"), 100.0 / 200);
  EXPECT_EQ(map.pictures[map.cell(60, 50)], 1);   // x = -39.5
  EXPECT_EQ(map.pictures[map.cell(140, 50)], 3);  // x = 40.5
  EXPECT_EQ(map.pictures[map.cell(20, 50)], 0);
  EXPECT_EQ(map.forward_overlap[map.cell(60, 50)], 0.0f);
  EXPECT_FLOAT_EQ(map.forward_overlap[map.cell(140, 50)], 0.6f);
}

TEST(Coverage, OneWeakPairIsNotHeldButCovered) {
  Survey survey;
  for (const double x : {0.0, 12.0, 24.0, 54.0, 66.0, 78.0}) survey.lane(0, 0, x, 1, 1);
  for (std::size_t i = 0; i < survey.shots.size(); ++i) {
    survey.shots[i].shot.index = static_cast<int>(i);
  }
  const CoverageMap map = map_coverage(survey.shots, {box(0, -20, 80, 20), 1.0, 0.85});
  EXPECT_NEAR(number(map, "forward_overlap_min"), 0.7, 1e-12);
  // Pairs of 88 % see -38 to 62 and 16 to 116; that of 70 % sees 4 to 74.
  EXPECT_EQ(number(map, "overlap_covered_share"), 1.0);
  EXPECT_DOUBLE_EQ(number(map, "overlap_held_share"), 10.0 / 80);
  EXPECT_FLOAT_EQ(map.forward_overlap[map.cell(3, 20)], 0.88f);
  EXPECT_FLOAT_EQ(map.forward_overlap[map.cell(4, 20)], 0.7f);
  EXPECT_FLOAT_EQ(map.forward_overlap[map.cell(73, 20)], 0.7f);
  EXPECT_FLOAT_EQ(map.forward_overlap[map.cell(74, 20)], 0.88f);
  // A second lane over the same ground that holds it makes up for the first.
  survey.index = 10;
  survey.lane(1, 0, 0, 13, 7);
  const CoverageMap both = map_coverage(survey.shots, {box(0, -20, 80, 20), 1.0, 0.85});
  EXPECT_EQ(number(both, "overlap_held_share"), 1.0);
  EXPECT_FLOAT_EQ(both.forward_overlap[both.cell(40, 20)], 0.87f);
}

TEST(Coverage, OnlyWhatLiesInTheParcelCounts) {
  Survey survey;
  survey.lane(0, 0, 0, 12, 5);
  // A triangle with its right angle at the origin.
  const CoverageMap map = map_coverage(survey.shots, {{{0, 0}, {40, 0}, {0, 40}}, 0.5, 0.85});
  EXPECT_EQ(map.pictures[map.cell(79, 79)], -1);
  EXPECT_EQ(map.forward_overlap[map.cell(79, 79)], -1.0f);
  EXPECT_EQ(map.pictures[map.cell(10, 10)], 5);
  int inside = 0;
  for (const std::int32_t count : map.pictures) inside += count >= 0;
  EXPECT_NEAR(inside * 0.25, 800.0, 0.5 * 40 * 0.5 + 1e-9) << "half a cell along the long side";
  EXPECT_EQ(number(map, "covered_share"), 1.0);
}

TEST(Coverage, ABankedCamerasOverlapIsThatOfItsTrapezoid) {
  Survey survey;
  const double roll = 0.25, step = 14.0;
  survey.attitude = {roll, 0, 0};
  survey.lane(0, 0, 0, step, 10);
  // Half lengths of the trapezoid at its left and right edge; slices at every y overlap by
  // 2 X(y) - step, whose mean over y is linear: 1 - step / (X_left + X_right).
  const double left = kHeight_m * kAlong / (std::cos(roll) - kAcross * std::sin(roll));
  const double right = kHeight_m * kAlong / (std::cos(roll) + kAcross * std::sin(roll));
  const CoverageMap map = map_coverage(survey.shots, {box(-50, -100, 200, 100), 1.0, 0.85});
  EXPECT_NEAR(number(map, "forward_overlap_min"), 1 - step / (left + right), 1e-12);
  EXPECT_NEAR(number(map, "forward_overlap_mean"), 1 - step / (left + right), 1e-12);
  // Seen along a slanting axis the ground is farther than straight down from the same height.
  EXPECT_NEAR(number(map, "gsd_formula_error_max"), 1 / std::cos(roll) - 1, 1e-12);
  EXPECT_NEAR(number(map, "gsd_mean_m"), 4.8 / 1280 / 5.4 * kHeight_m / std::cos(roll), 1e-12);
}

TEST(Coverage, APitchedCamerasOverlapIsThatOfItsTrapezoid) {
  const double up = 0.2, step = 12.0;
  Survey survey;
  survey.attitude = {0, -up, 0};
  survey.lane(0, 0, 0, step, 2);
  // Seen from above the sides converge: half width c + s x between x0 and x1. The common part runs
  // from x0 + step to x1; there the later picture, which is displaced by one step, is narrower.
  const double alpha = std::atan(kAlong);
  const double x0 = kHeight_m * std::tan(up - alpha), x1 = kHeight_m * std::tan(up + alpha);
  const double half0 = kHeight_m * kAcross / (std::cos(up) + kAlong * std::sin(up));
  const double half1 = kHeight_m * kAcross / (std::cos(up) - kAlong * std::sin(up));
  const double slope = (half1 - half0) / (x1 - x0);
  const double common = (x1 - step - x0) * (half0 + half0 + slope * (x1 - step - x0));
  const double whole = (x1 - x0) * (half0 + half1);
  const CoverageMap map = map_coverage(survey.shots, {box(x0, -20, x1, 20), 1.0, 0.85});
  EXPECT_NEAR(number(map, "forward_overlap_min"), common / whole, 1e-12);
}

TEST(Coverage, FlightAlongASlopeKeepsTheLevelOverlap) {
  // Climbing with the ground at constant height above it, looking straight down, every footprint is
  // the same: from x - L/(1 - s t) to x + L/(1 + s t), with half widths W/(1 -+ s t).
  const double s = 0.25, step = 12.0;
  std::vector<LaneShot> shots;
  for (int i = 0; i < 8; ++i) {
    shots.push_back({picture(i, {i * step, 0, kHeight_m + s * i * step}, {}, s), 0});
  }
  const double x0 = -kHeight_m * kAlong / (1 - s * kAlong),
               x1 = kHeight_m * kAlong / (1 + s * kAlong);
  const double half0 = kHeight_m * kAcross / (1 - s * kAlong);
  const double half1 = kHeight_m * kAcross / (1 + s * kAlong);
  // The later picture is wider where both see the ground.
  const double at = half0 + (half1 - half0) * step / (x1 - x0);
  const double common = (x1 - x0 - step) * (at + half1), whole = (x1 - x0) * (half0 + half1);
  const CoverageMap map = map_coverage(shots, {box(0, -20, 50, 20), 1.0, 0.85});
  EXPECT_NEAR(number(map, "forward_overlap_min"), common / whole, 1e-12);
  EXPECT_NEAR(number(map, "forward_overlap_mean"), common / whole, 1e-12);
  EXPECT_NEAR(number(map, "gsd_formula_error_max"), 0.0, 1e-12);
}

TEST(Coverage, PairsBelongToOneLane) {
  Survey survey;
  survey.lane(0, 0, 0, 12, 5);
  survey.lane(1, 45, 0, 12, 5);
  survey.shots[7].lane = -1;               // off the lane
  survey.shots[2].shot.on_ground = false;  // saw the sky
  const CoverageMap map = map_coverage(survey.shots, {box(0, 0, 48, 45), 1.0, 0.85});
  EXPECT_EQ(number(map, "shots"), 10);
  EXPECT_EQ(number(map, "shots_off_ground"), 1);
  // Left: pictures 0-1 and 3-4 of the first lane, 0-1 and 3-4 of the second: all of 88 %.
  EXPECT_NEAR(number(map, "forward_overlap_min"), 0.88, 1e-12);
  // Two pictures of different lanes in a row are no pair either.
  survey.shots = {{picture(0, {0, 0, 150}, {}), 0}, {picture(1, {0, 45, 150}, {}), 1}};
  EXPECT_TRUE(std::isnan(
      number(map_coverage(survey.shots, {box(0, 0, 48, 45), 1.0, 0.85}), "forward_overlap_min")));
}

TEST(Coverage, PicturesBesideTheParcelSayNothingOfIt) {
  Survey survey;
  survey.lane(0, 0, 0, 12, 5);
  survey.lane(1, 0, 1000, 60, 5);
  const CoverageMap map = map_coverage(survey.shots, {box(0, -20, 48, 20), 1.0, 0.85});
  EXPECT_NEAR(number(map, "forward_overlap_min"), 0.88, 1e-12);
  EXPECT_EQ(number(map, "shots"), 10);
}

TEST(Coverage, NoPicturesCoverNothing) {
  const CoverageMap map = map_coverage({}, {box(0, 0, 10, 10), 1.0, 0.85});
  EXPECT_EQ(number(map, "covered_share"), 0.0);
  EXPECT_EQ(number(map, "overlap_covered_share"), 0.0);
  EXPECT_TRUE(std::isnan(number(map, "gsd_mean_m")));
  for (const ResultSpec& number : coverage_results()) {
    EXPECT_TRUE(map.numbers.contains(number.name)) << number.name;
  }
  EXPECT_EQ(map.numbers.size(), coverage_results().size());
}

void refuse(const CoverageOptions& options, const std::string& sentence) {
  try {
    check_coverage_options(options);
    FAIL() << "not refused: " << sentence;
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.what(), sentence);
  }
}

TEST(Coverage, RefusesBadParcels) {
  refuse({{{0, 0}, {1, 0}}, 1.0, 0.85}, "the parcel has 2 corners, must be at least 3");
  refuse({{{0, 0}, {20, 20}, {20, 0}, {0, 20}}, 1.0, 0.85},
         "the parcel crosses itself: its edge from (0, 0) m meets the edge from (20, 0) m");
  refuse({box(0, 0, 1000, 1000), 0.1, 0.85},
         "cell_m = 0.1 m gives 100 million cells, must be at most 25 million");
}

}  // namespace
}  // namespace vinerow::metrics::coverage_test

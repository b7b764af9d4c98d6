#include "controllers/parts/paths/dubins.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::controllers::dubins_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Pose2 random_pose(RandomStream& random, double size_m) {
  const double x = random.uniform(-size_m, size_m), y = random.uniform(-size_m, size_m);
  return {{x, y}, random.uniform(-kPi, kPi)};
}

double turn_to(double from, double to, double side) {
  const double turn = std::fmod(side * (to - from), 2.0 * kPi);
  return turn < 0.0 ? turn + 2.0 * kPi : turn;
}

/// Shortest path of a word by search: the first turn is scanned, the last follows from the
/// headings, and what is left is one equation in the first turn, whose sign changes are bisected.
/// Knows nothing of tangents.
struct BruteForce {
  Pose2 start, goal;
  double radius;
  std::array<double, 3> sides;  // +1 left, 0 straight, -1 right

  struct Try {
    double gap = kInfinity;     // signed: zero where the path meets the goal
    double length = kInfinity;  // infinity: not a path
  };

  Try evaluate(double first) const {
    const Pose2 after = advance(start, radius * first, sides[0] * first);
    const Eigen::Vector2d last_centre =
        goal.p + sides[2] * radius * left_of(direction(goal.yaw_rad));
    Try result;
    if (sides[1] == 0.0) {
      const double last = turn_to(after.yaw_rad, goal.yaw_rad, sides[2]);
      const Eigen::Vector2d to_circle =
          last_centre - sides[2] * radius * left_of(direction(after.yaw_rad)) - after.p;
      result.gap = cross(direction(after.yaw_rad), to_circle);
      const double straight = to_circle.dot(direction(after.yaw_rad));
      if (straight > -1e-9) result.length = radius * (first + last) + straight;
      return result;
    }
    const Eigen::Vector2d middle_centre =
        after.p + sides[1] * radius * left_of(direction(after.yaw_rad));
    const Eigen::Vector2d between = last_centre - middle_centre;
    result.gap = between.norm() - 2.0 * radius;
    const double heading = std::atan2(between.y(), between.x()) + sides[1] * 0.5 * kPi;
    result.length = radius * (first + turn_to(after.yaw_rad, heading, sides[1]) +
                              turn_to(heading, goal.yaw_rad, sides[2]));
    return result;
  }

  double shortest() const {
    constexpr int kSteps = 720;
    double best = kInfinity;
    Try low = evaluate(0.0);
    for (int i = 0; i < kSteps; ++i) {
      double a = 2.0 * kPi * i / kSteps, b = 2.0 * kPi * (i + 1) / kSteps;
      const Try high = evaluate(b);
      if ((low.gap <= 0.0) != (high.gap <= 0.0) || std::abs(low.gap) < 1e-12) {
        const bool rises = high.gap > low.gap;
        for (int k = 0; k < 50; ++k) {
          const double middle = 0.5 * (a + b);
          ((evaluate(middle).gap <= 0.0) == rises ? a : b) = middle;
        }
        for (const double first : {a, b}) {
          const Try found = evaluate(first);
          if (std::abs(found.gap) < 1e-9 * radius) best = std::min(best, found.length);
        }
      }
      low = high;
    }
    return best;
  }
};

std::array<double, 3> sides_of(DubinsWord word) {
  std::array<double, 3> sides{};
  for (int i = 0; i < 3; ++i) {
    const char c = to_string(word)[i];
    sides[i] = c == 'L' ? 1.0 : c == 'R' ? -1.0 : 0.0;
  }
  return sides;
}

double gap_at_end(const Pose2& start, const Pose2& goal, const DubinsPath& path) {
  const Pose2 end = pose_on_dubins(start, path, path.length_m());
  return (end.p - goal.p).norm() + std::abs(wrap_angle(end.yaw_rad - goal.yaw_rad));
}

TEST(Dubins, EveryWordThatExistsEndsAtTheGoal) {
  RandomStream random(1, "test", "dubins");
  for (int i = 0; i < 10000; ++i) {
    const Pose2 start = random_pose(random, 5.0), goal = random_pose(random, 5.0);
    const double radius = random.uniform(0.2, 3.0);
    bool has_any = false;
    for (const DubinsWord word : kDubinsWords) {
      const DubinsPath path = calc_dubins_word(start, goal, radius, word);
      if (!path.exists) continue;
      has_any = true;
      // Rounding of a few metres' path; snapping a turn of almost 360 deg to none costs 1e-9 rad.
      EXPECT_LT(gap_at_end(start, goal, path), 2e-8) << to_string(word);
    }
    EXPECT_TRUE(has_any);
  }
}

TEST(Dubins, EqualsTheBruteForceSearchOverAllWords) {
  RandomStream random(2, "test", "dubins");
  int worse = 0;
  for (int i = 0; i < 400; ++i) {
    const Pose2 start = random_pose(random, 3.0), goal = random_pose(random, 3.0);
    const double radius = random.uniform(0.3, 2.0);
    double best = kInfinity;
    for (const DubinsWord word : kDubinsWords) {
      best = std::min(best, BruteForce{start, goal, radius, sides_of(word)}.shortest());
    }
    const double length = calc_dubins(start, goal, radius).length_m();
    // The search may miss a double root (a path that just touches), never the other way round.
    EXPECT_LE(length, best + 1e-6);
    if (length < best - 1e-6) ++worse;
  }
  EXPECT_LE(worse, 2);
}

TEST(Dubins, LengthIsTheSameMirroredReversedAndMoved) {
  RandomStream random(3, "test", "dubins");
  for (int i = 0; i < 10000; ++i) {
    const Pose2 start = random_pose(random, 4.0), goal = random_pose(random, 4.0);
    const double radius = random.uniform(0.2, 3.0);
    const double length = calc_dubins(start, goal, radius).length_m();
    const double tolerance = 1e-9 * (length + radius);  // rounding of angles times lengths
    const auto mirrored = [](const Pose2& p) { return Pose2{{p.p.x(), -p.p.y()}, -p.yaw_rad}; };
    EXPECT_NEAR(calc_dubins(mirrored(start), mirrored(goal), radius).length_m(), length, tolerance);
    const auto reversed = [](const Pose2& p) { return Pose2{p.p, p.yaw_rad + kPi}; };
    EXPECT_NEAR(calc_dubins(reversed(goal), reversed(start), radius).length_m(), length, tolerance);
    const double angle = random.uniform(-kPi, kPi);
    const auto moved = [angle](const Pose2& p) {
      return Pose2{Eigen::Rotation2Dd(angle) * p.p + Eigen::Vector2d(3.0, -2.0), p.yaw_rad + angle};
    };
    EXPECT_NEAR(calc_dubins(moved(start), moved(goal), radius).length_m(), length, tolerance);
  }
}

TEST(Dubins, EqualPosesNeedNoPath) {
  for (const double yaw : {0.0, 0.3, kPi, -kPi, 2.0}) {
    const Pose2 pose = {{1.0, 2.0}, yaw};
    EXPECT_NEAR(calc_dubins(pose, pose, 1.5).length_m(), 0.0, 1e-9);
  }
}

TEST(Dubins, StraightAheadIsStraight) {
  const DubinsPath path = calc_dubins({{0, 0}, 0}, {{7, 0}, 0}, 2.0);
  EXPECT_NEAR(path.length_m(), 7.0, 1e-12);
}

TEST(Dubins, HeadingOfExactlyPiIsASemicircle) {
  for (const double yaw : {kPi, -kPi}) {
    const Pose2 start = {{0, 0}, 0}, goal = {{0, 5}, yaw};
    const DubinsPath path = calc_dubins(start, goal, 2.5);
    EXPECT_NEAR(path.length_m(), 2.5 * kPi, 1e-9);
    EXPECT_LT(gap_at_end(start, goal, path), 1e-8);
  }
}

TEST(Dubins, WideHeadlandTurnHasAStraightPiece) {
  // Paper B's alleys, 10 m apart, with radius 1: a quarter, 8 m, a quarter.
  const DubinsPath path = calc_dubins({{5, 90}, 0.5 * kPi}, {{15, 90}, -0.5 * kPi}, 1.0);
  EXPECT_EQ(path.word, DubinsWord::kRSR);
  EXPECT_NEAR(path.length_m(), 8.0 + kPi, 1e-9);
}

TEST(Dubins, NarrowHeadlandTurnIsALoop) {
  // Alleys 2 m apart with radius 2: out left, round right, back left. The outer circles' centres
  // are 6 m apart, the middle one's 4 m from either: a triangle with the angle acos(3/4) at its
  // base.
  const DubinsPath path = calc_dubins({{0, 0}, 0.5 * kPi}, {{2, 0}, -0.5 * kPi}, 2.0);
  EXPECT_EQ(path.word, DubinsWord::kLRL);
  const double side = std::acos(3.0 / 4.0);
  EXPECT_NEAR(path.length_m(), 2.0 * (side + (kPi + 2.0 * side) + side), 1e-9);
}

}  // namespace
}  // namespace vinerow::controllers::dubins_test

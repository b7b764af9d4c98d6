/// The jet's way against integrated equations of motion; leaves against Beer's law.

#include "vehicles/payloads/spray_jet.h"
#include "engine/core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/physics/world_scene.h"
#include "tests/vehicles/payloads/payload_rig.h"

namespace vinerow::vehicles::spray_jet_test {
namespace {

using namespace test;
using Eigen::Vector3d;

SprayParams quiet() {
  SprayParams params;
  params.settling_mps = 0.0;
  params.loss_length_m = 1e12;
  return params;
}

/// dp/dt = w - s z + U e d / (d + x), dx/dt = U d / (d + x): midpoint rule, small steps.
TEST(SprayJet, FollowsItsEquationOfMotion) {
  SprayParams params;
  const Vector3d start(1.0, 2.0, 1.5), nozzle(0.0, 0.8, 0.6), v(1.5, 0.0, 0.0),
      wind(2.0, -3.0, 0.1);
  const Vector3d u0 = params.jet_speed_mps * nozzle + v - wind;
  const double speed = u0.norm();
  const Vector3d e = u0 / speed, carried = wind - Vector3d(0.0, 0.0, params.settling_mps);
  Vector3d p = start;
  double x = 0.0, t = 0.0;
  constexpr double kStep_s = 1e-5;
  while (x < 3.0) {
    const auto rate = [&](double at) {
      return speed * params.jet_decay_m / (params.jet_decay_m + at);
    };
    const double middle = rate(x + 0.5 * kStep_s * rate(x));
    p += kStep_s * (carried + middle * e);
    x += kStep_s * middle;
    t += kStep_s;
  }
  const SprayJet jet(params, start, nozzle, v, wind);
  EXPECT_NEAR(jet.time_s(x), t, 1e-6);
  EXPECT_LT((jet.at(x) - p).norm(), 1e-5);
}

TEST(SprayJet, BlowsAlongWithTheWindAndBackFromDriving) {
  const SprayParams params = quiet();
  const Vector3d ahead = SprayJet(params, {0, 0, 1}, {0, 1, 0}, {0, 0, 0}, {3, 0, 0}).at(2.0);
  EXPECT_GT(ahead.x(), 0.2);
  const Vector3d with = SprayJet(params, {0, 0, 1}, {0, 1, 0}, {0, 0, 0}, {0, 3, 0}).at(2.0);
  EXPECT_GT(with.y(), 2.2);
  // Still air: the jet keeps the nozzle's motion as its direction against the air.
  const Vector3d driven = SprayJet(params, {0, 0, 1}, {0, 1, 0}, {2, 0, 0}, {0, 0, 0}).at(2.0);
  EXPECT_NEAR(driven.x() / driven.y(), 2.0 / 25.0, 1e-12);
  // A wind that goes with the vehicle is still air to it.
  const SprayJet carried(params, {0, 0, 1}, {0, 1, 0}, {2, 0, 0}, {2, 0, 0});
  EXPECT_NEAR(carried.at(2.0).x(), 2.0 * carried.time_s(2.0), 1e-12);
}

struct Traced {
  SprayFate fate;
  std::vector<std::pair<Vector3d, double>> deposits;
  double deposited() const {
    double sum = 0.0;
    for (const auto& [p, ml] : deposits) sum += ml;
    return sum;
  }
};

/// Leaves of 4 m2/m3: k = 2 per metre.
Traced trace(const WorldModel& world, const SprayParams& params, const Vector3d& p_W,
             const Vector3d& direction_W, const Vector3d& wind_W = Vector3d::Zero(),
             const LeafAreaDensity& leaves = LeafAreaDensity(4.0)) {
  const physics::WorldScene scene(world);
  Traced result;
  const SprayJet jet(params, p_W, direction_W, Vector3d::Zero(), wind_W);
  result.fate = trace_spray(scene, leaves, params, jet, 10.0, [&](const Vector3d& p, double ml) {
    result.deposits.emplace_back(p, ml);
  });
  return result;
}

TEST(TraceSpray, LeavesCatchByBeersLawOnBothFaces) {
  const SprayParams params = quiet();
  const WorldModel world = make_box_rows({{.y_m = 1.0}});
  const Traced traced = trace(world, params, {10, 0, 1}, {0, 1, 0});
  EXPECT_NEAR(traced.fate.canopy_ml, 10.0 * (1.0 - std::exp(-1.0)), 5e-3);
  EXPECT_NEAR(traced.fate.lost_ml, 10.0 * std::exp(-1.0), 5e-3);
  EXPECT_EQ(traced.fate.ground_ml, 0.0);
  ASSERT_EQ(traced.deposits.size(), 2u);
  EXPECT_NEAR(traced.deposits[0].first.y(), 0.75, 1e-6);
  EXPECT_NEAR(traced.deposits[1].first.y(), 1.25, 1e-3);
  EXPECT_NEAR(traced.deposits[0].second, 10.0 * (1.0 - std::exp(-0.5)), 5e-3);
}

TEST(TraceSpray, WhatPassesOneRowReachesTheNext) {
  const SprayParams params = quiet();
  const WorldModel world = make_box_rows({{.y_m = 1.0}, {.y_m = 3.0}});
  const Traced traced = trace(world, params, {10, 0, 1}, {0, 1, 0});
  ASSERT_EQ(traced.deposits.size(), 4u);
  EXPECT_NEAR(traced.deposits[2].first.y(), 2.75, 1e-6);
  EXPECT_NEAR(traced.fate.canopy_ml, 10.0 * (1.0 - std::exp(-2.0)), 1e-2);
}

TEST(TraceSpray, EachRowCatchesByItsOwnLeaves) {
  // 3 m2/m3, then what a row has that does not state its leaves: 6. Chords of 0.5 m.
  const SprayParams params = quiet();
  WorldModel world = make_box_rows({{.y_m = 1.0}, {.y_m = 3.0}});
  world.meshes[0].foliage = Foliage{3.0};
  const Traced traced =
      trace(world, params, {10, 0, 1}, {0, 1, 0}, Vector3d::Zero(), LeafAreaDensity(world));
  ASSERT_EQ(traced.deposits.size(), 4u);
  const double first = 10.0 * (1.0 - std::exp(-0.5 * 3.0 * 0.5));
  EXPECT_NEAR(traced.deposits[0].second + traced.deposits[1].second, first, 5e-3);
  EXPECT_NEAR(traced.deposits[2].second + traced.deposits[3].second,
              (10.0 - first) * (1.0 - std::exp(-0.5 * 6.0 * 0.5)), 1e-2);
}

TEST(TraceSpray, GroundPostsAndAirGetTheRest) {
  const SprayParams params = quiet();
  WorldModel world = make_box_rows({{.y_m = 1.0}});
  const auto fate = [&](const Vector3d& direction) {
    return trace(world, params, {10, 0, 1}, direction.normalized()).fate;
  };
  EXPECT_NEAR(fate({0, 0.3, -1}).ground_ml, 10.0, 1e-9);
  EXPECT_NEAR(fate({0, 0.3, 1}).lost_ml, 10.0, 1e-9);
  world.meshes[0].surface = SurfaceClass::kPost;
  EXPECT_NEAR(fate({0, 1, 0}).ground_ml, 10.0, 1e-9);
}

TEST(TraceSpray, LosesAShareByTheMetre) {
  SprayParams params = quiet();
  params.loss_length_m = 15.0;
  WorldModel world = make_box_rows({{.y_m = 1.9}});
  world.meshes[0].surface = SurfaceClass::kObstacle;  // face 1.65 m away
  const Traced traced = trace(world, params, {10, 0, 1}, {0, 1, 0});
  EXPECT_NEAR(traced.fate.ground_ml, 10.0 * std::exp(-1.65 / 15.0), 1e-6);
  EXPECT_NEAR(traced.fate.lost_ml + traced.fate.ground_ml, 10.0, 1e-12);
}

TEST(TraceSpray, NothingIsMadeOrForgotten) {
  const SprayParams params;
  const WorldModel world = make_box_rows({{.y_m = 1.0}, {.y_m = 3.0}, {.y_m = -1.0}});
  RandomStream random(9, "", "test");
  for (int n = 0; n < 2000; ++n) {
    const Vector3d direction =
        Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const Vector3d wind(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-1, 1));
    const Traced traced =
        trace(world, params, {random.uniform(-1, 21), 0, random.uniform(0.1, 3)}, direction, wind);
    const SprayFate& fate = traced.fate;
    ASSERT_NEAR(fate.canopy_ml + fate.ground_ml + fate.lost_ml, 10.0, 1e-11);
    ASSERT_NEAR(traced.deposited(), fate.canopy_ml, 1e-11);
    ASSERT_GE(std::min({fate.canopy_ml, fate.ground_ml, fate.lost_ml}), 0.0);
  }
}

/// Where a straight jet crosses the wind, the walked way ends where the equation says.
TEST(TraceSpray, HitsAWallWhereTheWindTakesTheJet) {
  SprayParams params = quiet();
  WorldModel world = make_box_rows({{.y_m = 1.25}});
  const Vector3d wind(4.0, 0.0, 0.0);
  const Traced traced = trace(world, params, {10, 0, 1}, {0, 1, 0}, wind);
  ASSERT_FALSE(traced.deposits.empty());
  const SprayJet jet(params, {10, 0, 1}, {0, 1, 0}, Vector3d::Zero(), wind);
  double x = 0.0;
  while (jet.at(x).y() < 1.0) x += 1e-5;  // the wall's face, 1 cm behind a joint of the way
  EXPECT_NEAR(traced.deposits[0].first.x(), jet.at(x).x(), 3e-3);
}

TEST(TraceSpray, AStormThatStopsTheJetIsNoTrouble) {
  const SprayParams params;
  const WorldModel world = make_box_rows({{.y_m = 1.0}});
  const Traced traced = trace(world, params, {10, 0, 1}, {0, 1, 0}, {0.0, 25.0, 0.0});
  EXPECT_TRUE(std::isfinite(traced.fate.canopy_ml));
  EXPECT_NEAR(traced.fate.canopy_ml + traced.fate.ground_ml + traced.fate.lost_ml, 10.0, 1e-11);
}

}  // namespace
}  // namespace vinerow::vehicles::spray_jet_test

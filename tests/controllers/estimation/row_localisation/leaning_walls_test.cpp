// A map whose walls lean where the true ones do not: its echoes are all wrong the same way.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "controllers/estimation/row_localisation/map_localisation_law.h"
#include "engine/math/pose.h"
#include "tests/controllers/estimation/row_localisation/wall_map.h"

namespace vinerow::test::leaning_walls_test {
namespace {

constexpr double kLean_m = 0.15;     // that walls of the map are drawn in by at their top
constexpr double kThicker_m = 0.03;  // the true walls, which are upright, than the map's at 1 m
constexpr double kHeight_m = 1.0;    // of the vehicle, in the middle of the alley
constexpr double kFixStd_m = 0.02;

RowMap make_leaning_map() {
  const WallBlock block;
  RowMap map = make_wall_map(block);
  map.accuracy.surface_std_m = 0.02;
  for (RowMesh& mesh : map.meshes) {
    const float middle_m = static_cast<float>(mesh.row * block.pitch_m);
    for (Eigen::Vector3f& p : mesh.mesh_W.vertices) {
      if (p.z() > 1.0f) p.y() -= std::copysign(static_cast<float>(kLean_m), p.y() - middle_m);
    }
  }
  return map;
}

/// Half a minute at 1 m/s down the alley on fixes without error and echoes of the true walls.
/// @returns estimate less truth
Eigen::Vector3d drive(bool walls_correct_height) {
  const RowMap map = make_leaning_map();
  const controllers::RowMeshIndex index(map);
  controllers::MapLocalisationParams params;
  params.walls_correct_height = walls_correct_height;
  params.fix_slow_share = 0.5;
  const std::vector<controllers::RangeSensorModel> sensors = {
      {"left", {quaternion_from_rpy({0, 0, 0.5 * std::numbers::pi}), {0, 0, 0}}, 0.0, 1, 0.003},
      {"right", {quaternion_from_rpy({0, 0, -0.5 * std::numbers::pi}), {0, 0, 0}}, 0.0, 1, 0.003}};
  controllers::MapLocalisationLaw law(params, map, index, sensors);
  Eigen::Vector3d p_W(0.0, 1.25, kHeight_m);
  law.start(Time{}, p_W, 1e-4 * Eigen::Matrix3d::Identity());
  // The map is drawn in by kLean_m at 2 m, so by half of it at 1 m.
  const double true_range_m = 1.25 - (0.25 - 0.5 * kLean_m) - kThicker_m;
  for (int tick = 1; tick <= 3000; ++tick) {
    const Time now{static_cast<std::int64_t>(tick) * 10'000'000};
    p_W.x() += 0.01;
    law.predict(now, Eigen::Vector3d::UnitX(), Eigen::Quaterniond::Identity());
    if (tick % 20 == 0) {
      law.correct_fix(now, p_W, Eigen::Vector3d::Constant(kFixStd_m), Eigen::Vector3d::Zero());
    }
    if (tick % 5 == 0) {
      for (const int sensor : {0, 1}) law.correct_range(now, sensor, true_range_m, 0.05);
    }
  }
  EXPECT_GT(law.counters().echoes, 1000);
  return law.state().p_W() - p_W;
}

TEST(LeaningWalls, HeightIsLeftToWhatTellsItWhereAsked) {
  const Eigen::Vector3d trusting = drive(true), careful = drive(false);
  // Both walls stand 3 cm nearer than the map says: as if it flew 0.4 m lower, where the map's
  // alley is as narrow.
  EXPECT_LT(trusting.z(), -0.03);
  EXPECT_NEAR(careful.z(), 0.0, 1e-3);
  // What is wrong to both sides alike moves it to neither.
  EXPECT_NEAR(careful.y(), 0.0, 1e-3);
}

/// Variance that one echo of the left wall had, from what it left of the lateral variance:
/// 1 / r = 1 / P_after - 1 / P_before.
double echo_variance_m2(double height_variance_m2) {
  const RowMap map = make_leaning_map();
  const controllers::RowMeshIndex index(map);
  controllers::MapLocalisationParams params;
  params.walls_correct_height = false;
  const std::vector<controllers::RangeSensorModel> sensors = {
      {"left", {quaternion_from_rpy({0, 0, 0.5 * std::numbers::pi}), {0, 0, 0}}, 0.0, 1, 0.003}};
  controllers::MapLocalisationLaw law(params, map, index, sensors);
  const Eigen::Vector3d p_W(0.0, 1.25, kHeight_m);
  constexpr double kLateral_m2 = 0.04;
  law.start(Time{}, p_W,
            Eigen::Vector3d(1e-6, kLateral_m2, height_variance_m2).asDiagonal().toDenseMatrix());
  const Time now{10'000'000};
  law.predict(now, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity());
  EXPECT_EQ(law.filter_count(), 1);
  const double before_m2 = law.position_covariance()(1, 1);
  law.correct_range(now, 0, 1.25 - (0.25 - 0.5 * kLean_m), 0.05);
  EXPECT_EQ(law.counters().echoes, 1);
  EXPECT_NEAR(law.position_covariance()(2, 2), height_variance_m2, 1e-3 * height_variance_m2 + 1e-4)
      << "it tells no height";
  return 1.0 / (1.0 / law.position_covariance()(1, 1) - 1.0 / before_m2);
}

// The map's walls come in by kLean_m over their 2 m: an echo that may not correct the height is
// wrong by that slope times the height's error, and must say so.
TEST(LeaningWalls, AnEchoIsAsUncertainAsTheHeightThatItMustNotCorrect) {
  constexpr double kSlope = kLean_m / 2.0, kHeight_m2 = 1.0, kKnown_m2 = 1e-6;
  EXPECT_NEAR(echo_variance_m2(kHeight_m2) - echo_variance_m2(kKnown_m2),
              kSlope * kSlope * (kHeight_m2 - kKnown_m2), 0.02 * kSlope * kSlope);
}

}  // namespace
}  // namespace vinerow::test::leaning_walls_test

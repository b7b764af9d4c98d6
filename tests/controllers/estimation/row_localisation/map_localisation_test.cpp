// The bank of filters on the map in the reference world: what docs/papers/localisation.md says of
// it.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "engine/math/angles.h"
#include "tests/controllers/estimation/row_localisation/localisation_bench.h"
#include "tests/controllers/estimation/row_localisation/map_localisation_lab.h"
#include "tests/controllers/support/row_mesh_map.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::map_localisation_test {
namespace {

constexpr int kSeeds = 20;

LabScore run(const LabSetup& setup, const controllers::MapLocalisationParams& params = {},
             const std::function<bool(const LabSample&)>& counts = {}) {
  return study(setup, kSeeds, map_localisation(params), counts);
}

/// Six gaps of 1 m on both sides of the alley.
std::vector<Gap> some_gaps() {
  std::vector<Gap> gaps;
  for (int i = 0; i < 6; ++i) gaps.push_back({1 + i % 2, 10.0 + 12 * i, 11.0 + 12 * i});
  return gaps;
}

TEST(MapLocalisation, IsAccurateAndConsistentInTheNominalWorld) {
  const LabScore score = run({});
  EXPECT_LE(score.lateral_m, 0.018);
  EXPECT_LE(score.longitudinal_m, 0.11);
  EXPECT_GE(score.nees, 1.5);
  EXPECT_LE(score.nees, 2.4);
  EXPECT_GE(score.coverage, 0.93);
  EXPECT_EQ(score.lost, 0);
}

TEST(MapLocalisation, BearsConeMissedAndFalseEchoesSlowAndLateFixesTogether) {
  LabSetup setup;
  setup.cone_rad = 0.2618;
  setup.filter_fan_rays = 7;
  setup.missed_share = 0.3;
  setup.false_share = 0.2;
  setup.fix_time_s = 60.0;
  setup.fix_age = 20;
  const LabScore score = run(setup);
  EXPECT_LE(score.lateral_m, 0.025);
  EXPECT_LE(score.longitudinal_m, 0.15);
  EXPECT_GE(score.nees, 1.5);
  EXPECT_LE(score.nees, 2.4);
  EXPECT_GE(score.coverage, 0.92);
  EXPECT_EQ(score.lost, 0);
}

TEST(MapLocalisation, TenSecondsWithoutFixesInTheRow) {
  LabSetup setup;
  setup.outage_from_s = 30.0;
  setup.outage_to_s = 40.0;
  const LabScore score = run(setup, {}, [](const LabSample& sample) {
    return sample.time_s >= 30.0 && sample.time_s <= 40.0;
  });
  EXPECT_LE(score.lateral_m, 0.02);
  EXPECT_LE(score.longitudinal_m, 0.12);
}

TEST(MapLocalisation, MissingVinesInTruthOrMap) {
  LabSetup truth, map;
  truth.world.true_gaps = some_gaps();
  map.world.map_gaps = some_gaps();
  for (const LabSetup& setup : {truth, map}) {
    const LabScore score = run(setup);
    EXPECT_LE(score.lateral_m, 0.025);
    EXPECT_LE(score.longitudinal_m, 0.15);
    EXPECT_LE(score.nees, 2.4);
    EXPECT_EQ(score.lost, 0);
  }
  // What closes a run of plants must not be believed: with it the gaps in the map mislead.
  controllers::MapLocalisationParams believing;
  believing.max_along = 1.1;
  EXPECT_GT(run(map, believing).nees, 4.0);
}

TEST(MapLocalisation, AMapOffByFiveCentimetresIsConsistentWhereItsShiftIsAState) {
  LabSetup setup;
  setup.world.map_offset_W = {0.025, 0.0433, 0.0};  // across the rows
  EXPECT_GT(run(setup).nees, 5.0);
  controllers::MapLocalisationParams params;
  params.map_shift_std_m = 0.05;
  const LabScore score = run(setup, params);
  EXPECT_LE(score.nees, 2.4);
  EXPECT_LE(score.lateral_m, 0.06);
}

TEST(MapLocalisation, BesideTheMapsWallsItIsAsGoodWhereverTheMapLies) {
  LabSetup setup;
  setup.world.map_offset_W = {0.025, 0.0433, 0.0};
  controllers::MapLocalisationParams params;
  params.map_shift_std_m = 0.05;
  double sum_m = 0.0, squares_m2 = 0.0, nees = 0.0;
  int count = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    for (const LabSample& sample : fly(setup, seed, map_localisation(params, true)).samples) {
      if (sample.time_s < 3.0) continue;
      sum_m += sample.lateral_m;
      squares_m2 += sample.lateral_m * sample.lateral_m;
      nees += sample.nees;
      ++count;
    }
  }
  const double mean_m = sum_m / count;
  EXPECT_NEAR(mean_m, 0.05, 0.01) << "the map's own shift";
  EXPECT_LE(std::sqrt(squares_m2 / count - mean_m * mean_m), 0.018) << "as on a true map";
  EXPECT_LE(nees / count, 2.4) << "and it says how far off the map may be";
  EXPECT_GE(nees / count, 1.0);
}

TEST(MapLocalisation, FindsTheRightAlleyFromAStartThatIsKnownToAMetre) {
  constexpr int kRuns = 34;  // for each of three alleys
  int right = 0;
  for (const int alleys_off : {-1, 0, 1}) {
    LabSetup setup;
    setup.start_std_m = 1.0;
    setup.start_vertical_std_m = 0.1;
    setup.duration_s = 23.0;
    setup.start_alleys_off = alleys_off;
    for (int seed = 1; seed <= kRuns; ++seed) {
      double worst_m = 0.0;
      for (const LabSample& sample : fly(setup, seed, map_localisation()).samples) {
        if (sample.time_s >= 20.0) worst_m = std::max(worst_m, std::abs(sample.lateral_m));
      }
      right += worst_m < 1.0 ? 1 : 0;
    }
  }
  RecordProperty("right", right);
  EXPECT_GE(right, 3 * kRuns - 1);
}

TEST(MapLocalisation, TwoSensorsOnRowsThatAreRoughOverLessThanTheStartIsKnownTo) {
  // A wall's slope at one place holds for half a metre, the start is known to 0.26 m along the
  // rows.
  LabSetup setup;
  setup.world.section_min_m = 0.4;
  setup.world.section_max_m = 0.5;
  setup.sensor_angles_rad = {0.5 * kPi, -0.5 * kPi};
  setup.cone_rad = 0.2618;
  setup.filter_fan_rays = 7;
  const LabScore score = run(setup);
  EXPECT_LE(score.lateral_m, 0.025);
  EXPECT_LE(score.longitudinal_m, 0.2);
  EXPECT_LE(score.nees, 3.0);
  EXPECT_EQ(score.lost, 0);
}

/// A law standing in the lab's alley, with what it looks at.
struct Standing {
  Standing() : world({}, 1) {
    const Eigen::Vector3d p_W = world.place(20.0, 0.0, 1.25);
    sensors = {{"left", {quaternion_from_rpy({0, 0, 0.785}), {0, 0, 0}}, 0.0, 1, 0.003},
               {"right", {quaternion_from_rpy({0, 0, -0.785}), {0, 0, 0}}, 0.0, 1, 0.003}};
    law.emplace(controllers::MapLocalisationParams{}, world.map(), world.map_index(), sensors);
    law->start(Time{0}, p_W, 0.01 * Eigen::Matrix3d::Identity());
    q_WB = quaternion_from_rpy({0, 0, world.setup().azimuth_rad});
    true_p_W = p_W;
  }
  void tick() {
    now = now + Duration{10'000'000};
    law->predict(now, Eigen::Vector3d::Zero(), q_WB);
  }
  void look() {
    for (int i = 0; i < 2; ++i) {
      const Pose X_WS = Pose{q_WB, true_p_W} * sensors[i].X_BS;
      law->correct_range(now, i, world.true_range(X_WS.p, X_WS.q * Eigen::Vector3d::UnitX(), 4.0),
                         0.05);
    }
  }
  LocalisationWorld world;
  std::vector<controllers::RangeSensorModel> sensors;
  std::optional<controllers::MapLocalisationLaw> law;
  Eigen::Quaterniond q_WB;
  Eigen::Vector3d true_p_W;
  Time now;
};

TEST(MapLocalisationLaw, RefusesAndCountsBadDataAndGoesOn) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Standing stationary;
  controllers::MapLocalisationLaw& law = *stationary.law;
  stationary.tick();
  stationary.look();
  const Eigen::Vector3d before = law.state().p_W();
  law.correct_range(stationary.now, 0, kNan, 0.05);
  law.correct_range(stationary.now, 0, -1.0, 0.05);
  law.correct_range(stationary.now + Duration{1'000'000'000}, 0, 1.0, 0.05);
  law.correct_fix(stationary.now, {kNan, 0, 0}, {1, 1, 1}, {0, 0, 0});
  law.correct_plane(stationary.now, Eigen::Vector3d::UnitZ(), kNan, 0.1);
  law.predict(Time{0}, {0, 0, 0}, stationary.q_WB);
  law.predict(stationary.now, {kNan, 0, 0}, stationary.q_WB);
  EXPECT_EQ(law.counters().refused, 7);
  // The stamp that this sensor's last reading had.
  law.correct_range(stationary.now, 0, 1.0, 0.05);
  EXPECT_EQ(law.counters().refused, 8);
  EXPECT_EQ(law.state().p_W(), before);
  // Contradictory ranges are gated until the filter bank restarts; good ones bring it back.
  for (int i = 0; i < 400; ++i) {
    stationary.tick();
    law.correct_range(stationary.now, i % 2, 0.1, 0.05);
  }
  EXPECT_GT(law.counters().echoes_gated, 0);
  EXPECT_TRUE(law.state().p_W().allFinite());
  for (int i = 0; i < 3000; ++i) {
    stationary.tick();
    if (i % 5 == 0) stationary.look();
    if (i % 20 == 0) {
      law.correct_fix(stationary.now, stationary.true_p_W, {0.5, 0.5, 0.5}, {0, 0, 0});
    }
  }
  EXPECT_LT((law.state().p_W() - stationary.true_p_W).head<2>().norm(), 0.5);
  EXPECT_TRUE(law.state().is_sound());
}

/// Closed form: a law that knows its place has no innovation from a fix without error, so that
/// nothing moves, however old the fix is, however the vehicle has moved and turned since, and
/// wherever the antenna sits.
TEST(MapLocalisationLaw, AnOldFixWithoutErrorIsComparedWithWhereTheAntennaWas) {
  constexpr double kSpeedMps = 1.3;
  constexpr double kTurnRadps = 0.5;
  const Duration tick{10'000'000};
  const Eigen::Vector3d p_BA(0.4, -0.1, 0.3);
  Standing stationary;
  controllers::MapLocalisationLaw& law = *stationary.law;
  const Eigen::Vector3d v_W = kSpeedMps * stationary.world.along_W();
  const auto place_W = [&](double t_s) { return Eigen::Vector3d(stationary.true_p_W + t_s * v_W); };
  const auto turned = [&](double t_s) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(kTurnRadps * t_s, Eigen::Vector3d::UnitZ()) *
                              stationary.q_WB);
  };
  const Time start = stationary.now;
  for (int k = 0; k < 100; ++k) {
    stationary.now = stationary.now + tick;
    law.predict(stationary.now, v_W, turned((stationary.now - start).s()));
  }
  for (const int age : {0, 20, 60}) {
    const Time measured = stationary.now - Duration{age * tick.ns};
    const double t_s = (measured - start).s();
    law.correct_fix(measured, place_W(t_s) + turned(t_s) * p_BA, {0.05, 0.05, 0.05}, p_BA);
    EXPECT_NEAR(law.fix_nis(), 0.0, 1e-9) << age << " ticks old";
    EXPECT_LT((law.state().p_W() - place_W(1.0)).norm(), 1e-9) << age << " ticks old";
  }
  EXPECT_EQ(law.counters().fixes, 3);
}

TEST(MapLocalisationLaw, BeginningAnewKeepsTheOldPlaceInQuestion) {
  Standing stationary;
  controllers::MapLocalisationLaw& law = *stationary.law;
  stationary.tick();
  // The last fix is 1.5 m off along the rows: a bank about it alone would be, too.
  law.correct_fix(stationary.now, stationary.true_p_W + 1.5 * stationary.world.along_W(), {1, 1, 1},
                  {0, 0, 0});
  int ticks = 0;
  for (; law.counters().lost == 0 && ticks < 1000; ++ticks) {
    stationary.tick();
    if (ticks % 5 == 0) {
      for (const int sensor : {0, 1}) law.correct_range(stationary.now, sensor, 0.1, 0.05);
    }
  }
  ASSERT_EQ(law.counters().lost, 1);
  EXPECT_GT(law.filter_count(), 1) << "what is new is in question beside it";
  const Eigen::Vector3d along_W = stationary.world.along_W();
  EXPECT_GT(along_W.dot(law.position_covariance() * along_W), 0.25) << "and the covariance says so";
  EXPECT_LT(std::abs(along_W.dot(law.state().p_W() - stationary.true_p_W)), 0.75)
      << "the old place, the likeliest, not the fix";
}

TEST(MapLocalisationLaw, TheCovarianceCountsEveryAlleyInQuestion) {
  Standing stationary;
  stationary.law->start(Time{0}, stationary.true_p_W, Eigen::Matrix3d::Identity());
  stationary.law->predict(Time{0}, {0, 0, 0}, stationary.q_WB);
  ASSERT_EQ(stationary.law->filter_count(), 3);
  // Closed form: the weighted sum over alleys 2.5 m apart, across the rows.
  const Eigen::Vector3d left_W = stationary.world.left_W();
  const double across_m2 = left_W.dot(stationary.law->position_covariance() * left_W);
  const double side_weight = 0.5 * (1.0 - stationary.law->best_weight()) * 2.0;
  EXPECT_NEAR(across_m2, 0.35 * 0.35 + side_weight * 2.5 * 2.5, 1e-6);
}

TEST(MapLocalisationLaw, ATickDoesNotAllocate) {
  Standing stationary;
  stationary.tick();
  stationary.look();
  std::vector<double> ranges_m;
  for (int i = 0; i < 2; ++i) {
    const Pose X_WS = Pose{stationary.q_WB, stationary.true_p_W} * stationary.sensors[i].X_BS;
    ranges_m.push_back(stationary.world.true_range(X_WS.p, X_WS.q * Eigen::Vector3d::UnitX(), 4.0));
  }
  const AllocationCounter counter;
  for (int k = 0; k < 300; ++k) {
    stationary.tick();
    for (int i = 0; i < 2; ++i) stationary.law->correct_range(stationary.now, i, ranges_m[i], 0.05);
    stationary.law->correct_fix(stationary.now, stationary.true_p_W, {1, 1, 1}, {0, 0, 0});
  }
  EXPECT_EQ(counter.count(), 0u);
}

TEST(MapLocalisation, TakesAPoseFromOutside) {
  const RowMap map = make_row_mesh_map({.rows = 4, .length_m = 40.0}, RandomStream(1, "", "map"));
  LocalisationBench bench("map_localisation", {{"initial_pose_from_outside", true}}, &map, {});
  const auto pose_out = static_cast<Signal<Odometry>*>(bench.bus.find("robot/initialpose"));
  Odometry truth;
  truth.X_WB.p = {10.0, 1.0, 0.5};
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      bench.write_motion(truth, truth);
      bench.step();
    }
  };
  run(100);
  const double z_m = bench.p_W().z();
  Odometry pose;
  pose.X_WB.p = {14.0, -1.5, 0.0};
  pose.position_variance_m2 = {0.01, 0.0, 0.0};  // a program that leaves the second one unset
  pose_out->write(bench.now, pose);
  run(1);
  EXPECT_LT((bench.p_W() - Eigen::Vector3d(14.0, -1.5, z_m)).norm(), 1e-9);
  EXPECT_EQ(bench.events_with("the pose (14.00, -1.50)").size(), 1u);
  run(1);
  EXPECT_LT((bench.p_W().head<2>() - Eigen::Vector2d(14.0, -1.5)).norm(), 0.01) << "taken once";
  const Eigen::Vector3d variance_m2 = bench.estimate.value().position_variance_m2;
  EXPECT_GT(variance_m2.x(), 0.0099);
  EXPECT_GT(variance_m2.x(), variance_m2.y());
}

}  // namespace
}  // namespace vinerow::test::map_localisation_test

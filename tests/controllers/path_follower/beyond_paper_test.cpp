// Our follower against the paper's law: same path, waypoint pitch, cycle, metric, seeds. The
// factors to reach are those of the best rows an independent prototype found (docs/papers/paper_b.md).

#include <gtest/gtest.h>

#include <array>

#include "tests/controllers/support/mission.h"

namespace vinerow::test::beyond_paper_test {
namespace {

constexpr std::array<double, 5> kAccuracies_m = {0.0, 0.01, 0.02, 0.05, 0.1};
constexpr std::array<double, 5> kPaperLaw = {.3307, .0351, .0318, .0315, .0299};

/// The paper's location error, with its exact heading.
const PartChoice kFixes{"gps_pose", {{"heading", std::string("truth")}}};

MissionSetup make_our_mission(double accuracy_m, Values estimator = {}) {
  MissionSetup setup = make_paper_mission();
  // A perfect vehicle has no lag: the lookahead is chosen for noise alone.
  setup.controller = {"path_follower", {{"lookahead_s", 1.5}}};
  // The paper takes the heading as exact.
  estimator.emplace_back("heading", std::string("truth"));
  setup.estimator = {"odometry_filter", std::move(estimator)};
  setup.accuracy_m = accuracy_m;
  return setup;
}

void expect_at_least(const std::array<double, 5>& wanted, const Values& estimator) {
  for (std::size_t i = 0; i < kAccuracies_m.size(); ++i) {
    const MissionSetup setup = make_our_mission(kAccuracies_m[i], estimator);
    EXPECT_GT(run_seeds(setup, i == 0 ? 1 : 5).first, wanted[i]) << kAccuracies_m[i];
  }
}

TEST(BeyondPaper, BeatsTheBestPrototypeInEveryColumn) {
  expect_at_least({3.57, 1.86, 1.45, .841, .475}, {});
}

TEST(BeyondPaper, IsNotLostWithOdometryFivePercentWrong) {
  // The prototype's filter of gain 0.01 falls to 0.185 with 2 %; the learnt scale keeps ours.
  expect_at_least({3.57, 1.86, 1.45, .841, .475}, {{"odometry_scale", 1.05}});
}

TEST(BeyondPaper, FixedGainBeatsThePrototypesFixedGain) {
  expect_at_least({3.57, 1.38, .99, .505, .278}, {{"gain", std::string("fixed")}});
}

TEST(BeyondPaper, WithoutFilterBeatsThePaperByTheFeedForwardFactor) {
  constexpr std::array<double, 5> kPrototype = {3.57, .696, .485, .242, .131};
  for (std::size_t i = 0; i < kAccuracies_m.size(); ++i) {
    MissionSetup setup = make_our_mission(kAccuracies_m[i]);
    setup.estimator = kFixes;
    EXPECT_GT(run_seeds(setup, i == 0 ? 1 : 5).first, kPrototype[i]) << kAccuracies_m[i];
  }
}

TEST(BeyondPaper, IsBetterInDeviationAloneAndCostsLittleTime) {
  // The gain is not one of counting: mean and largest deviation fall as well, with and without
  // error.
  for (const double accuracy : {0.0, 0.02, 0.1}) {
    MissionSetup paper = make_paper_mission();
    paper.estimator = kFixes;
    paper.accuracy_m = accuracy;
    const MissionResult theirs = run_mission(paper);
    const MissionResult ours = run_mission(make_our_mission(accuracy));
    EXPECT_TRUE(ours.finished);
    EXPECT_LT(ours.average_m, 0.2 * theirs.average_m);
    EXPECT_LT(ours.max_m, 0.2 * theirs.max_m);
    EXPECT_LT(static_cast<double>(ours.oscillations),
              1.1 * static_cast<double>(theirs.oscillations));
    EXPECT_LT(ours.time_s,
              theirs.time_s + 4.0);  // speeding up and braking, which the paper leaves out
    EXPECT_GT(ours.relative_accuracy / theirs.relative_accuracy, 15.0);
  }
}

TEST(BeyondPaper, WithoutErrorOnlyTheChordsRemain) {
  // The waypoint polyline cuts the arcs: a chord of 15.708 / 48 m lies up to c^2 / 8R inside. Who
  // drives the planned arc itself is that far from the polyline, two thirds of it on average, over
  // 45 pi of 941 m.
  const MissionResult ours = run_mission(make_our_mission(0.0));
  const double chord_m = 5.0 * M_PI / 48.0;
  const double sagitta_m = chord_m * chord_m / (8.0 * 5.0);
  EXPECT_NEAR(ours.max_m, sagitta_m, 0.1e-3);
  EXPECT_NEAR(ours.average_m, 2.0 / 3.0 * sagitta_m * 45.0 * M_PI / 941.37, 0.03e-3);
}

TEST(BeyondPaper, DubinsTurnsAreShorterAndAsExact) {
  constexpr std::array<double, 5> kPrototype = {6.13, 1.90, 1.27, .640, .352};
  for (std::size_t i = 0; i < kAccuracies_m.size(); ++i) {
    MissionSetup setup = make_our_mission(kAccuracies_m[i]);
    setup.planner.values = {{"turn", std::string("dubins")}, {"turn_radius_m", 3.0}};
    EXPECT_GT(run_seeds(setup, i == 0 ? 1 : 5).first, kPrototype[i]) << kAccuracies_m[i];
  }
}

TEST(BeyondPaper, GainOverThePaperInEveryColumn) {
  for (std::size_t i = 0; i < kAccuracies_m.size(); ++i) {
    const double ours = run_seeds(make_our_mission(kAccuracies_m[i]), i == 0 ? 1 : 5).first;
    EXPECT_GT(ours / kPaperLaw[i], 15.0) << kAccuracies_m[i];
  }
}

}  // namespace
}  // namespace vinerow::test::beyond_paper_test

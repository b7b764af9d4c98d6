// Paper B's numbers in the reading that docs/papers/paper_b.md states. The expected values come from an
// independent prototype of that reading; those called "printed" are the paper's own.

#include <gtest/gtest.h>

#include <array>
#include <ostream>

#include "tests/controllers/support/mission.h"

namespace vinerow::test::paper_b_test {
namespace {

constexpr std::array<double, 5> kAccuracies_m = {0.0, 0.01, 0.02, 0.05, 0.1};

MissionSetup make_noisy_mission(double accuracy_m, Values values = {}) {
  MissionSetup setup = make_paper_mission();
  setup.controller.values = std::move(values);
  setup.accuracy_m = accuracy_m;
  // The paper takes the heading as exact.
  setup.estimator = {"gps_pose", {{"heading", std::string("truth")}}};
  return setup;
}

TEST(PaperB, PathIsTenRowsAndNineSemicircles) {
  const PlannedPath plan = plan_mission(make_paper_mission(0.33));
  EXPECT_NEAR(plan.length_m, 800.0 + 45.0 * M_PI, 1e-9);
  EXPECT_EQ(plan.points.size(), 2853u);
  EXPECT_NEAR((plan.points.back().p_W - Eigen::Vector3d(95, 10, 0)).norm(), 0.0, 1e-9);
}

struct Cell {
  double lookahead_m, pitch_m, average_mm;
  int oscillations;
  double accuracy;
};

void PrintTo(const Cell& cell, std::ostream* out) {
  *out << "lookahead " << cell.lookahead_m << " m, pitch " << cell.pitch_m << " m";
}

class LookaheadTimesPitch : public ::testing::TestWithParam<Cell> {};

TEST_P(LookaheadTimesPitch, AgreesWithinTwoPercent) {
  const Cell cell = GetParam();
  MissionSetup setup = make_paper_mission(cell.pitch_m);
  setup.controller.values = {{"lookahead_m", cell.lookahead_m}};
  const MissionResult result = run_mission(setup);
  EXPECT_TRUE(result.finished);
  // The issue asks for 2 %; the table is rounded to three digits.
  EXPECT_NEAR(result.average_m * 1e3, cell.average_mm, 0.02 * cell.average_mm);
  EXPECT_NEAR(static_cast<double>(result.oscillations), cell.oscillations,
              0.02 * cell.oscillations);
  EXPECT_NEAR(result.relative_accuracy, cell.accuracy, 0.02 * cell.accuracy);
}

INSTANTIATE_TEST_SUITE_P(
    PaperB, LookaheadTimesPitch,
    ::testing::Values(Cell{0.5, 0.16, 3.03, 833, .397}, Cell{0.5, 0.33, 3.02, 423, .782},
                      Cell{0.5, 0.66, 3.02, 225, 1.470}, Cell{0.5, 1.0, 3.02, 153, 2.164},
                      Cell{0.5, 1.65, 3.01, 99, 3.355}, Cell{0.75, 0.16, 7.34, 784, .174},
                      Cell{0.75, 0.33, 7.34, 412, .331}, Cell{0.75, 0.66, 7.34, 225, .606},
                      Cell{0.75, 1.0, 7.33, 153, .892}, Cell{0.75, 1.65, 7.31, 99, 1.382},
                      Cell{1.0, 0.16, 13.50, 730, .101}, Cell{1.0, 0.33, 13.50, 392, .189},
                      Cell{1.0, 0.66, 13.49, 207, .358}, Cell{1.0, 1.0, 13.48, 153, .485},
                      Cell{1.0, 1.65, 13.45, 99, .751}, Cell{1.5, 0.16, 31.23, 596, .054},
                      Cell{1.5, 0.33, 31.23, 345, .093}, Cell{1.5, 0.66, 31.22, 198, .162},
                      Cell{1.5, 1.0, 31.20, 135, .237}, Cell{1.5, 1.65, 31.14, 99, .324},
                      Cell{2.0, 0.16, 55.91, 424, .042}, Cell{2.0, 0.33, 55.91, 297, .060},
                      Cell{2.0, 0.66, 55.89, 175, .102}, Cell{2.0, 1.0, 55.86, 132, .136},
                      Cell{2.0, 1.65, 55.78, 81, .221}));

TEST(PaperB, BaselineIsThePrintedOne) {
  const MissionResult result = run_mission(make_paper_mission());
  EXPECT_NEAR(result.relative_accuracy, 0.3311, 0.0005);  // printed through the delta columns
  EXPECT_EQ(result.oscillations, 412);
  EXPECT_NEAR(result.time_s, 484.0, 1.0);
}

TEST(PaperB, TableTwoWithinFivePercentOfTheReadingAndThirtyOfThePaper) {
  constexpr std::array<double, 5> kReading = {.3307, .0351, .0318, .0315, .0299};
  constexpr std::array<double, 5> kPrinted = {.3311, .0272, .0317, .0316, .0273};
  for (std::size_t i = 0; i < kAccuracies_m.size(); ++i) {
    const double mean = run_seeds(make_noisy_mission(kAccuracies_m[i]), i == 0 ? 1 : 20).first;
    EXPECT_NEAR(mean, kReading[i], 0.05 * kReading[i]) << kAccuracies_m[i];
    EXPECT_NEAR(mean, kPrinted[i], 0.30 * kPrinted[i]) << kAccuracies_m[i];
  }
}

TEST(PaperB, TableThreeOverTheWholeMissionIsTheReadingsNotThePapers) {
  constexpr std::array<double, 5> kReading = {.0997, .0947, .0658, .0376, .0313};
  for (std::size_t i = 0; i < kAccuracies_m.size(); ++i) {
    const MissionSetup setup =
        make_noisy_mission(kAccuracies_m[i], {{"steering_threshold_deg", 2.5}});
    // 5 %: three standard errors of the reading's own 20 seeds at the noisiest column.
    EXPECT_NEAR(run_seeds(setup, i == 0 ? 1 : 20).first, kReading[i], 0.05 * kReading[i]);
  }
}

TEST(PaperB, WithoutYawLimitNoiseCostsMore) {
  constexpr std::array<double, 5> kReading = {.331, .0351, .0317, .0250, .0186};
  for (std::size_t i = 0; i < kAccuracies_m.size(); ++i) {
    const MissionSetup setup =
        make_noisy_mission(kAccuracies_m[i], {{"min_turning_radius_m", 0.0}});
    EXPECT_NEAR(run_seeds(setup, i == 0 ? 1 : 5).first, kReading[i], 0.05 * kReading[i]);
  }
}

TEST(PaperB, CycleTimeIsTheFittedValue) {
  // Other cycle times shift table 2 as the reading says: t = 0.01 and 0.05 s, without and with 0.02
  // m error.
  MissionSetup setup = make_noisy_mission(0.0);
  setup.cycle_s = 0.01;
  EXPECT_NEAR(run_mission(setup).relative_accuracy, .303, 0.02 * .303);
  setup.cycle_s = 0.05;
  EXPECT_NEAR(run_mission(setup).relative_accuracy, .393, 0.02 * .393);
  setup.accuracy_m = 0.02;
  EXPECT_NEAR(run_seeds(setup, 5).first, .0588, 0.05 * .0588);
}

MissionResult run_literal(double pitch_m, double lookahead_m, double crossed_m, bool aim_at_goal) {
  MissionSetup setup = make_paper_mission(pitch_m);
  setup.controller.values = {{"lookahead_m", lookahead_m},
                             {"crossed_distance_m", crossed_m},
                             {"aim_at_goal", aim_at_goal}};
  setup.longest_s = 700.0;  // the mission takes 484 s
  return run_mission(setup);
}

TEST(PaperBTraps, PitchAboveLookaheadPlusCrossedDistanceSwingsLikeAPendulum) {
  const MissionResult swinging = run_literal(0.66, 0.5, 0.1, false);
  EXPECT_NEAR(static_cast<double>(swinging.oscillations), 1143, 0.02 * 1143);
  // A longer pitch loops about a waypoint for good.
  EXPECT_FALSE(run_literal(1.0, 0.5, 0.1, true).finished);
  EXPECT_TRUE(run_literal(1.0, 0.5, 0.5, true).finished);
}

TEST(PaperBTraps, CrossedDistanceBelowTheCutLoopsForEver) {
  // The corner is cut by about LD^2 / 2R = 0.4 m, so waypoints in the turn are never nearer than
  // 0.25 m.
  const MissionResult result = run_literal(0.33, 2.0, 0.25, true);
  EXPECT_FALSE(result.finished);
  EXPECT_GT(result.poses.back().p.y(), 89.0);  // still at the first hairpin
  EXPECT_TRUE(run_literal(0.33, 2.0, 0.5, true).finished);
}

TEST(PaperBTraps, CrossedDistanceBelowLookaheadMissesTheGoal) {
  EXPECT_FALSE(run_literal(0.33, 0.75, 0.1, false).finished);
  EXPECT_TRUE(run_literal(0.33, 0.75, 0.1, true).finished);    // aiming at the last waypoint
  EXPECT_TRUE(run_literal(0.33, 0.75, 0.75, false).finished);  // D_th = LD
}

TEST(PaperB, CrossedDistanceBetweenCutAndLookaheadChangesNothing) {
  for (const double crossed : {0.1, 0.2, 0.4}) {
    EXPECT_NEAR(run_literal(0.33, 0.75, crossed, true).relative_accuracy, .3307, 0.01 * .3307);
  }
  EXPECT_NEAR(run_literal(0.33, 0.75, 1.0, true).relative_accuracy, .283, 0.02 * .283);
}

}  // namespace
}  // namespace vinerow::test::paper_b_test

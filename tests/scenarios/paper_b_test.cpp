/// Paper B's mission through the whole kernel against the reference table of reading R1
/// (docs/papers/paper_b.md): ATD, OF and RA within 2 %.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <ostream>

#include "tests/scenarios/command.h"
#include "vinerow/testing.h"

namespace vinerow::paper_b_test {
namespace {

struct Cell {
  double lookahead_m, pitch_m, atd_mm, of, ra_per_m;
};

void PrintTo(const Cell& cell, std::ostream* out) {
  *out << "lookahead " << cell.lookahead_m << " m, pitch " << cell.pitch_m << " m";
}

class PaperBTable : public ::testing::TestWithParam<Cell> {};

TEST_P(PaperBTable, KernelGivesTheReferenceWithinTwoPercent) {
  const Cell& cell = GetParam();
  auto run =
      testing::TestRun::from_file(test::scenario_file("orchard_rover"),
                                  {fmt::format("rover.controller.lookahead_m={}", cell.lookahead_m),
                                   fmt::format("rover.planner.waypoint_pitch_m={}", cell.pitch_m)});
  run.run_to_end();
  ASSERT_TRUE(run.finished());
  EXPECT_NEAR(run.metric("rover", "average_deviation_m") * 1e3, cell.atd_mm, 0.02 * cell.atd_mm);
  EXPECT_NEAR(run.metric("rover", "oscillation_count"), cell.of, 0.02 * cell.of);
  EXPECT_NEAR(run.metric("rover", "relative_accuracy_per_m"), cell.ra_per_m, 0.02 * cell.ra_per_m);
}

// The corners, the centre and the paper's own point; tests/controllers holds the whole table.
INSTANTIATE_TEST_SUITE_P(
    R1, PaperBTable,
    ::testing::Values(Cell{0.75, 0.33, 7.34, 412, 0.331}, Cell{0.5, 0.16, 3.03, 833, 0.397},
                      Cell{0.5, 1.65, 3.01, 99, 3.355}, Cell{2.0, 0.16, 55.91, 424, 0.042},
                      Cell{2.0, 1.65, 55.78, 81, 0.221}, Cell{1.0, 0.66, 13.49, 207, 0.358}));

TEST(PaperB, PlanHasTheReferenceLengthAndWaypoints) {
  auto run = testing::TestRun::from_file(test::scenario_file("orchard_rover"));
  run.run_for_s(0.1);
  const PlannedPath& plan = run.signal<PlannedPath>("rover/plan");
  EXPECT_NEAR(plan.length_m, 941.37, 0.005);
  EXPECT_EQ(plan.points.size(), 2853u);
}

}  // namespace
}  // namespace vinerow::paper_b_test

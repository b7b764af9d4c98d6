/// Neighbouring fields are for pictures alone: a run among them is the run without them, bit by
/// bit.

#include <gtest/gtest.h>

#include "tests/scenarios/command.h"
#include "vinerow/testing.h"

namespace vinerow::neighbours_test {
namespace {

using testing::TestRun;

TEST(Neighbours, ARunAmongThemIsTheRunWithout) {
  const auto run = [](const std::string& neighbours) {
    TestRun rover = TestRun::from_file(
        test::scenario_file("vineyard_4ws_two_rows"),
        {"world.row_count=4", "world.row_length_m=20", "world.surroundings_m=100",
         "world.terrain_cell_m=1", "world.neighbours=" + neighbours});
    rover.run_for_s(4.0);
    return rover;
  };
  const TestRun alone = run("null"), amid = run("{count: 12}");
  EXPECT_EQ(amid.digest(), alone.digest());
  const double clearance_m = alone.metric("rover", "min_clearance_m");
  EXPECT_GT(clearance_m, 0.0);
  EXPECT_LT(clearance_m, 3.0);
  EXPECT_EQ(amid.metric("rover", "min_clearance_m"), clearance_m);
}

}  // namespace
}  // namespace vinerow::neighbours_test

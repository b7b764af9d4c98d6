#include "engine/core/suggest.h"

#include <gtest/gtest.h>

#include <vector>

namespace vinerow::suggest_test {
namespace {

TEST(Suggest, EditDistanceCountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("row", "row"), 0);
  EXPECT_EQ(edit_distance("row", "rows"), 1);
  EXPECT_EQ(edit_distance("rover", "rver"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("ab", "ba"), 1);
}

TEST(Suggest, NearestNameIsFoundAndAGuessIsNotMade) {
  const std::vector<std::string> known{"lookahead_m", "speed_mps", "steering_threshold_deg"};
  EXPECT_EQ(nearest_name("lookahed_m", known), "lookahead_m");
  EXPECT_EQ(nearest_name("lookahead", known), "lookahead_m");
  EXPECT_EQ(nearest_name("colour", known), "");
  EXPECT_EQ(did_you_mean("sped_mps", known), "; did you mean 'speed_mps'?");
  EXPECT_EQ(did_you_mean("colour", known), "");
}

TEST(Suggest, TheSameQuantityInAnotherUnitIsNearerThanAnotherQuantity) {
  const std::vector<std::string> known{"speed_gain", "speed_mps", "turn_speed_mps", "start_yaw_deg",
                                       "mass_kg"};
  EXPECT_EQ(nearest_name("speed_kmh", known), "speed_mps");
  EXPECT_EQ(nearest_name("speed_m_s", known), "speed_mps");
  EXPECT_EQ(nearest_name("speed", known), "speed_mps");
  EXPECT_EQ(nearest_name("mass_t", known), "mass_kg");
  EXPECT_EQ(nearest_name("start_yaw_rad", known), "start_yaw_deg");
  EXPECT_EQ(nearest_name("speed_gian", known), "speed_gain");
  EXPECT_EQ(nearest_name("speed_kmh", std::vector<std::string>{"row_kmh"}), "");
}

}  // namespace
}  // namespace vinerow::suggest_test

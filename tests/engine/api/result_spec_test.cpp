#include "engine/api/result_spec.h"

#include <gtest/gtest.h>

#include <limits>

namespace vinerow::result_spec_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ResultSpec named(const char* name) {
  ResultSpec result;
  result.name = name;
  return result;
}

TEST(ResultRange, KnowsWhichLimitsCanBeMet) {
  EXPECT_TRUE(ResultRange::share().can_be_in(1.0, kInfinity));
  EXPECT_FALSE(ResultRange::share().can_be_in(1.01, kInfinity));
  EXPECT_FALSE(ResultRange::from_zero().can_be_in(-kInfinity, -0.05));
  EXPECT_TRUE(ResultRange::any().can_be_in(-kInfinity, -0.05));
  // Between 8.2 and 8.8 there is no whole number, between 7.8 and 8.2 there is one.
  EXPECT_FALSE(ResultRange::count().can_be_in(8.2, 8.8));
  EXPECT_TRUE(ResultRange::count().can_be_in(7.8, 8.2));
  EXPECT_FALSE(ResultRange::zero_or_one().can_be_in(0.2, 0.8));
}

TEST(ResultRange, IsWrittenInWords) {
  EXPECT_EQ(ResultRange::any().text(), "");
  EXPECT_EQ(ResultRange::from_zero().text(), "from 0");
  EXPECT_EQ(ResultRange::zero_to(180.0).text(), "0 to 180");
  EXPECT_EQ(ResultRange::count().text(), "whole numbers from 0");
  EXPECT_EQ(ResultRange::zero_or_one().text(), "0 or 1");
}

TEST(ResultSpec, FormsStandForNamesOfOneLetterOrMore) {
  const std::vector<ResultSpec> results = {named("slip_max"), named("slip_max_<wheel>"),
                                           named("<observer>_nis_<source>_mean")};
  EXPECT_EQ(find_result(results, "slip_max"), &results[0]);
  EXPECT_EQ(find_result(results, "slip_max_fl"), &results[1]);
  EXPECT_EQ(find_result(results, "slip_max_"), nullptr);
  EXPECT_EQ(find_result(results, "no_map_nis_range_mean"), &results[2]);
  EXPECT_EQ(find_result(results, "nis_range_mean"), nullptr);
  EXPECT_EQ(find_result(results, "slip"), nullptr);
}

}  // namespace
}  // namespace vinerow::result_spec_test

#include "engine/api/parameters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "tests/support/spec_makers.h"

namespace vinerow::parameters_test {
namespace {

ParameterSet example() {
  return ParameterSet(
      {positive_parameter("lookahead_m", "m", 0.75, "distance"),
       number_parameter("share", "", 0.5, 0.0, 1.0, "share"),
       integer_parameter("rows", 9, 1, 100, "rows"), boolean_parameter("on", true, "switch"),
       choice_parameter("turn", "arc", {"arc", "dubins"}, "turn"),
       number_list_parameter("position_m", "m", {0, 0, 0}, "place", 3),
       text_list_parameter("names", {}, "names"), path_parameter("file", "file"),
       group_list_parameter(
           "outages", {required(number_parameter("begin_s", "s", 0, 0, 10, "begin"))}, "windows")},
      "pursuit");
}

/// The text of the error that setting a value causes.
std::string error_of(std::string_view name, ParameterSet::Value value) {
  ParameterSet set = example();
  try {
    set.set(name, std::move(value));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Parameters, DefaultsAreThere) {
  const ParameterSet set = example();
  EXPECT_EQ(set.number("lookahead_m"), 0.75);
  EXPECT_EQ(set.integer("rows"), 9);
  EXPECT_TRUE(set.boolean("on"));
  EXPECT_EQ(set.text("turn"), "arc");
  EXPECT_FALSE(set.has("file"));
  EXPECT_TRUE(set.groups("outages").empty());
  EXPECT_EQ(set.source("lookahead_m"), "default");
}

TEST(Parameters, WholeNumbersServeAsNumbers) {
  ParameterSet set = example();
  set.set("lookahead_m", std::int64_t{2}, "data sheet");
  EXPECT_EQ(set.number("lookahead_m"), 2.0);
  EXPECT_EQ(set.source("lookahead_m"), "data sheet");
}

TEST(Parameters, WrongValuesAreRefusedInOneSentence) {
  EXPECT_EQ(error_of("lookahead_m", -1.0), "lookahead_m = -1 m, must be > 0 m");
  EXPECT_EQ(error_of("share", 1.5), "share = 1.5, must be >= 0 and <= 1");
  EXPECT_EQ(error_of("lookahead_m", std::nan("")), "lookahead_m = nan, must be a finite number");
  EXPECT_EQ(error_of("lookahead_m", std::string("far")),
            "lookahead_m must be a number, not a text");
  EXPECT_EQ(error_of("rows", 2.5), "rows must be a whole number, not a number");
  EXPECT_EQ(error_of("on", 1.0), "on must be true or false, not a number");
  EXPECT_EQ(error_of("turn", std::string("dubin")),
            "turn = 'dubin', must be one of: arc, dubins; did you mean 'dubins'?");
  EXPECT_EQ(error_of("position_m", std::vector<double>{1, 2}),
            "position_m has 2 entries, must have 3");
  EXPECT_EQ(error_of("lookahed_m", 1.0).substr(0, 80),
            "unknown parameter 'lookahed_m' of pursuit; did you mean 'lookahead_m'? (known: l");
}

TEST(Parameters, GroupsMustBeComplete) {
  ParameterSet set = example();
  ParameterSet outage = set.make_group("outages");
  EXPECT_THROW(set.set("outages", std::vector<ParameterSet>{outage}), ConfigError);
  outage.set("begin_s", 3.0);
  set.set("outages", std::vector<ParameterSet>{outage});
  EXPECT_EQ(set.groups("outages").at(0).number("begin_s"), 3.0);
}

}  // namespace
}  // namespace vinerow::parameters_test

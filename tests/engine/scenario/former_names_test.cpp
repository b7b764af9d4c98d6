#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/engine/scenario/scenario_fakes.h"

namespace vinerow::scenario::test::former_names_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The fakes, and a controller whose keys were renamed, in a group and in a list too.
Registry renamed_registry() {
  const auto formerly = [](ParameterSpec spec, const char* name) {
    spec.former_name = name;
    return spec;
  };
  Registry registry = fake_registry();
  registry.add_controller(
      fake_spec("turner",
                {formerly(number_parameter("max_turn_deg", "deg", 20.0, 0.0, 90.0, "of a turn"),
                          "most_turn_deg"),
                 group_parameter(
                     "limits",
                     {formerly(number_parameter("min_m", "m", 1.0, 0.0, 9.0, "near"), "least_m")},
                     "of distances"),
                 group_list_parameter(
                     "stops",
                     {formerly(number_parameter("max_s", "s", 1.0, 0.0, 9.0, "waits"), "most_s")},
                     "on the path")},
                40.0),
      nullptr);
  return registry;
}

Scenario parse(const std::string& controller, const std::vector<std::string>& sets = {}) {
  Overrides overrides;
  overrides.sets = sets;
  return parse_scenario(
      "vinerow: 1\nworld: {type: flat}\nvehicles:\n  rover:\n    type: cart\n"
      "    wheel_radius_m: 0.2\n    spawn: {alley: 0, offset_m: 3.0}\n"
      "    controller: " +
          controller + "\n",
      "/", renamed_registry(), overrides);
}

TEST(FormerNames, AreReadWithAWarningThatNamesTheNewKey) {
  const Scenario scenario = parse(
      "{type: turner, most_turn_deg: 35, limits: {least_m: 2}, stops: [{max_s: 3}, {most_s: 4}]}");
  const ParameterSet& values = scenario.vehicles[0].controller->parameters;
  EXPECT_EQ(values.number("max_turn_deg"), 35.0);
  EXPECT_EQ(values.group("limits").number("min_m"), 2.0);
  EXPECT_EQ(values.groups("stops")[1].number("max_s"), 4.0);
  EXPECT_THAT(
      scenario.warnings,
      ElementsAre("scenario:8: vehicles.rover.controller.most_turn_deg: this key is now named "
                  "max_turn_deg",
                  "scenario:8: vehicles.rover.controller.limits.least_m: this key is now named "
                  "min_m",
                  "scenario:8: vehicles.rover.controller.stops[1].most_s: this key is now named "
                  "max_s"));
}

TEST(FormerNames, TheResolvedScenarioHasTheNewKeyAndGivesNoWarning) {
  const Scenario scenario = parse("{type: turner, most_turn_deg: 35}");
  EXPECT_THAT(scenario.resolved_yaml, HasSubstr("max_turn_deg: 35"));
  EXPECT_THAT(scenario.resolved_yaml, testing::Not(HasSubstr("most_turn_deg")));
  EXPECT_TRUE(parse("{type: turner, max_turn_deg: 35}").warnings.empty());
}

TEST(FormerNames, OfAnOverrideNameTheOverride) {
  const Scenario scenario = parse("{type: turner}", {"rover.controller.most_turn_deg=50"});
  EXPECT_EQ(scenario.vehicles[0].controller->parameters.number("max_turn_deg"), 50.0);
  EXPECT_THAT(scenario.warnings,
              ElementsAre("--set rover.controller.most_turn_deg=50: "
                          "vehicles.rover.controller.most_turn_deg: this key is now named "
                          "max_turn_deg"));
}

TEST(FormerNames, AnOverrideReplacesTheOtherName) {
  const Scenario newer =
      parse("{type: turner, most_turn_deg: 35}", {"rover.controller.max_turn_deg=50"});
  EXPECT_EQ(newer.vehicles[0].controller->parameters.number("max_turn_deg"), 50.0);
  EXPECT_TRUE(newer.warnings.empty());
  const Scenario older =
      parse("{type: turner, max_turn_deg: 35}", {"rover.controller.most_turn_deg=50"});
  EXPECT_EQ(older.vehicles[0].controller->parameters.number("max_turn_deg"), 50.0);
  EXPECT_EQ(older.warnings.size(), 1u);
}

TEST(FormerNames, FormerAndNewKeyTogetherAreRefused) {
  try {
    parse("{type: turner, most_turn_deg: 35, max_turn_deg: 30}");
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "scenario:8: vehicles.rover.controller.most_turn_deg is the former name of "
                 "max_turn_deg, which is given too");
  }
}

TEST(FormerNames, AreDeprecatedPropertiesOfTheSchema) {
  const auto schema = nlohmann::json::parse(scenario_json_schema(renamed_registry()));
  const auto& properties = schema["$defs"]["controller.turner"]["properties"];
  nlohmann::json expected = properties["max_turn_deg"];
  expected["deprecated"] = true;
  expected["description"] = "former name of max_turn_deg";
  EXPECT_EQ(properties["most_turn_deg"], expected);
  EXPECT_FALSE(properties["max_turn_deg"].contains("deprecated"));
}

}  // namespace
}  // namespace vinerow::scenario::test::former_names_test

/// What a rule across parameters refuses names the key's own place: a line of the scenario or of a
/// study, or the text of --set.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/api/parameter_table.h"
#include "tests/engine/scenario/scenario_fakes.h"

namespace vinerow::scenario::test::part_place_test {
namespace {

struct Hedge {
  double low_m = 1.0, high_m = 2.0;
};
struct Field {
  double near_m = 1.0, far_m = 2.0;
  std::string fence = "wire";
  Hedge hedge;
};

const ParameterTable<Hedge>& hedge_table() {
  static const ParameterTable<Hedge> table =
      ParameterTable<Hedge>()
          .number("low_m", "m", &Hedge::low_m, kPositive, "lowest leaf")
          .number("high_m", "m", &Hedge::high_m, kPositive, "highest leaf")
          .rule([](const Hedge& h) -> std::string {
            if (h.low_m < h.high_m) return "";
            return fmt::format("low_m = {} m, must be < high_m = {} m", h.low_m, h.high_m);
          });
  return table;
}

const ParameterTable<Field>& field_table() {
  static const ParameterTable<Field> table =
      ParameterTable<Field>()
          .number("near_m", "m", &Field::near_m, kPositive, "near end")
          .number("far_m", "m", &Field::far_m, kPositive, "far end")
          .text("fence", &Field::fence, "material")
          .group("hedge", &Field::hedge, hedge_table(), "beside it")
          .rule([](const Field& f) -> std::string {
            if (f.near_m < f.far_m) return "";
            return fmt::format("near_m = {} m, must be < far_m = {} m", f.near_m, f.far_m);
          })
          .rule([](const Field& f) -> std::string {
            return f.fence == "none"     ? "a field needs a fence"
                   : f.fence == "barbed" ? "fence has barbs"
                                         : "";
          });
  return table;
}

Registry registry() {
  Registry result = fake_registry();
  PartSpec field = fake_spec("field", {});
  field_table().add_to(field);
  result.add_world(field, nullptr);
  result.add_sensor(fake_spec("late", {number_parameter("delay_s", "s", 0.0, 0.0, 10.0, "later")}),
                    nullptr);
  return result;
}

std::string fault_with(const std::string& yaml, const Overrides& overrides = {}) {
  try {
    parse_scenario(yaml, "/", registry(), overrides);
    return "";
  } catch (const ConfigError& fault) {
    return fault.what();
  }
}

std::string with_world(const std::string& world) {
  return with_line(3, "world: {type: field" + world + "}");
}

/// A value of a study: with a place, and not as text.
OverrideValue of_study(const std::string& path, const std::string& value) {
  OverrideValue result{path, io::parse_yaml(value, "study.yaml", "/")};
  result.value.mark = {"study.yaml", 7};
  return result;
}

TEST(PlaceOfRule, IsTheLineOfTheKeyThatItNames) {
  EXPECT_EQ(fault_with(with_world("")), "");
  EXPECT_EQ(fault_with(with_world(",\n  near_m: 3")),
            "scenario:4: world.near_m = 3 m, must be < far_m = 2 m");
  EXPECT_EQ(fault_with(with_world(",\n  far_m: 0.5")),
            "scenario:4: world.near_m = 1 m, must be < far_m = 0.5 m");
  EXPECT_EQ(fault_with(with_world(",\n  far_m: 0.5,\n  near_m: 0.75")),
            "scenario:5: world.near_m = 0.75 m, must be < far_m = 0.5 m");
}

TEST(PlaceOfRule, IsTheTextOfSetOrTheLineOfAStudy) {
  const std::string scenario = with_world(", near_m: 1.5");
  Overrides set;
  set.sets = {"world.far_m=0.5"};
  EXPECT_EQ(fault_with(scenario, set),
            "--set world.far_m=0.5: world.near_m = 1.5 m, must be < far_m = 0.5 m");
  Overrides study;
  study.values = {of_study("world.far_m", "0.5")};
  EXPECT_EQ(fault_with(scenario, study),
            "study.yaml:7: world.near_m = 1.5 m, must be < far_m = 0.5 m");
  Overrides whole;
  whole.sets = {"world={type: field, near_m: 4}"};
  EXPECT_EQ(fault_with(scenario, whole),
            "--set world={type: field, near_m: 4}: world.near_m = 4 m, must be < far_m = 2 m");
  Overrides made;  // by a program, without a place
  made.values = {{"world.far_m", io::yaml_number(0.5)}};
  EXPECT_EQ(fault_with(scenario, made),
            "scenario:3: world.near_m = 1.5 m, must be < far_m = 0.5 m");
}

TEST(PlaceOfRule, IsThatOfTheFieldInAGroup) {
  EXPECT_EQ(fault_with(with_world(",\n  hedge: {high_m: 3,\n  low_m: 3}")),
            "scenario:5: world.hedge: low_m = 3 m, must be < high_m = 3 m");
  Overrides set;
  set.sets = {"world.hedge.high_m=0.5"};
  EXPECT_EQ(fault_with(with_world(""), set),
            "--set world.hedge.high_m=0.5: world.hedge: low_m = 1 m, must be < high_m = 0.5 m");
}

TEST(PlaceOfRule, IsThatOfThePartWhereItNamesNoKey) {
  EXPECT_EQ(fault_with(with_world(",\n  fence: barbed")), "scenario:4: world.fence has barbs");
  // "fence" is a word of the sentence here, not the key.
  EXPECT_EQ(fault_with(with_world(",\n  fence: none")), "scenario:3: world: a field needs a fence");
}

TEST(Delay, MustBeWholePhysicsSteps) {
  const auto with_delay = [](const std::string& delay_s) {
    return with_line(10, "      gps: {type: late,\n        delay_s: " + delay_s + "}");
  };
  EXPECT_EQ(fault_with(with_delay("0.02")), "");
  EXPECT_EQ(fault_with(with_delay("0.0001")),
            "scenario:11: vehicles.rover.sensors.gps.delay_s = 0.0001 s, must be a multiple of the "
            "physics step of 0.001 s");
  Overrides set;
  set.sets = {"rover.sensors.gps.delay_s=0.0015"};
  EXPECT_EQ(fault_with(with_delay("0.02"), set),
            "--set rover.sensors.gps.delay_s=0.0015: vehicles.rover.sensors.gps.delay_s = 0.0015 "
            "s, must be a multiple of the physics step of 0.001 s");
}

}  // namespace
}  // namespace vinerow::scenario::test::part_place_test

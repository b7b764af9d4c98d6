#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/io/files/yaml.h"
#include "tests/engine/scenario/scenario_fakes.h"

namespace vinerow::scenario::test::scenario_resolved_test {
namespace {

using ::testing::HasSubstr;

TEST(ResolvedScenario, WritesDefaultsSourcesAndAbsolutePaths) {
  const TemporaryFolder folder;
  folder.write("data/rows.geojson", "{}");
  folder.write("cart.yaml", "type: cart\nmass_kg: {value: 180, source: 'sheet, p. 2'}\n");
  const auto file = folder.write(
      "a.yaml",
      "vinerow: 1\n"
      "world: {type: flat, rows_file: data/rows.geojson}\n"
      "vehicles: {rover: {include: cart.yaml, wheel_radius_m: 0.1, spawn: {alley: 2}}}\n"
      "criteria: [{metric: rover.distance_m, min: 3}]\n");
  const Scenario s = load_scenario(file, fake_registry(), {{"rover.wheels=6"}, 9});
  EXPECT_EQ(s.resolved_yaml,
            "# Written by vinerow: includes and overrides applied, defaults written out, paths "
            "absolute.\n"
            "vinerow: 1\n"
            "name: a\n"
            "description: \"\"\n"
            "seed: 9\n"
            "duration_s: 60\n"
            "stop_when_finished: true\n"
            "gravity_mps2: 9.80665\n"
            "physics:\n"
            "  step_s: 0.001\n"
            "plugins: []\n"
            "world:\n"
            "  type: flat\n"
            "  size_m: 100\n"
            "  rows_file: " +
                (folder.path() / "data/rows.geojson").string() +
                "\n"
                "vehicles:\n"
                "  rover:\n"
                "    type: cart\n"
                "    mass_kg: {value: 180, source: \"sheet, p. 2\"}\n"
                "    wheel_radius_m: 0.1\n"
                "    inertia_kgm2: [1, 2, 3]\n"
                "    soil: grass\n"
                "    tags: []\n"
                "    braked: false\n"
                "    wheels: 6\n"
                "    spawn: {alley: 2, offset_m: 0, reverse: false, lateral_m: 0, turn_deg: 0}\n"
                "    on_crash: end\n"
                "metrics:\n"
                "  deviation:\n"
                "    type: deviation\n"
                "    rate_Hz: 40\n"
                "  distance:\n"
                "    type: distance\n"
                "criteria:\n"
                "  - metric: rover.distance_m\n"
                "    min: 3\n"
                "    name: \"rover.distance_m >= 3\"\n"
                "record:\n"
                "  enabled: true\n"
                "  truth_rate_Hz: 20\n"
                "  sensor_rate_limit_Hz: 100\n"
                "  compression: zstd\n"
                "pictures:\n"
                "  width: 1280\n"
                "  height: 720\n"
                "  samples: 2\n"
                "  every_s: 0\n"
                "  times_s: []\n"
                "  shares: [1]\n"
                "  cameras:\n"
                "    chase:\n"
                "      kind: chase\n"
                "      vehicle: rover\n"
                "      distance_m: 6\n"
                "      height_m: 2.5\n"
                "      yaw_deg: 0\n"
                "      fov_deg: 55\n"
                "      show_sensor_rays: false\n"
                "      show_trail: true\n"
                "      show_plan: true\n"
                "      show_grid: false\n"
                "      show_tree: false\n"
                "      show_estimate: false\n"
                "      show_map: false\n");
}

/// Loads the resolved text from another folder and expects the same text and the same values again.
void expect_same_again(const Scenario& first) {
  const Scenario second = parse_scenario(first.resolved_yaml, "/", fake_registry());
  EXPECT_EQ(second.resolved_yaml, first.resolved_yaml);
  ASSERT_EQ(second.vehicles.size(), first.vehicles.size());
  for (std::size_t i = 0; i < first.vehicles.size(); ++i) {
    const VehicleConfig &a = first.vehicles[i], &b = second.vehicles[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.spawn.yaw_rad, b.spawn.yaw_rad);
    EXPECT_EQ(a.spawn.offset_m, b.spawn.offset_m);
    EXPECT_EQ(a.on_crash, b.on_crash);
    EXPECT_EQ(a.vehicle.parameters.number("mass_kg"), b.vehicle.parameters.number("mass_kg"));
    ASSERT_EQ(a.sensors.size(), b.sensors.size());
    for (std::size_t k = 0; k < a.sensors.size(); ++k) {
      EXPECT_EQ(a.sensors[k].name, b.sensors[k].name);
      EXPECT_EQ(a.sensors[k].part.rate_Hz, b.sensors[k].part.rate_Hz);
    }
    EXPECT_EQ(a.controller.has_value(), b.controller.has_value());
  }
  EXPECT_EQ(first.metrics.size(), second.metrics.size());
  EXPECT_EQ(first.seed, second.seed);
  EXPECT_EQ(first.name, second.name);
  EXPECT_EQ(first.description, second.description);
  EXPECT_EQ(first.pictures.cameras.size(), second.pictures.cameras.size());
  EXPECT_EQ(first.pictures.shares, second.pictures.shares);
  ASSERT_EQ(first.criteria.size(), second.criteria.size());
  for (std::size_t i = 0; i < first.criteria.size(); ++i) {
    EXPECT_EQ(first.criteria[i].name, second.criteria[i].name);
    EXPECT_EQ(first.criteria[i].max, second.criteria[i].max);
  }
}

TEST(ResolvedScenario, LoadsAgainFromAnywhereAsTheSame) {
  const TemporaryFolder folder;
  folder.write("data/map one.csv", "");
  folder.write("lib/mine.so", "");
  const std::string yaml =
      "description: \"odd: text # with 'quotes' \\\"and\\\" \\\\ \\t tabs\\nlines, \\u00e9, yes\"\n"
      "plugins: [lib/mine.so]\n"
      "duration_s: 0.1\n"
      "seed: 9223372036854775807\n"
      "pictures: {cameras: {a: {}, b: {kind: top}, c: {kind: on_board}, d: {kind: fixed, "
      "position_m: [0.1, 1e-7, 99999.99999999999], look_at_m: [1, 2, 3]}}}";
  std::string text = with_line(2, yaml);
  text += "  - {metric: rover.x, min: -1e-300, max: 0.30000000000000004}\n";
  const Scenario s = parse_scenario(
      text, folder.path(), fake_registry(),
      {{"rover.motor={torque_Nm: {value: 33.3, source: \"yes\"}, map_file: data/map one.csv}",
        "rover.tags=[\"1\", 'true', ~x, a b]", "rover.spawn.offset_m=0.1",
        "world.posts=[{x_m: 0.1}, {x_m: {value: 2, source: tape}}]"},
       {}});
  expect_same_again(s);
  EXPECT_THAT(s.resolved_yaml, HasSubstr("torque_Nm: {value: 33.3, source: \"yes\"}"));
  EXPECT_THAT(s.resolved_yaml, HasSubstr("x_m: {value: 2, source: tape}"));
  EXPECT_THAT(s.resolved_yaml, HasSubstr("tags: [\"1\", \"true\", \"~x\", \"a b\"]"));
}

TEST(ResolvedScenario, RelativeFolderBecomesAbsolute) {
  const Scenario s = parse_scenario(kCartScenario, "some/where", fake_registry());
  expect_same_again(s);
}

TEST(ResolvedScenario, NumbersRoundTripToTheLastBit) {
  // Neighbours of awkward values: what printing with too few digits would merge.
  double value = 0.1;
  for (int i = 0; i < 200; ++i) {
    const io::YamlNode printed = io::yaml_number(value);
    const io::YamlNode read = io::parse_yaml(printed.text, "text", "/");
    const io::YamlScalar scalar = io::scalar_value(read);
    if (const double* number = std::get_if<double>(&scalar)) {
      EXPECT_EQ(*number, value);
    } else {
      EXPECT_EQ(static_cast<double>(std::get<std::int64_t>(scalar)), value);
    }
    value = std::nextafter(value, 1e9) * (i % 3 == 0 ? 7.7e-8 : 3.1);
  }
}

}  // namespace
}  // namespace vinerow::scenario::test::scenario_resolved_test

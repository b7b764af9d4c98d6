#include "tests/engine/scenario/scenario_schema_validator.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "engine/io/files/yaml.h"
#include "tests/engine/scenario/scenario_fakes.h"
#include "tests/support/paths.h"

namespace vinerow::scenario::test::scenario_schema_test {
namespace {

nlohmann::json json_of(const io::YamlNode& node) {
  nlohmann::json json;
  switch (node.kind) {
    case io::YamlKind::kNull:
      break;
    case io::YamlKind::kScalar:
      std::visit([&](const auto& value) { json = value; }, io::scalar_value(node));
      break;
    case io::YamlKind::kList:
      json = nlohmann::json::array();
      for (const io::YamlNode& item : node.items) json.push_back(json_of(item));
      break;
    case io::YamlKind::kMapping:
      json = nlohmann::json::object();
      for (const io::YamlEntry& entry : node.entries) json[entry.key] = json_of(entry.value);
      break;
  }
  return json;
}

const SchemaValidator& validator() {
  static const SchemaValidator instance(
      nlohmann::json::parse(scenario_json_schema(fake_registry())));
  return instance;
}

bool schema_accepts(const std::string& yaml) {
  return validator().accepts(json_of(io::parse_yaml(yaml, "text", "/")));
}

struct Variant {
  int line;
  const char* text;
};

// Lines of kCartScenario: 2 name, 3 world, 6-13 vehicle, 15 criterion.
const Variant kGood[] = {
    {2, "name: x"},
    {2, "description: 'long text'"},
    {2, "seed: {value: 3, source: dice}"},
    {2, "seed: 3.0"},
    {2, "seed: 9223372036854775807"},
    {2, "gravity_mps2: 0"},
    {2, "stop_when_finished: false"},
    {2, "physics: {step_s: 0.0005}"},
    {2, "physics: {}"},
    {2, "plugins: []"},
    {2, "metrics: {}"},
    {2, "metrics: {a: {type: deviation}, b: {type: picky, what: x}, c: null}"},
    {2, "record: {enabled: false, compression: none}"},
    {2, "pictures: {}"},
    {2, "pictures: {cameras: {}}"},
    {2, "pictures: {cameras: {a: {}, b: {kind: top}, c: {vehicle: rover}, d: null}}"},
    {2, "pictures: {cameras: {a: {kind: fixed, position_m: [1, 2, 3], look_at_m: [0, 0, 0]}}}"},
    {2, "pictures: {times_s: [0, 1.5], shares: [0, 1], every_s: 10}"},
    {3, "world: {type: flat, size_m: 1e3}"},
    {3, "world: {type: flat, posts: []}"},
    {3, "world: {type: flat, posts: [{x_m: 1, height_m: 5}]}"},
    {3, "world: {type: flat, rows_file: /}"},
    {3, "world: {type: hilly, slope_deg: -45}"},
    {7, "    wheel_radius_m: {value: 0.2, source: 'ruler'}"},
    {7, "    wheel_radius_m: {value: 0.2}"},
    {7, "    wheel_radius_m: 1"},
    {7,
     "    wheel_radius_m: 1\n    soil: mud\n    wheels: 8\n    braked: true\n    tags: [a, 'b']"},
    {7, "    wheel_radius_m: 1\n    inertia_kgm2: {value: [1, 2, 3], source: CAD}"},
    {7, "    wheel_radius_m: 1\n    motor: {torque_Nm: 5}"},
    {7, "    wheel_radius_m: 1\n    motor: {torque_Nm: {value: 5, source: x}, map_file: /}"},
    {8, "    spawn: {x_m: 1, y_m: 2}"},
    {8, "    spawn: {x_m: 1, y_m: 2, yaw_deg: -90.5}"},
    {8, "    spawn: {point: gate}"},
    {8, "    spawn: {alley: 3, reverse: true}"},
    {10,
     "      gps: {type: gps, rate_Hz: 10}\n      gps2: {type: gps, noise_m: 0}\n      off: null"},
    {11, "    estimator: {type: filter}\n    planner: {type: coverage}\n    controller:"},
    {11, "    estimator: null\n    guidance: {type: window, rate_Hz: 5}\n    controller:"},
    {11,
     "    observers: {a: {type: filter}, b: {type: filter, gain: 1}, c: null}\n    controller:"},
    {11, "    map: {type: survey}\n    controller:"},
    {11, "    map: {type: survey, offset_m: -0.1}\n    controller:"},
    {11, "    map: null\n    controller:"},
    {13, "      rate_Hz: 50"},
    {15, "  - {metric: rover.a.b, min: 0}"},
    {15, "  - {metric: rover.a, min: 0, max: 2, name: both}"},
};

const Variant kBad[] = {
    {11, "    observers: {estimate: {type: filter}}\n    controller:"},
    {11, "    observers: {a: {type: gps}}\n    controller:"},
    {1, "vinerow: 2"},
    {1, "vinerow: '1'"},
    {1, ""},
    {2, "nme: x"},
    {2, "name: 3"},
    {2, "name: ../evil"},
    {2, "name: two words"},
    {2, "name: true"},
    {2, "name: null"},
    {2, "seed: 1.5"},
    {2, "seed: -1"},
    {2, "seed: {value: 1, origin: x}"},
    {2, "seed: {source: x}"},
    {2, "duration_s: 0"},
    {2, "duration_s: '60'"},
    {2, "stop_when_finished: yes"},
    {2, "gravity_mps2: -1"},
    {2, "physics: {step_s: 0}"},
    {2, "physics: {stepp_s: 0.001}"},
    {2, "physics: 0.001"},
    {2, "physics: null"},
    {2, "plugins: lib.so"},
    {2, "plugins: [3]"},
    {2, "metrics: null"},
    {2, "metrics: {a: {type: deviaton}}"},
    {2, "metrics: {a: {type: picky}}"},
    {2, "metrics: {a.b: {type: deviation}}"},
    {2, "metrics: [deviation]"},
    {2, "record: {compression: gzip}"},
    {2, "record: {truth_rate_Hz: 0}"},
    {2, "pictures: {width: 3}"},
    {2, "pictures: {samples: 10}"},
    {2, "pictures: {shares: [1.5]}"},
    {2, "pictures: {times_s: [-1]}"},
    {2, "pictures: {cameras: {a: {kind: fixed}}}"},
    {2, "pictures: {cameras: {a: {kind: fixed, position_m: [1, 2], look_at_m: [0, 0, 0]}}}"},
    {2, "pictures: {cameras: {a: {kind: drone}}}"},
    {2, "pictures: {cameras: {a: {kind: top, distance_m: 3}}}"},
    {2, "pictures: {cameras: {a: {position_m: [1, 2, 3]}}}"},
    {2, "pictures: {cameras: {a: {fov_deg: 0}}}"},
    {2, "pictures: {cameras: []}"},
    {3, ""},
    {3, "world: flat"},
    {3, "world: {}"},
    {3, "world: {type: flatt}"},
    {3, "world: {type: gps}"},
    {3, "world: {type: 3}"},
    {3, "world: {type: flat, slope_deg: 3}"},
    {3, "world: {type: flat, size_m: null}"},
    {3, "world: {type: flat, rate_Hz: 3}"},
    {3, "world: {type: hilly, slope_deg: 46}"},
    {3, "world: {type: flat, posts: [{}]}"},
    {3, "world: {type: flat, posts: [{x_m: 1, y_m: 2}]}"},
    {3, "world: {type: flat, posts: {x_m: 1}}"},
    {3, "world: {type: flat, rows_file: ''}"},
    {3, "world: {type: flat, rows_file: 3}"},
    {5, "  ro ver:"},
    {6, "    kind: cart"},
    {7, ""},
    {7, "    wheel_radius_m: 0"},
    {7, "    wheel_radius_m: 7 km/h"},
    {7, "    wheel_radius_m: {value: 0}"},
    {7, "    wheel_radius_m: {value: 1, source: 3}"},
    {7, "    wheel_radius_m: {value: 1, source: ''}"},
    {7, "    wheel_radius_m: [1]"},
    {7, "    wheel_radius_m: 1\n    soil: lava"},
    {7, "    wheel_radius_m: 1\n    wheels: 1"},
    {7, "    wheel_radius_m: 1\n    wheels: 4.5"},
    {7, "    wheel_radius_m: 1\n    braked: 1"},
    {7, "    wheel_radius_m: 1\n    tags: [1]"},
    {7, "    wheel_radius_m: 1\n    tags: one"},
    {7, "    wheel_radius_m: 1\n    inertia_kgm2: [1, 2]"},
    {7, "    wheel_radius_m: 1\n    inertia_kgm2: [1, 2, three]"},
    {7, "    wheel_radius_m: 1\n    motor: {torque: 5}"},
    {7, "    wheel_radius_m: 1\n    motor: 5"},
    {7, "    wheel_radius_m: 1\n    rate_Hz: 5"},
    {8, ""},
    {8, "    spawn: {}"},
    {8, "    spawn: null"},
    {8, "    spawn: {alley: 0, point: gate}"},
    {8, "    spawn: {x_m: 1}"},
    {8, "    spawn: {x_m: 1, y_m: 2, alley: 1}"},
    {8, "    spawn: {alley: -1}"},
    {8, "    spawn: {alley: 0, yaw_deg: 3}"},
    {8, "    spawn: {point: ''}"},
    {10, "      gps: gps"},
    {10, "      gps: {rate_Hz: 5}"},
    {10, "      plan: {type: gps}"},
    {10, "      gps: {type: gps, rate_Hz: 0}"},
    {10, "      gps: {type: gps, rate_Hz: fast}"},
    {11, "    controler:"},
    {11, "    map: survey\n    controller:"},
    {11, "    map: {type: gps}\n    controller:"},
    {11, "    map: {type: survey, offset_m: 11}\n    controller:"},
    {11, "    map: {type: survey, rate_Hz: 5}\n    controller:"},
    {12, "      type: pure_persuit"},
    {13, "      lookahead: 0.5"},
    {14, "criteria: {a: 1}\nx:"},
    {15, "  - {metric: rover.a}"},
    {15, "  - {metric: a, min: 1}"},
    {15, "  - {min: 1}"},
    {15, "  - {metric: rover.a, max: low}"},
    {15, "  - {metric: rover.a, max: 1, limit: 2}"},
};

TEST(ScenarioSchema, AgreesWithTheLoaderOnGoodScenarios) {
  EXPECT_TRUE(schema_accepts(kCartScenario));
  for (const Variant& variant : kGood) {
    const std::string yaml = with_line(variant.line, variant.text);
    EXPECT_EQ(fault_of(yaml), "") << yaml;
    EXPECT_TRUE(schema_accepts(yaml)) << yaml;
  }
}

TEST(ScenarioSchema, AgreesWithTheLoaderOnBadScenarios) {
  for (const Variant& variant : kBad) {
    const std::string yaml = with_line(variant.line, variant.text);
    EXPECT_NE(fault_of(yaml), "") << yaml;
    EXPECT_FALSE(schema_accepts(yaml)) << yaml;
  }
}

TEST(ScenarioSchema, AcceptsResolvedScenarios) {
  for (const Variant& variant : kGood) {
    const Scenario s = parse_scenario(with_line(variant.line, variant.text), "/", fake_registry());
    EXPECT_TRUE(schema_accepts(s.resolved_yaml)) << s.resolved_yaml;
  }
}

TEST(ScenarioSchema, IncludeMayGiveWhatIsMissing) {
  const TemporaryFolder folder;
  folder.write("base.yaml", kCartScenario);
  folder.write("cart.yaml", "type: cart\nwheel_radius_m: 1\nspawn: {alley: 0}\n");
  folder.write("stop.yaml", "type: stop\n");
  folder.write("mass.yaml", "{value: 5, source: scale}\n");
  const char* good[] = {
      "include: base.yaml\n",
      "include: [base.yaml]\nvehicles: {rover: {controller: {lookahead_m: 1}}}\n",
      "include: base.yaml\nvehicles: {rover: {controller: null}}\n",
      "include: base.yaml\nvehicles: {rover: {spawn: {offset_m: 2}}}\n",
      "vinerow: 1\nworld: {type: flat}\nvehicles: {a: {include: cart.yaml, mass_kg: 3}}\n",
      "vinerow: 1\nworld: {type: flat}\nvehicles: {a: {include: cart.yaml, controller: {include: "
      "stop.yaml}}}\n",
      "vinerow: 1\nworld: {type: flat}\nvehicles: {a: {include: cart.yaml, mass_kg: {include: "
      "mass.yaml}}}\n",
      "vinerow: 1\nworld: {type: flat}\nvehicles: {a: {type: cart, wheel_radius_m: {include: "
      "mass.yaml}, spawn: {point: x}}}\n",
  };
  for (const char* yaml : good) {
    EXPECT_EQ(fault_of(yaml, {}, folder.path()), "") << yaml;
    EXPECT_TRUE(schema_accepts(yaml)) << yaml;
  }
  const char* bad[] = {
      "include: 3\n",
      "include: ''\n",
      "include: base.yaml\nvehicels: {}\n",
      "include: base.yaml\nvehicles: {rover: {controler: {}}}\n",
      "include: base.yaml\nvehicles: {rover: {controller: {lookahed_m: 1}}}\n",
      "include: base.yaml\nvehicles: {rover: {controller: {type: stop, lookahead_m: 1}}}\n",
      "vinerow: 1\nworld: {type: flat}\nvehicles: {a: {include: cart.yaml}, b: {type: cart}}\n",
  };
  for (const char* yaml : bad) {
    EXPECT_NE(fault_of(yaml, {}, folder.path()), "") << yaml;
    EXPECT_FALSE(schema_accepts(yaml)) << yaml;
  }
}

TEST(ScenarioSchema, JudgesTheSameInAnotherValidator) {
  nlohmann::json cases = nlohmann::json::array();
  const auto add = [&](bool accepted, const Variant& variant) {
    const std::string yaml = with_line(variant.line, variant.text);
    cases.push_back({accepted, json_of(io::parse_yaml(yaml, "text", "/"))});
  };
  for (const Variant& variant : kGood) add(true, variant);
  for (const Variant& variant : kBad) add(false, variant);
  const TemporaryFolder folder;
  folder.write("schema.json", scenario_json_schema(fake_registry()));
  folder.write("cases.json", cases.dump());
  const std::string command = "python3 " VINEROW_SOURCE_DIR
                              "/tests/engine/scenario/scenario_schema_check.py " +
                              folder.path().string();
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127) {
    GTEST_SKIP() << "python3-jsonschema is not installed";
  }
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(ScenarioSchema, TellsUnitsRangesAndDefaults) {
  const auto schema = nlohmann::json::parse(scenario_json_schema(fake_registry()));
  const auto& lookahead = schema["$defs"]["controller.pure_pursuit"]["properties"]["lookahead_m"];
  EXPECT_EQ(lookahead["description"], "to the target point [m]");
  EXPECT_EQ(lookahead["default"], 0.75);
  EXPECT_EQ(lookahead["anyOf"][0]["exclusiveMinimum"], 0);
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
}

/// 2^63 is a double, the greatest integer is not.
TEST(ScenarioSchema, GreatestSeedIsTheGreatestInteger) {
  const std::string text = scenario_json_schema(fake_registry());
  EXPECT_NE(text.find("9223372036854775807"), std::string::npos);
  EXPECT_EQ(text.find("9.22"), std::string::npos);
}

TEST(ScenarioSchema, OfAnEmptyRegistryIsStillASchema) {
  const SchemaValidator empty(nlohmann::json::parse(scenario_json_schema(Registry())));
  EXPECT_FALSE(empty.accepts(json_of(io::parse_yaml(kCartScenario, "text", "/"))));
}

}  // namespace
}  // namespace vinerow::scenario::test::scenario_schema_test

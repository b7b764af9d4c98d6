#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/scenario/scenario_fakes.h"

namespace vinerow::scenario::test::scenario_load_test {
namespace {

Scenario parse(const std::string& yaml, const std::filesystem::path& folder = "/") {
  return parse_scenario(yaml, folder, fake_registry());
}

TEST(Scenario, ReadsEveryKey) {
  const Scenario s = parse(R"(
vinerow: 1
name: all
description: "every key once"
seed: 7
duration_s: 1200
stop_when_finished: false
gravity_mps2: 9.8
physics: {step_s: 0.002}
world: {type: flat, size_m: 50, posts: [{x_m: 1}, {x_m: 2, height_m: 3}]}
vehicles:
  rover:
    type: cart
    mass_kg: {value: 180, source: "data sheet p. 2"}
    wheel_radius_m: 0.165
    inertia_kgm2: [1, 2.5, 4]
    soil: mud
    tags: [a, "b c"]
    braked: true
    wheels: 6
    motor: {torque_Nm: 30}
    spawn: {x_m: 1, y_m: -2, yaw_deg: 90}
    sensors:
      gps: {type: gps, rate_Hz: 10, noise_m: 0.1}
      body_rates: {type: imu}
    estimator: {type: filter}
    observers: {slow: {type: filter, rate_Hz: 5}, keen: {type: filter, gain: 0.9}}
    map: {type: survey, offset_m: {value: 0.05, source: "survey of May"}}
    planner: {type: coverage, first_alley: 3}
    guidance: {type: window}
    controller: {type: pure_pursuit, rate_Hz: 50, lookahead_m: 0.5}
  tail:
    type: cart
    wheel_radius_m: 1
    spawn: {point: gate}
    sensors: {eye: {type: survey_camera}}
metrics:
  deviation: {type: deviation, rate_Hz: 20}
criteria:
  - {metric: rover.cross_track_rms_m, max: 0.05}
  - {metric: tail.distance_m, min: 10, max: 20, name: far enough}
record: {enabled: false, truth_rate_Hz: 10, sensor_rate_limit_Hz: 50, compression: lz4}
pictures:
  width: 640
  height: 480
  samples: 1
  every_s: 30
  times_s: [1, 2.5]
  shares: [0.5, 1.0]
  cameras:
    corner: {kind: fixed, position_m: [1, 2, 3], look_at_m: [4, 5, 6], fov_deg: 90}
    behind: {kind: chase, vehicle: tail, distance_m: 4, height_m: 1, yaw_deg: 180, show_trail: false}
    map: {kind: top, height_m: 80, show_plan: false}
    bonnet: {kind: on_board, offset_m: [1, 0, 0.5], pitch_deg: 45, show_sensor_rays: true}
    turn: {kind: top, centre_m: [12.5, -3], height_m: 15, show_grid: true, show_tree: true, show_estimate: true, show_map: true}
    down: {kind: shots, vehicle: tail, sensor: eye, every: 5}
)");
  EXPECT_EQ(s.name, "all");
  EXPECT_EQ(s.description, "every key once");
  EXPECT_EQ(s.seed, 7u);
  EXPECT_EQ(s.duration_s, 1200.0);
  EXPECT_FALSE(s.stop_when_finished);
  EXPECT_EQ(s.gravity_mps2, 9.8);
  EXPECT_EQ(s.physics_step.ns, 2'000'000);
  EXPECT_EQ(s.world.type, "flat");
  EXPECT_EQ(s.world.parameters.number("size_m"), 50.0);
  ASSERT_EQ(s.world.parameters.groups("posts").size(), 2u);
  EXPECT_EQ(s.world.parameters.groups("posts")[0].number("height_m"), 2.0);
  EXPECT_EQ(s.world.parameters.groups("posts")[1].number("height_m"), 3.0);

  ASSERT_EQ(s.vehicles.size(), 2u);
  const VehicleConfig& rover = s.vehicles[0];
  EXPECT_EQ(rover.name, "rover");
  EXPECT_EQ(rover.vehicle.type, "cart");
  EXPECT_EQ(rover.vehicle.parameters.number("mass_kg"), 180.0);
  EXPECT_EQ(rover.vehicle.parameters.source("mass_kg"), "data sheet p. 2");
  EXPECT_EQ(rover.vehicle.parameters.source("wheel_radius_m"), "scenario:15");
  EXPECT_EQ(rover.vehicle.parameters.numbers("inertia_kgm2"), (std::vector<double>{1, 2.5, 4}));
  EXPECT_EQ(rover.vehicle.parameters.text("soil"), "mud");
  EXPECT_EQ(rover.vehicle.parameters.texts("tags"), (std::vector<std::string>{"a", "b c"}));
  EXPECT_TRUE(rover.vehicle.parameters.boolean("braked"));
  EXPECT_EQ(rover.vehicle.parameters.integer("wheels"), 6);
  EXPECT_EQ(rover.vehicle.parameters.group("motor").number("torque_Nm"), 30.0);
  ASSERT_TRUE(rover.spawn.p_W.has_value());
  EXPECT_EQ(*rover.spawn.p_W, Eigen::Vector2d(1, -2));
  EXPECT_DOUBLE_EQ(rover.spawn.yaw_rad, 1.5707963267948966);
  ASSERT_EQ(rover.sensors.size(), 2u);
  EXPECT_EQ(rover.sensors[0].name, "gps");
  EXPECT_EQ(rover.sensors[0].part.rate_Hz, 10.0);
  EXPECT_EQ(rover.sensors[0].part.parameters.number("noise_m"), 0.1);
  EXPECT_EQ(rover.sensors[1].part.type, "imu");
  EXPECT_EQ(rover.sensors[1].part.rate_Hz, 500.0) << "default: every physics step";
  EXPECT_EQ(rover.estimator->rate_Hz, 20.0);
  ASSERT_EQ(rover.observers.size(), 2u);
  EXPECT_EQ(rover.observers[0].name, "slow");
  EXPECT_EQ(rover.observers[0].part.rate_Hz, 5.0);
  EXPECT_EQ(rover.observers[1].part.parameters.number("gain"), 0.9);
  EXPECT_EQ(rover.planner->parameters.integer("first_alley"), 3);
  EXPECT_EQ(rover.planner->rate_Hz, 0.0);
  EXPECT_EQ(rover.guidance->type, "window");
  EXPECT_EQ(rover.controller->rate_Hz, 50.0);
  EXPECT_EQ(rover.controller->parameters.number("lookahead_m"), 0.5);
  EXPECT_EQ(rover.controller->where.line, 31);
  ASSERT_TRUE(rover.map.has_value());
  EXPECT_EQ(rover.map->type, "survey");
  EXPECT_EQ(rover.map->parameters.number("offset_m"), 0.05);
  EXPECT_EQ(rover.map->parameters.source("offset_m"), "survey of May");
  EXPECT_EQ(rover.map->rate_Hz, 0.0);
  EXPECT_EQ(s.vehicles[1].spawn.point, "gate");
  EXPECT_FALSE(s.vehicles[1].controller.has_value());
  EXPECT_FALSE(s.vehicles[1].map.has_value());

  ASSERT_EQ(s.metrics.size(), 1u);
  EXPECT_EQ(s.metrics[0].part.rate_Hz, 20.0);
  ASSERT_EQ(s.criteria.size(), 2u);
  EXPECT_EQ(s.criteria[0].name, "rover.cross_track_rms_m <= 0.05");
  EXPECT_EQ(s.criteria[0].max, 0.05);
  EXPECT_FALSE(s.criteria[0].min.has_value());
  EXPECT_EQ(s.criteria[1].name, "far enough");
  EXPECT_FALSE(s.record.enabled);
  EXPECT_EQ(s.record.truth_rate_Hz, 10.0);
  EXPECT_EQ(s.record.sensor_rate_limit_Hz, 50.0);
  EXPECT_EQ(s.record.compression, "lz4");

  const PicturesConfig& p = s.pictures;
  EXPECT_EQ(p.width, 640);
  EXPECT_EQ(p.height, 480);
  EXPECT_EQ(p.samples, 1);
  EXPECT_EQ(p.every_s, 30.0);
  EXPECT_EQ(p.times_s, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(p.shares, (std::vector<double>{0.5, 1}));
  ASSERT_EQ(p.cameras.size(), 6u);
  EXPECT_EQ(p.cameras[0].kind, CameraKind::kFixed);
  EXPECT_EQ(p.cameras[0].p_W, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(p.cameras[0].target_W, Eigen::Vector3d(4, 5, 6));
  EXPECT_DOUBLE_EQ(p.cameras[0].fov_rad, 1.5707963267948966);
  EXPECT_EQ(p.cameras[1].vehicle, "tail");
  EXPECT_EQ(p.cameras[1].distance_m, 4.0);
  EXPECT_FALSE(p.cameras[1].show_trail);
  EXPECT_EQ(p.cameras[2].kind, CameraKind::kTop);
  EXPECT_EQ(p.cameras[2].height_m, 80.0);
  EXPECT_EQ(p.cameras[2].vehicle, "");
  EXPECT_FALSE(p.cameras[2].show_plan);
  EXPECT_EQ(p.cameras[3].kind, CameraKind::kOnBoard);
  EXPECT_EQ(p.cameras[3].vehicle, "rover") << "default: the first vehicle";
  EXPECT_EQ(p.cameras[3].offset_B, Eigen::Vector3d(1, 0, 0.5));
  EXPECT_DOUBLE_EQ(p.cameras[3].pitch_rad, 0.78539816339744828);
  EXPECT_TRUE(p.cameras[3].show_sensor_rays);
  EXPECT_FALSE(p.cameras[3].show_grid);
  EXPECT_FALSE(p.cameras[3].show_tree);
  EXPECT_FALSE(p.cameras[3].show_estimate);
  EXPECT_FALSE(p.cameras[3].show_map);
  EXPECT_FALSE(p.cameras[2].centre_W.has_value());
  EXPECT_EQ(p.cameras[4].centre_W, Eigen::Vector2d(12.5, -3));
  EXPECT_EQ(p.cameras[4].height_m, 15.0);
  EXPECT_EQ(p.cameras[5].kind, CameraKind::kShots);
  EXPECT_EQ(p.cameras[5].vehicle, "tail");
  EXPECT_EQ(p.cameras[5].sensor, "eye");
  EXPECT_EQ(p.cameras[5].every, 5);
  EXPECT_FALSE(p.cameras[5].show_trail);
  EXPECT_FALSE(p.cameras[5].show_plan);
  EXPECT_TRUE(p.cameras[4].show_grid);
  EXPECT_TRUE(p.cameras[4].show_tree);
  EXPECT_TRUE(p.cameras[4].show_estimate);
  EXPECT_TRUE(p.cameras[4].show_map);
}

TEST(Scenario, FillsInDefaults) {
  const Scenario s = parse(kCartScenario);
  EXPECT_EQ(s.seed, 1u);
  EXPECT_EQ(s.duration_s, 60.0);
  EXPECT_TRUE(s.stop_when_finished);
  EXPECT_EQ(s.gravity_mps2, 9.80665);
  EXPECT_EQ(s.physics_step.ns, 1'000'000);
  EXPECT_EQ(s.vehicles[0].vehicle.parameters.number("mass_kg"), 100.0);
  EXPECT_EQ(s.vehicles[0].sensors[0].part.rate_Hz, 5.0);
  // Every metric that needs no parameter from the user, by its own name.
  ASSERT_EQ(s.metrics.size(), 2u);
  EXPECT_EQ(s.metrics[0].name, "deviation");
  EXPECT_EQ(s.metrics[1].name, "distance");
  EXPECT_EQ(s.metrics[1].part.rate_Hz, 0.0) << "as often as the controller";
  ASSERT_EQ(s.pictures.cameras.size(), 1u) << "every log can be drawn";
  EXPECT_EQ(s.pictures.cameras[0].name, "chase");
  EXPECT_EQ(s.pictures.cameras[0].vehicle, "rover");
  EXPECT_TRUE(s.record.enabled);
}

TEST(Scenario, PicturesWithoutCamerasChaseTheFirstVehicleAtTheEnd) {
  const Scenario s = parse(std::string(kCartScenario) + "pictures: {width: 320}\n");
  ASSERT_EQ(s.pictures.cameras.size(), 1u);
  EXPECT_EQ(s.pictures.cameras[0].kind, CameraKind::kChase);
  EXPECT_EQ(s.pictures.cameras[0].vehicle, "rover");
  EXPECT_EQ(s.pictures.shares, std::vector<double>{1.0});
}

TEST(Scenario, NameIsTheFilesWhereNoneIsGiven) {
  const TemporaryFolder folder;
  const auto file = folder.write("field_day.yaml", with_line(2, ""));
  const Scenario s = load_scenario(file, fake_registry());
  EXPECT_EQ(s.name, "field_day");
  EXPECT_EQ(s.file, file);
}

TEST(ScenarioInclude, OwnKeysWinAndMappingsMergeDeeply) {
  const TemporaryFolder folder;
  folder.write("vehicles/cart.yaml",
               "type: cart\n"
               "mass_kg: {value: 180, source: data sheet}\n"
               "wheel_radius_m: 0.3\n"
               "inertia_kgm2: [1, 1, 1]\n"
               "sensors:\n"
               "  gps: {type: gps, noise_m: 0.5, rate_Hz: 10}\n"
               "controller: {type: pure_pursuit, lookahead_m: 2, max_speed_mps: 3}\n");
  const auto file = folder.write("scenarios/a.yaml",
                                 "vinerow: 1\n"
                                 "world: {type: flat}\n"
                                 "vehicles:\n"
                                 "  rover:\n"
                                 "    include: ../vehicles/cart.yaml\n"
                                 "    inertia_kgm2: [2, 3, 4]\n"
                                 "    spawn: {alley: 1}\n"
                                 "    sensors: {gps: {noise_m: 0.1}, imu: {type: imu}}\n"
                                 "    controller: {lookahead_m: 1}\n");
  const Scenario s = load_scenario(file, fake_registry());
  const VehicleConfig& rover = s.vehicles.at(0);
  EXPECT_EQ(rover.vehicle.parameters.number("wheel_radius_m"), 0.3);
  EXPECT_EQ(rover.vehicle.parameters.source("mass_kg"), "data sheet");
  EXPECT_EQ(rover.vehicle.parameters.numbers("inertia_kgm2"), (std::vector<double>{2, 3, 4}));
  ASSERT_EQ(rover.sensors.size(), 2u);
  EXPECT_EQ(rover.sensors[0].part.parameters.number("noise_m"), 0.1);
  EXPECT_EQ(rover.sensors[0].part.rate_Hz, 10.0);
  EXPECT_EQ(rover.controller->parameters.number("lookahead_m"), 1.0);
  EXPECT_EQ(rover.controller->parameters.number("max_speed_mps"), 3.0);
  EXPECT_THAT(rover.vehicle.parameters.source("wheel_radius_m"),
              ::testing::EndsWith("vehicles/cart.yaml:3"));
}

TEST(ScenarioInclude, ListIsMergedFromFirstToLast) {
  const TemporaryFolder folder;
  folder.write("a.yaml", "type: cart\nwheel_radius_m: 0.1\nmass_kg: 1\nwheels: 3\n");
  folder.write("b.yaml", "mass_kg: 2\nwheels: 5\n");
  const Scenario s =
      parse(with_line(6, "    include: [a.yaml, b.yaml]\n    wheels: 6"), folder.path());
  const ParameterSet& p = s.vehicles[0].vehicle.parameters;
  EXPECT_EQ(p.number("mass_kg"), 2.0);
  EXPECT_EQ(p.integer("wheels"), 6);
  EXPECT_EQ(p.number("wheel_radius_m"), 0.2);
}

TEST(ScenarioInclude, ScenarioMayBuildOnAnother) {
  const TemporaryFolder folder;
  folder.write("base/base.yaml", kCartScenario);
  folder.write("base/rows.geojson", "{}");
  folder.write("base/middle.yaml",
               "include: base.yaml\nworld: {rows_file: rows.geojson}\nduration_s: 5\n");
  const auto file = folder.write("top.yaml",
                                 "include: base/middle.yaml\n"
                                 "name: variant\n"
                                 "vehicles: {rover: {controller: {lookahead_m: 2}}}\n");
  const Scenario s = load_scenario(file, fake_registry());
  EXPECT_EQ(s.name, "variant");
  EXPECT_EQ(s.duration_s, 5.0);
  EXPECT_EQ(s.vehicles[0].controller->parameters.number("lookahead_m"), 2.0);
  EXPECT_EQ(s.world.parameters.text("rows_file"), (folder.path() / "base/rows.geojson").string())
      << "relative to the file that names it";
}

TEST(ScenarioInclude, NullTakesAnIncludedKeyAway) {
  const TemporaryFolder folder;
  folder.write("base.yaml", kCartScenario);
  const Scenario s = parse(
      "include: base.yaml\n"
      "vehicles: {rover: {controller: null, sensors: {gps: null}}}\n",
      folder.path());
  EXPECT_FALSE(s.vehicles[0].controller.has_value());
  EXPECT_TRUE(s.vehicles[0].sensors.empty());
}

TEST(ScenarioInclude, AnotherTypeStartsAfresh) {
  const TemporaryFolder folder;
  folder.write("base.yaml", kCartScenario);
  const Scenario s = parse(
      "include: base.yaml\n"
      "world: {type: hilly}\n"
      "vehicles: {rover: {controller: {type: stop}, spawn: {x_m: 1, y_m: 2}}}\n",
      folder.path());
  EXPECT_EQ(s.vehicles[0].controller->type, "stop");
  EXPECT_EQ(s.vehicles[0].spawn.p_W, Eigen::Vector2d(1, 2));
  EXPECT_FALSE(s.vehicles[0].spawn.alley.has_value());
}

TEST(ScenarioInclude, NewValueDoesNotKeepTheOldSource) {
  const TemporaryFolder folder;
  folder.write("cart.yaml", "mass_kg: {value: 180, source: data sheet}\n");
  const Scenario s =
      parse(with_line(6, "    include: cart.yaml\n    type: cart\n    mass_kg: {value: 200}"),
            folder.path());
  EXPECT_EQ(s.vehicles[0].vehicle.parameters.number("mass_kg"), 200.0);
  EXPECT_EQ(s.vehicles[0].vehicle.parameters.source("mass_kg"), "scenario:8");
}

TEST(ScenarioPlugins, ListIsReadBeforePartsAreKnown) {
  const TemporaryFolder folder;
  folder.write("lib/mine.so", "");
  folder.write("base/base.yaml", "plugins: [../lib/mine.so]\n");
  const auto file =
      folder.write("a.yaml", "include: base/base.yaml\nvinerow: 1\nworld: {type: from_plugin}\n");
  EXPECT_EQ(load_plugin_list(file),
            std::vector<std::filesystem::path>{folder.path() / "lib/mine.so"});
  EXPECT_TRUE(load_plugin_list(file, {{"plugins=[]"}, {}}).empty());
  // What is no plug-in is not judged yet.
  EXPECT_EQ(load_plugin_list(file, {{"no.such.thing=1"}, {}}).size(), 1u);
}

TEST(ScenarioPlugins, MissingLibraryIsNamed) {
  const TemporaryFolder folder;
  folder.write("mine.so", "");
  const auto file = folder.write("a.yaml", "vinerow: 1\nplugins:\n  - mime.so\n");
  try {
    load_plugin_list(file);
    FAIL();
  } catch (const ConfigError& fault) {
    EXPECT_THAT(
        fault.what(),
        ::testing::EndsWith("a.yaml:3: plugins[0] = 'mime.so': no such file (looked for " +
                            (folder.path() / "mime.so").string() + "); did you mean 'mine.so'?"));
  }
}

TEST(ScenarioOverride, SetsValuesByPath) {
  Overrides overrides;
  overrides.sets = {"rover.controller.lookahead_m=0.25",
                    "vehicles.rover.mass_kg=77",
                    "criteria.0.max=9",
                    "world={type: hilly, slope_deg: -3}",
                    "rover.estimator.type=filter",
                    "duration_s=1e2",
                    "rover.sensors.gps=null",
                    "duration_s=50"};
  overrides.seed = 123;
  const Scenario s = parse_scenario(kCartScenario, "/", fake_registry(), overrides);
  EXPECT_EQ(s.vehicles[0].controller->parameters.number("lookahead_m"), 0.25);
  EXPECT_EQ(s.vehicles[0].vehicle.parameters.number("mass_kg"), 77.0);
  EXPECT_EQ(s.vehicles[0].vehicle.parameters.source("mass_kg"), "--set vehicles.rover.mass_kg=77");
  EXPECT_EQ(s.criteria[0].max, 9.0);
  EXPECT_EQ(s.world.parameters.number("slope_deg"), -3.0);
  EXPECT_EQ(s.vehicles[0].estimator->type, "filter");
  EXPECT_TRUE(s.vehicles[0].sensors.empty());
  EXPECT_EQ(s.duration_s, 50.0) << "the last one wins";
  EXPECT_EQ(s.seed, 123u);
}

TEST(ScenarioOverride, ReplacedVehiclesAndSensorsKeepTheirPlaces) {
  const std::string yaml = with_line(
      10,
      "      gps: {type: gps}\n      imu: {type: imu}\n  cart:\n    type: cart\n    "
      "wheel_radius_m: "
      "0.2\n    spawn: {alley: 1}\n  last:\n    type: cart\n    wheel_radius_m: 0.2\n    spawn: "
      "{alley: 2}");
  const Scenario s =
      parse_scenario(yaml, "/", fake_registry(),
                     {{"rover.sensors.gps={type: gps}",
                       "vehicles.cart={type: cart, wheel_radius_m: 0.3, spawn: {alley: 1}}"},
                      {}});
  ASSERT_EQ(s.vehicles.size(), 3u);
  EXPECT_EQ(s.vehicles[1].name, "cart");
  EXPECT_EQ(s.vehicles[1].vehicle.parameters.number("wheel_radius_m"), 0.3);
  EXPECT_EQ(s.vehicles[2].name, "last");
  ASSERT_EQ(s.vehicles[0].sensors.size(), 2u);
  EXPECT_EQ(s.vehicles[0].sensors[0].name, "gps");
  EXPECT_EQ(s.vehicles[0].sensors[1].name, "imu");
}

TEST(ScenarioOverride, NewValueDoesNotKeepTheOldSource) {
  const std::string yaml = with_line(7, "    wheel_radius_m: {value: 0.2, source: ruler}");
  const Scenario s =
      parse_scenario(yaml, "/", fake_registry(), {{"rover.wheel_radius_m.value=0.3"}, {}});
  EXPECT_EQ(s.vehicles[0].vehicle.parameters.number("wheel_radius_m"), 0.3);
  EXPECT_EQ(s.vehicles[0].vehicle.parameters.source("wheel_radius_m"),
            "--set rover.wheel_radius_m.value=0.3");
}

}  // namespace
}  // namespace vinerow::scenario::test::scenario_load_test

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/scenario/scenario_fakes.h"

namespace vinerow::scenario::test::scenario_fault_test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr const char* kPursuitKeys = "(known: lookahead_m, max_speed_mps, rate_Hz, type)";

TEST(ScenarioFault, ReferenceScenarioHasNone) {
  EXPECT_EQ(fault_of(kCartScenario), "");
}

TEST(ScenarioFault, UnknownKeyNamesTheNearest) {
  EXPECT_EQ(fault_of(with_line(13, "      lookahed_m: 0.5")),
            "scenario:13: vehicles.rover.controller.lookahed_m: unknown key of controller "
            "'pure_pursuit'; did you mean 'lookahead_m'? " +
                std::string(kPursuitKeys));
}

TEST(ScenarioFault, KeyWithoutOrWithAnotherUnitFindsTheRightOne) {
  for (const char* key : {"lookahead", "lookahead_cm", "Lookahead_M"}) {
    EXPECT_THAT(fault_of(with_line(13, "      " + std::string(key) + ": 0.5")),
                HasSubstr("did you mean 'lookahead_m'?"));
  }
  EXPECT_THAT(fault_of(with_line(13, "      max_speed_kmh: 3")),
              HasSubstr("did you mean 'max_speed_mps'?"));
  EXPECT_THAT(fault_of(with_line(13, "      speed: 3")),
              HasSubstr("did you mean 'max_speed_mps'?"));
  EXPECT_THAT(fault_of(with_line(13, "      rate_hz: 3")), HasSubstr("did you mean 'rate_Hz'?"));
}

TEST(ScenarioFault, KeyInTheWrongPlaceIsToldWhereItBelongs) {
  EXPECT_THAT(fault_of(with_line(7, "    wheel_radius_m: 0.2\n    lookahead_m: 1")),
              HasSubstr("scenario:8: vehicles.rover.lookahead_m: unknown key of vehicle 'cart'; it "
                        "belongs to vehicles.rover.controller (known: "));
  EXPECT_THAT(fault_of(with_line(3, "world: {type: flat, seed: 3}")),
              HasSubstr("world.seed: unknown key of world 'flat'; it belongs at the top level"));
  EXPECT_THAT(fault_of(with_line(2, "step_s: 0.001")), HasSubstr("it belongs to physics"));
  EXPECT_THAT(fault_of(with_line(7, "    wheel_radius_m: 0.2\n    torque_Nm: 1")),
              HasSubstr("scenario:8: vehicles.rover.torque_Nm: unknown key of vehicle 'cart'; it "
                        "belongs to vehicles.rover.motor (known: "));
  EXPECT_THAT(fault_of(with_line(13, "      torque_Nm: 1")), ::testing::Not(HasSubstr("belongs")));
  // Two groups have it: neither is named.
  EXPECT_THAT(fault_of(with_line(3, "world: {type: hilly, speed_mps: 3}")),
              ::testing::AllOf(HasSubstr("world.speed_mps: unknown key of world 'hilly'"),
                               ::testing::Not(HasSubstr("belongs"))));
}

TEST(ScenarioFault, KnownKeysAreSortedAndCompleteAtTheTop) {
  EXPECT_EQ(fault_of(with_line(2, "wrld: 3")),
            "scenario:2: wrld: unknown key; did you mean 'world'? (known: criteria, description, "
            "duration_s, gravity_mps2, lockstep, metrics, name, phases, physics, pictures, "
            "plugins, record, seed, stop_when_finished, traffic, vehicles, vinerow, world)");
}

TEST(ScenarioFault, WrongTypeSaysWhatIsExpected) {
  EXPECT_EQ(
      fault_of(with_line(13, "      lookahead_m: half")),
      "scenario:13: vehicles.rover.controller.lookahead_m = 'half', must be a number in m, > 0");
  EXPECT_EQ(
      fault_of(with_line(13, "      lookahead_m: 0.5 m")),
      "scenario:13: vehicles.rover.controller.lookahead_m = '0.5 m', must be a number in m, > 0; "
      "write the number alone, its unit is m");
  EXPECT_EQ(
      fault_of(with_line(13, "      max_speed_mps: 7 km/h")),
      "scenario:13: vehicles.rover.controller.max_speed_mps = '7 km/h', must be a number in m/s, "
      ">= 0 and <= 10; write the number alone, its unit is m/s");
  EXPECT_EQ(
      fault_of(with_line(13, "      lookahead_m: '0.5'")),
      "scenario:13: vehicles.rover.controller.lookahead_m = '0.5', must be a number in m, > 0; "
      "write it without quotes");
  EXPECT_EQ(
      fault_of(with_line(13, "      lookahead_m:")),
      "scenario:13: vehicles.rover.controller.lookahead_m = nothing, must be a number in m, > 0; "
      "give a value or remove the key");
  EXPECT_EQ(
      fault_of(with_line(13, "      lookahead_m: [1]")),
      "scenario:13: vehicles.rover.controller.lookahead_m = a list, must be a number in m, > 0");
  EXPECT_EQ(fault_of(with_line(7, "    wheel_radius_m: 0.2\n    wheels: 4.5")),
            "scenario:8: vehicles.rover.wheels = 4.5, must be a whole number, >= 2 and <= 8");
  EXPECT_EQ(fault_of(with_line(7, "    wheel_radius_m: 0.2\n    braked: yes")),
            "scenario:8: vehicles.rover.braked = 'yes', must be true or false");
  EXPECT_EQ(fault_of(with_line(2, "name: 5")),
            "scenario:2: name = 5, must be a text; put it in quotes to make it a text");
  EXPECT_EQ(fault_of(with_line(7, "    wheel_radius_m: 0.2\n    tags: one")),
            "scenario:8: vehicles.rover.tags = 'one', must be a list of texts");
  EXPECT_EQ(fault_of(with_line(7, "    wheel_radius_m: 0.2\n    inertia_kgm2: [1, x, 3]")),
            "scenario:8: vehicles.rover.inertia_kgm2[1] = 'x', must be a number in kg m2");
  EXPECT_EQ(fault_of(with_line(3, "world: flat")),
            "scenario:3: world = 'flat', must be a mapping like {type: flat}");
  EXPECT_EQ(fault_of(with_line(15, "  3")),
            "scenario:14: criteria = 3, must be a list of entries like {metric: "
            "rover.cross_track_rms_m, max: 0.05}");
}

TEST(ScenarioFault, RangeNamesValueUnitAndLimit) {
  EXPECT_EQ(fault_of(with_line(7, "    wheel_radius_m: 0.2\n    mass_kg: -5")),
            "scenario:8: vehicles.rover.mass_kg = -5 kg, must be > 0 kg");
  EXPECT_EQ(fault_of(with_line(7, "    wheel_radius_m: 0.2\n    wheels: 9")),
            "scenario:8: vehicles.rover.wheels = 9, must be >= 2 and <= 8");
  EXPECT_EQ(fault_of(with_line(7, "    wheel_radius_m: 0.2\n    inertia_kgm2: [1, 2]")),
            "scenario:8: vehicles.rover.inertia_kgm2 has 2 entries, must have 3");
  EXPECT_EQ(
      fault_of(with_line(7, "    wheel_radius_m: 0.2\n    soil: grvel")),
      "scenario:8: vehicles.rover.soil = 'grvel', must be one of: grass, gravel, mud; did you "
      "mean 'gravel'?");
  EXPECT_EQ(fault_of(with_line(7, "    wheel_radius_m: 0.2\n    motor: {torque_Nm: 0}")),
            "scenario:8: vehicles.rover.motor.torque_Nm = 0 N m, must be > 0 N m");
  EXPECT_EQ(fault_of(with_line(3, "world: {type: flat, posts: [{x_m: 1}, {x_m: 2, height_m: 9}]}")),
            "scenario:3: world.posts[1].height_m = 9 m, must be >= 0 m and <= 5 m");
  EXPECT_EQ(fault_of(with_line(2, "seed: -1")),
            "scenario:2: seed = -1, must be >= 0 and <= 9.223372036854776e+18");
}

TEST(ScenarioFault, NumbersMustBeFinite) {
  for (const char* value : {".nan", "nan", "NaN", ".inf", "-.inf", "inf", "-Infinity"}) {
    const std::string text = fault_of(with_line(13, "      lookahead_m: " + std::string(value)));
    EXPECT_EQ(text, "scenario:13: vehicles.rover.controller.lookahead_m = " + std::string(value) +
                        ", must be finite (a number in m, > 0)");
  }
  EXPECT_EQ(fault_of(with_line(13, "      lookahead_m: 1e999")),
            "scenario:13: vehicles.rover.controller.lookahead_m = inf, must be a finite number");
}

TEST(ScenarioFault, RateThatDoesNotDivideNamesBothNumbers) {
  EXPECT_EQ(fault_of(with_line(13, "      rate_Hz: 30")),
            "scenario:13: vehicles.rover.controller.rate_Hz = 30 Hz, its period of 0.033333333 s "
            "is not a "
            "whole number of physics steps of 0.001 s; 29.411765 Hz and 30.30303 Hz fit");
  // What is printed is accepted.
  EXPECT_EQ(fault_of(with_line(13, "      rate_Hz: 29.411765")), "");
  EXPECT_EQ(fault_of(with_line(13, "      rate_Hz: 30.30303")), "");
  EXPECT_EQ(fault_of(with_line(13, "      rate_Hz: 3000")),
            "scenario:13: vehicles.rover.controller.rate_Hz = 3000 Hz, its period of 0.000333333 s "
            "is not "
            "a whole number of physics steps of 0.001 s; 1000 Hz is the fastest");
  EXPECT_THAT(fault_of(with_line(2, "record: {truth_rate_Hz: 7}")),
              HasSubstr("scenario:2: record.truth_rate_Hz = 7 Hz, its period of 0.142857143 s"));
  EXPECT_EQ(fault_of(with_line(2, "record: {enabled: false, truth_rate_Hz: 7}")), "");
  // A default that a changed step no longer divides is a fault of the step's user, and named as
  // well.
  EXPECT_THAT(fault_of(with_line(2, "physics: {step_s: 0.002}")),
              HasSubstr("vehicles.rover.controller.rate_Hz = 40 Hz, its period of 0.025 s"));
  EXPECT_EQ(fault_of(with_line(2, "physics: {step_s: 0.0010000005}")),
            "scenario:2: physics.step_s = 0.0010000005 s, must be a whole number of nanoseconds");
  // Two million steps for half a second: nobody means it.
  EXPECT_THAT(fault_of(with_line(2, "physics: {step_s: 0.00000025}")),
              HasSubstr("physics.step_s = 2.5e-07 s, must be >= 1e-05 s and <= 0.1 s"));
}

TEST(ScenarioFault, UnknownPartTypeNamesTheNearestOrItsKind) {
  EXPECT_EQ(
      fault_of(with_line(12, "      type: pure_persuit")),
      "scenario:12: vehicles.rover.controller.type = 'pure_persuit': unknown controller; did you "
      "mean 'pure_pursuit'? (known: pure_pursuit, stop)");
  EXPECT_EQ(fault_of(with_line(11, "    guidance:")),
            "scenario:12: vehicles.rover.guidance.type = 'pure_pursuit' is a controller, must be a "
            "guidance (known: window)");
  EXPECT_EQ(
      fault_of(with_line(12, "")),
      "scenario:11: vehicles.rover.controller.type must be given, one of: pure_pursuit, stop");
}

TEST(ScenarioFault, MissingRequiredKeysAreNamed) {
  EXPECT_EQ(fault_of(with_line(1, "")),
            "scenario: vinerow must be given: the version of the file format, which is 1 "
            "('vinerow: 1')");
  EXPECT_EQ(fault_of(with_line(3, "")),
            "scenario: world must be given (terrain, rows and other fixed objects)");
  EXPECT_EQ(fault_of("vinerow: 1\nworld: {type: flat}\n"),
            "scenario: vehicles must be given (vehicles by name)");
  EXPECT_EQ(
      fault_of(with_line(7, "")),
      "scenario:5: vehicles.rover.wheel_radius_m must be given: a number in m, > 0 (unloaded)");
  EXPECT_EQ(fault_of(with_line(8, "")),
            "scenario:5: vehicles.rover.spawn must be given, one of {alley, offset_m, reverse, "
            "lateral_m, turn_deg}, {x_m, y_m, yaw_deg} or {point}");
  EXPECT_EQ(
      fault_of(with_line(3, "world: {type: flat, posts: [{height_m: 1}]}")),
      "scenario:3: world.posts[0].x_m must be given: a number in m, >= -1000 and <= 1000 (east)");
  EXPECT_EQ(
      fault_of(with_line(7, "    wheel_radius_m: {source: ruler}")),
      "scenario:7: vehicles.rover.wheel_radius_m: value must be given with source (a number in "
      "m, > 0)");
}

TEST(ScenarioFault, SpawnHasExactlyOneForm) {
  EXPECT_EQ(fault_of(with_line(8, "    spawn: {alley: 0, x_m: 1, y_m: 2}")),
            "scenario:8: vehicles.rover.spawn gives alley and x_m at once, must be one of {alley, "
            "offset_m, reverse, lateral_m, turn_deg}, {x_m, y_m, yaw_deg} or {point}");
  EXPECT_EQ(fault_of(with_line(8, "    spawn: {}")),
            "scenario:8: vehicles.rover.spawn is empty, must be one of {alley, offset_m, reverse, "
            "lateral_m, turn_deg}, {x_m, y_m, yaw_deg} or {point}");
  EXPECT_EQ(
      fault_of(with_line(8, "    spawn: {x_m: 1}")),
      "scenario:8: vehicles.rover.spawn.y_m must be given: a number in m, >= -10000000 and <= "
      "10000000 (north of the world's origin)");
}

TEST(ScenarioFault, VersionOfTheFormat) {
  EXPECT_EQ(fault_of(with_line(1, "vinerow: 2")),
            "scenario:1: vinerow = 2, this program reads version 1 of the file format");
  EXPECT_EQ(fault_of(with_line(1, "vinerow: one")),
            "scenario:1: vinerow = 'one', this program reads version 1 of the file format");
}

TEST(ScenarioFault, CriteriaAndCamerasNameVehicles) {
  EXPECT_EQ(
      fault_of(with_line(15, "  - {metric: rovr.cross_track_rms_m, max: 0.05}")),
      "scenario:15: criteria[0].metric = 'rovr.cross_track_rms_m': unknown vehicle 'rovr'; did "
      "you mean 'rover'? (known: rover)");
  EXPECT_EQ(
      fault_of(with_line(15, "  - {metric: cross_track_rms_m, max: 0.05}")),
      "scenario:15: criteria[0].metric = 'cross_track_rms_m', must be <vehicle>.<metric>, e.g. "
      "rover.cross_track_rms_m");
  EXPECT_EQ(fault_of(with_line(15, "  - {metric: rover.x}")),
            "scenario:15: criteria[0]: min or max must be given");
  EXPECT_EQ(fault_of(with_line(15, "  - {metric: rover.x, min: 3, max: 2}")),
            "scenario:15: criteria[0]: min = 3 is above max = 2");
  const std::string pictures = "pictures:\n  cameras:\n    c: ";
  EXPECT_EQ(
      fault_of(with_line(2, pictures + "{kind: chase, vehicle: rower}")),
      "scenario:4: pictures.cameras.c.vehicle: unknown vehicle 'rower'; did you mean 'rover'? "
      "(known: rover)");
  EXPECT_EQ(fault_of(with_line(2, pictures + "{kind: chasse}")),
            "scenario:4: pictures.cameras.c.kind = 'chasse', must be one of: fixed, chase, top, "
            "on_board, shots; did you mean 'chase'?");
  EXPECT_EQ(
      fault_of(with_line(2, pictures + "{kind: shots, sensor: gps}")),
      "scenario:4: pictures.cameras.c.sensor = 'gps', must be a camera_trigger of rover (known: "
      "none)");
  EXPECT_EQ(
      fault_of(with_line(2, pictures + "{kind: fixed, look_at_m: [0, 0, 0]}")),
      "scenario:4: pictures.cameras.c.position_m must be given: a list of 3 numbers in m (x, y and "
      "height above the ground)");
  EXPECT_EQ(fault_of(with_line(
                2, pictures + "{kind: fixed, position_m: [1, 2, -3], look_at_m: [1, 2, 0]}")),
            "scenario:4: pictures.cameras.c.position_m = [1, 2, -3]: the camera would not be above "
            "the ground, from which its height is measured");
  EXPECT_EQ(fault_of(with_line(
                2, pictures + "{kind: fixed, position_m: [1, 2, 3], look_at_m: [1, 2, 3]}")),
            "scenario:4: pictures.cameras.c.look_at_m is the camera's own place, must be another");
  EXPECT_THAT(fault_of(with_line(2, pictures + "{kind: top, distance_m: 3}")),
              HasSubstr("pictures.cameras.c.distance_m: unknown key of camera of kind 'top'"));
  EXPECT_EQ(
      fault_of(with_line(2, pictures + "{kind: top, centre_m: [1, 2]}")),
      "scenario:4: pictures.cameras.c.centre_m needs height_m > 0, the extent of the picture from "
      "south to north");
  EXPECT_EQ(
      fault_of(
          with_line(2, pictures + "{kind: top, centre_m: [1, 2], height_m: 9, vehicle: rover}")),
      "scenario:4: pictures.cameras.c: centre_m and vehicle are both given, must be one of them");
}

TEST(ScenarioFault, ANameIsOneOfAFolderInRuns) {
  for (const char* name : {"../../evil", "/tmp/x", "a/b", "..", "two words", "9lives"}) {
    EXPECT_EQ(fault_of(with_line(2, "name: '" + std::string(name) + "'")),
              "scenario:2: name = '" + std::string(name) +
                  "', must be made of letters, digits, '_' and '-' and start with a letter or '_' "
                  "(results go to runs/<name>)");
  }
}

TEST(ScenarioFault, PicturesWithoutEndAreRefused) {
  EXPECT_EQ(
      fault_of(with_line(2, "duration_s: 20\npictures: {every_s: 0.001}")),
      "scenario:3: pictures.every_s = 0.001 s makes 20000 frames of each camera in 20 s, must "
      "make at most 10000");
  EXPECT_EQ(fault_of(with_line(2, "duration_s: 20\npictures: {every_s: 0.002}")), "");
}

TEST(ScenarioFault, NumbersThatNoUnitCanMeanAreRefused) {
  const auto fault = [](const std::string& value) {
    return fault_of(with_line(13, "      lookahead_m: " + value));
  };
  const std::string place = "scenario:13: vehicles.rover.controller.lookahead_m = ";
  EXPECT_EQ(fault("9.2e18"), place + "9.2e+18 m, must be >= 1e-09 m and <= 10000000 m");
  EXPECT_EQ(fault("1e-308"), place + "1e-308 m, must be >= 1e-09 m and <= 10000000 m");
  EXPECT_EQ(fault("-1"), place + "-1 m, must be > 0 m");
}

TEST(ScenarioFault, NamesAreSimpleWords) {
  EXPECT_EQ(
      fault_of(with_line(5, "  ro.ver:")),
      "scenario:5: vehicles.ro.ver: the name of a vehicle is made of letters, digits, '_' and '-' "
      "and starts with a letter or '_'");
  EXPECT_EQ(
      fault_of(with_line(10, "      truth: {type: gps}")),
      "scenario:10: vehicles.rover.sensors.truth: a sensor cannot have the name of another signal "
      "(truth, estimate, plan, reference, links, actuators, follower, command, plan_tree, "
      "local_command, ellipsoid, estimator_state, contacts, map_edges, landing, authority)");
  EXPECT_EQ(fault_of(with_line(10, "      gps: {type: gps}\n      gps_truth: {type: gps}")),
            "scenario:11: vehicles.rover.sensors.gps_truth: a name cannot end in '_truth', which "
            "marks the error-free reading of a sensor");
}

TEST(ScenarioFault, NoPartIsWiredToTheTruth) {
  const auto fusion = [](const std::string& inputs) {
    return fault_of(
        with_line(11, "    estimator: {type: fusion, " + inputs + "}\n    controller:"));
  };
  const std::string end =
      " is a truth signal, which parts of a vehicle cannot read; must be the name of a sensor's "
      "signal";
  EXPECT_EQ(fusion("gps: gps"), "");
  EXPECT_EQ(fusion("gps: truth"), "scenario:11: vehicles.rover.estimator.gps = 'truth'" + end);
  EXPECT_EQ(fusion("gps: gps_truth"),
            "scenario:11: vehicles.rover.estimator.gps = 'gps_truth'" + end);
  EXPECT_EQ(fusion("gps: drone/gps_truth"),
            "scenario:11: vehicles.rover.estimator.gps = 'drone/gps_truth'" + end);
  EXPECT_EQ(fusion("ranges: [us_left, us_right_truth]"),
            "scenario:11: vehicles.rover.estimator.ranges = 'us_right_truth'" + end);
  // A named choice of a parameter may be the truth: the scenario then states it openly.
  EXPECT_EQ(fusion("heading: truth"), "");
  EXPECT_EQ(fault_of(with_line(11,
                               "    observers: {ekf: {type: fusion, gps: gps_truth}}\n"
                               "    controller:")),
            "scenario:11: vehicles.rover.observers.ekf.gps = 'gps_truth'" + end);
}

TEST(ScenarioFault, NamesOfSignalsOfOtherPartsAreTaken) {
  const std::string writes = "the vehicle 'cart' writes (wheels, battery); give it another name";
  EXPECT_EQ(fault_of(with_line(10, "      gps: {type: gps}\n      wheels: {type: imu}")),
            "scenario:11: vehicles.rover.sensors.wheels: a sensor cannot have the name of a signal "
            "that " +
                writes);
  EXPECT_EQ(fault_of(with_line(11, "    observers: {battery: {type: filter}}\n    controller:")),
            "scenario:11: vehicles.rover.observers.battery: an observer cannot have the name of a "
            "signal that " +
                writes);
  EXPECT_EQ(fault_of(with_line(10, "      wheel: {type: gps}")), "");
}

TEST(ScenarioFault, ObserversHaveNamesOfTheirOwn) {
  const auto observers = [](const std::string& names) {
    return fault_of(with_line(11, "    observers: {" + names + "}\n    controller:"));
  };
  EXPECT_EQ(observers("a: {type: filter}, a_b: {type: filter}"), "");
  EXPECT_EQ(
      observers("estimate: {type: filter}"),
      "scenario:11: vehicles.rover.observers.estimate: an observer cannot have the name of "
      "another signal (truth, estimate, plan, reference, links, actuators, follower, command, "
      "plan_tree, local_command, ellipsoid, estimator_state, contacts, map_edges, landing, "
      "authority)");
  EXPECT_EQ(observers("gps: {type: filter}"),
            "scenario:11: vehicles.rover.observers.gps: its signal 'gps' has the name of the "
            "sensor 'gps'");
  EXPECT_EQ(observers("a: {type: filter}, a_state: {type: filter}"),
            "scenario:11: vehicles.rover.observers.a_state: its signal 'a_state' has the name of "
            "the observer 'a'");
  EXPECT_EQ(
      observers("a: {type: gps}"),
      "scenario:11: vehicles.rover.observers.a.type = 'gps' is a sensor, must be an estimator "
      "(known: filter, fusion)");
  EXPECT_EQ(observers("a: {type: filtr}"),
            "scenario:11: vehicles.rover.observers.a.type = 'filtr': unknown estimator; did you "
            "mean 'filter'? (known: filter, fusion)");
}

TEST(ScenarioFault, DuplicateKeysNameBothLines) {
  EXPECT_EQ(fault_of(with_line(14, "      lookahead_m: 0.7\ncriteria:")),
            "scenario:14: the key 'lookahead_m' is given twice in one mapping, first in line 13");
}

TEST(ScenarioFault, SyntaxErrorsNameTheLine) {
  EXPECT_EQ(fault_of(with_line(7, "\twheel_radius_m: 0.2")),
            "scenario:7: is indented with a tab; YAML is indented with spaces");
  EXPECT_THAT(
      fault_of(with_line(8, "    spawn: {alley: 0")),
      ::testing::MatchesRegex(
          "scenario:[0-9]+: is not valid YAML: the '\\{' of line 8 is not closed by '\\}'"));
  EXPECT_THAT(
      fault_of(with_line(8, "    spawn: [alley, 0")),
      ::testing::MatchesRegex(
          "scenario:[0-9]+: is not valid YAML: the '\\[' of line 8 is not closed by '\\]'"));
  EXPECT_EQ(fault_of(with_line(7, "    wheel_radius_m: 0.2: 3")),
            "scenario:7: is not valid YAML: a ':' is not allowed here: is a text with ': ' not "
            "in quotes?");
  EXPECT_EQ(fault_of(std::string("vinerow: 1\nname: a\x01z\n")),
            "scenario:2: holds the control character 0x01; a scenario is plain text");
  const std::string not_closed = "is not valid YAML: a quotation mark from here on is not closed";
  EXPECT_EQ(fault_of(with_line(6, "    type: \"test_vehicle")), "scenario:6: " + not_closed);
  EXPECT_EQ(fault_of("vinerow: 1\ndescription: 'hello"), "scenario:2: " + not_closed);
  EXPECT_EQ(fault_of("vinerow: 1\ndescription: 'hello\n"), "scenario:2: " + not_closed);
  EXPECT_EQ(fault_of("vinerow: 1\ndescription: '"), "scenario:2: " + not_closed);
  EXPECT_EQ(fault_of("vinerow: 1\n# Pf\xe4hle\n"),  // Latin-1
            "scenario:2: holds the byte 0xe4, which is not UTF-8; save the file in this encoding");
  EXPECT_EQ(fault_of("vinerow: 1\n---\nvinerow: 1\n"),
            "scenario:3: starts a second document ('---'); a file holds one");
  EXPECT_EQ(fault_of(with_line(7, "    <<: {wheel_radius_m: 0.2}")),
            "scenario:7: merge keys ('<<') are not supported; use 'include: file.yaml'");
  EXPECT_EQ(
      fault_of(with_line(7, "    wheel_radius_m: !!float 0.2")),
      "scenario:7: the tag 'tag:yaml.org,2002:float' is not supported; write the value without it");
  EXPECT_EQ(fault_of(with_line(7, "    [a]: 0.2")), "scenario:7: a list is in the place of a key");
}

TEST(ScenarioFault, EmptyFileAndOtherRoots) {
  const std::string empty = "scenario: the file is empty; a scenario starts with 'vinerow: 1'";
  EXPECT_EQ(fault_of(""), empty);
  EXPECT_EQ(fault_of("# only a comment\n"), empty);
  EXPECT_EQ(fault_of("- 1\n"),
            "scenario:1: the file holds a list, must be a mapping ('key: value' lines)");
}

TEST(ScenarioFault, ValuesAreShownInOneShortLine) {
  const std::string text =
      fault_of(with_line(13, "      lookahead_m: \"two\\nlines " + std::string(500, 'x') + "\""));
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_LT(text.size(), 250u);
}

TEST(ScenarioFault, MissingFilesNameWhatReferredToThem) {
  const TemporaryFolder folder;
  folder.write("data/rows.geojson", "{}");
  const auto file =
      folder.write("a.yaml", with_line(3, "world: {type: flat, rows_file: data/row.geojson}"));
  EXPECT_EQ(fault_of_file(file), file.string() +
                                     ":3: world.rows_file = 'data/row.geojson': no such file "
                                     "(looked for " +
                                     (folder.path() / "data/row.geojson").string() +
                                     "); did you mean 'rows.geojson'?");
  EXPECT_EQ(fault_of_file(folder.path() / "b.yaml"),
            (folder.path() / "b.yaml").string() + ": no such file; did you mean 'a.yaml'?");
  EXPECT_EQ(fault_of_file(folder.path()), folder.path().string() + ": is a folder, not a file");
}

TEST(ScenarioFault, MissingIncludeNamesTheIncluder) {
  const TemporaryFolder folder;
  folder.write("vehicles/cart.yaml", "type: cart\n");
  const auto file = folder.write("s/a.yaml", with_line(6, "    include: ../vehicles/card.yaml"));
  EXPECT_EQ(fault_of_file(file),
            file.string() +
                ":6: vehicles.rover.include = '../vehicles/card.yaml': no such file (looked "
                "for " +
                (folder.path() / "vehicles/card.yaml").string() + "); did you mean 'cart.yaml'?");
  EXPECT_EQ(
      fault_of(with_line(6, "    include: 3")),
      "scenario:6: vehicles.rover.include = 3, must be the path of a file or a list of such paths");
}

TEST(ScenarioFault, CyclicIncludeNamesTheChain) {
  const TemporaryFolder folder;
  const auto a = folder.write("a.yaml", "vinerow: 1\ninclude: b.yaml\n");
  const auto b = folder.write("b.yaml", "world: {include: c.yaml}\n");
  const auto c = folder.write("c.yaml", "include: a.yaml\n");
  EXPECT_EQ(fault_of_file(a), c.string() +
                                  ":1: world.include = 'a.yaml': the files include each other "
                                  "in a cycle (" +
                                  a.string() + " -> " + b.string() + " -> " + c.string() + " -> " +
                                  a.string() + ")");
  const auto self = folder.write("self.yaml", "include: self.yaml\n");
  EXPECT_THAT(fault_of_file(self),
              EndsWith("in a cycle (" + self.string() + " -> " + self.string() + ")"));
}

TEST(ScenarioFault, FaultInAnIncludedFileNamesThatFile) {
  const TemporaryFolder folder;
  const auto cart = folder.write("cart.yaml", "type: cart\nmass_kg: -1\n");
  folder.write("empty.yaml", "# nothing\n");
  const auto file = folder.write("a.yaml", with_line(6, "    include: cart.yaml"));
  EXPECT_EQ(fault_of_file(file),
            cart.string() + ":2: vehicles.rover.mass_kg = -1 kg, must be > 0 kg");
  const auto other = folder.write("b.yaml", with_line(6, "    include: empty.yaml"));
  EXPECT_EQ(fault_of_file(other),
            other.string() + ":6: vehicles.rover.include = 'empty.yaml': the file is empty");
}

TEST(ScenarioFault, OverridesNameTheirText) {
  const auto fault = [](const std::string& set) { return fault_of(kCartScenario, {{set}, {}}); };
  EXPECT_EQ(
      fault("rovr.controller.lookahead_m=1").substr(0, 90),
      "--set rovr.controller.lookahead_m=1: unknown path 'rovr'; did you mean 'rover'? (known: vi");
  EXPECT_EQ(
      fault("rover.controller.lookahed_m=1"),
      "--set rover.controller.lookahed_m=1: vehicles.rover.controller.lookahed_m: unknown key of "
      "controller 'pure_pursuit'; did you mean 'lookahead_m'? " +
          std::string(kPursuitKeys));
  EXPECT_EQ(
      fault("rover.controller.lookahead_m=-1"),
      "--set rover.controller.lookahead_m=-1: vehicles.rover.controller.lookahead_m = -1 m, must "
      "be > 0 m");
  EXPECT_EQ(fault("rover.controller.lookahead_m={a: [1"),
            "--set rover.controller.lookahead_m={a: [1: the value '{a: [1' is not valid YAML");
  EXPECT_EQ(
      fault("rover.mass_kg"),
      "--set rover.mass_kg: must have the form path=value, e.g. rover.controller.lookahead_m=0.5");
  EXPECT_EQ(fault("rover..mass_kg=1"),
            "--set rover..mass_kg=1: the path 'rover..mass_kg' has an empty key; write it like "
            "rover.controller.rate_Hz");
  EXPECT_EQ(fault("criteria.1.max=1"),
            "--set criteria.1.max=1: criteria is a list, its entries are 0 to 0, not '1'");
  EXPECT_EQ(fault("rover.inertia_kgm2.0=1"),
            "--set rover.inertia_kgm2.0=1: vehicles.rover.inertia_kgm2 is not given, so it has no "
            "entry 0; set the whole list: vehicles.rover.inertia_kgm2=[...]");
  EXPECT_EQ(fault("rover.wheel_radius_m.x=1"),
            "--set rover.wheel_radius_m.x=1: vehicles.rover.wheel_radius_m = 0.2 has no key 'x'");
}

}  // namespace
}  // namespace vinerow::scenario::test::scenario_fault_test

#pragma once
/// Small parts that only have specs, and a scenario that uses them: what the tests of scenario
/// files read.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "engine/core/error.h"
#include "engine/scenario/scenario.h"
#include "tests/support/spec_makers.h"

namespace vinerow::scenario::test {

inline PartSpec fake_spec(std::string name, std::vector<ParameterSpec> parameters,
                          double default_rate_Hz = 0.0) {
  PartSpec spec;
  spec.name = std::move(name);
  spec.description = "a part for tests";
  spec.parameters = std::move(parameters);
  spec.default_rate_Hz = default_rate_Hz;
  return spec;
}

inline Registry fake_registry() {
  Registry registry;
  registry.add_world(
      fake_spec("flat", {positive_parameter("size_m", "m", 100.0, "edge length"),
                         path_parameter("rows_file", "rows as GeoJSON"),
                         group_list_parameter(
                             "posts",
                             {required(number_parameter("x_m", "m", 0, -1e3, 1e3, "east")),
                              number_parameter("height_m", "m", 2.0, 0.0, 5.0, "above ground")},
                             "single posts")}),
      nullptr);
  const std::vector<ParameterSpec> speed = {positive_parameter("speed_mps", "m/s", 1.0, "mean")};
  registry.add_world(fake_spec("hilly", {number_parameter("slope_deg", "deg", 5.0, -45.0, 45.0,
                                                          "positive where x rises"),
                                         group_parameter("wind", speed, "of the air"),
                                         group_parameter("gust", speed, "of its gusts")}),
                     nullptr);
  PartSpec cart =
      fake_spec("cart",
                {positive_parameter("mass_kg", "kg", 100.0, "with battery"),
                 required(positive_parameter("wheel_radius_m", "m", 0.2, "unloaded")),
                 number_list_parameter("inertia_kgm2", "kg m2", {1.0, 2.0, 3.0}, "diagonal", 3),
                 choice_parameter("soil", "grass", {"grass", "gravel", "mud"}, "of the wheels"),
                 text_list_parameter("tags", {}, "free words"),
                 boolean_parameter("braked", false, "at the start"),
                 integer_parameter("wheels", 4, 2, 8, "how many"),
                 group_parameter("motor",
                                 {positive_parameter("torque_Nm", "N m", 50.0, "peak"),
                                  path_parameter("map_file", "efficiency map")},
                                 "of each wheel")});
  cart.writes = {"wheels: NamedValues", "battery", "<name>_event"};
  registry.add_vehicle(cart, nullptr);
  registry.add_map(
      fake_spec("survey", {number_parameter("offset_m", "m", 0.0, -10.0, 10.0, "to the east")}),
      nullptr);
  registry.add_sensor(
      fake_spec("gps", {number_parameter("noise_m", "m", 0.02, 0.0, 100.0, "1 sigma")}, 5.0),
      nullptr);
  registry.add_sensor(fake_spec("imu", {}, 0.0), nullptr);
  PartSpec survey_camera = fake_spec("survey_camera", {}, 0.0);
  survey_camera.gives = ProductKind::kPictures;
  registry.add_sensor(survey_camera, nullptr);
  registry.add_estimator(
      fake_spec("filter", {positive_parameter("gain", "", 0.5, "of updates")}, 20.0), nullptr);
  registry.add_estimator(
      fake_spec("fusion",
                {text_parameter("gps", "gps", "signal of the receiver"),
                 text_list_parameter("ranges", {}, "signals"),
                 choice_parameter("heading", "gyro", {"gyro", "truth"}, "where from")},
                20.0),
      nullptr);
  registry.add_planner(
      fake_spec("coverage", {integer_parameter("first_alley", 0, 0, 1000, "start")}), nullptr);
  registry.add_guidance(fake_spec("window", {}, 10.0), nullptr);
  registry.add_controller(
      fake_spec("pure_pursuit",
                {positive_parameter("lookahead_m", "m", 0.75, "to the target point"),
                 number_parameter("max_speed_mps", "m/s", 1.0, 0.0, 10.0, "on legs")},
                40.0),
      nullptr);
  registry.add_controller(fake_spec("stop", {}, 20.0), nullptr);
  registry.add_metric(fake_spec("deviation", {}, 40.0), nullptr);
  registry.add_metric(fake_spec("distance", {}, 0.0), nullptr);
  registry.add_metric(
      fake_spec("picky", {required(text_parameter("what", "", "to measure"))}, 20.0), nullptr);
  return registry;
}

/// Complete and without a fault; line numbers of the tests count in it.
inline const char* kCartScenario = R"(vinerow: 1
name: cart_test
world: {type: flat}
vehicles:
  rover:
    type: cart
    wheel_radius_m: 0.2
    spawn: {alley: 0, offset_m: 3.0}
    sensors:
      gps: {type: gps}
    controller:
      type: pure_pursuit
      lookahead_m: 0.5
criteria:
  - {metric: rover.cross_track_rms_m, max: 0.05}
)";

/// The scenario with one line (from 1) replaced; the new text may have several lines or be empty.
inline std::string with_line(int number, const std::string& line) {
  const std::string text = kCartScenario;
  std::string result;
  std::size_t begin = 0;
  for (int i = 1; begin < text.size(); ++i) {
    const std::size_t end = text.find('\n', begin) + 1;
    if (i != number) {
      result += text.substr(begin, end - begin);
    } else if (!line.empty()) {
      result += line + "\n";
    }
    begin = end;
  }
  return result;
}

/// A folder of its own for one test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "vinerow-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// Text of the ConfigError that loading gives, or "" where it loads.
inline std::string fault_of(const std::string& yaml, const Overrides& overrides = {},
                            const std::filesystem::path& folder = "/") {
  try {
    parse_scenario(yaml, folder, fake_registry(), overrides);
    return "";
  } catch (const ConfigError& fault) {
    return fault.what();
  }
}

inline std::string fault_of_file(const std::filesystem::path& file) {
  try {
    load_scenario(file, fake_registry());
    return "";
  } catch (const ConfigError& fault) {
    return fault.what();
  }
}

}  // namespace vinerow::scenario::test

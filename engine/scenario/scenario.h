#pragma once
/// Loaded scenario: all values are checked against the specs of the parts, all paths are absolute.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/core/time.h"
#include "engine/io/files/source_mark.h"
#include "engine/io/files/yaml.h"
#include "engine/math/angles.h"

namespace vinerow::scenario {

/// A parameter that the user gave.
struct GivenKey {
  std::string name;  ///< without the groups around it
  io::SourceMark where;
  bool is_group = false;
};

/// A part as named in a scenario: `type`, `rate_Hz`, and its parameters at the same level.
struct PartConfig {
  std::string type;
  /// The given rate or the spec's default. If that default is 0: the physics step's rate for
  /// sensors and controllers, and 0 ("as often as the controller") for estimators, guidance and
  /// metrics. 0 also if the kind has no rate.
  double rate_Hz = 0.0;
  ParameterSet parameters;
  io::SourceMark where;
  std::vector<GivenKey> given;

  /// Where the user finds what a sentence about the part speaks of: a value of a study or --set
  /// that it names, else another given key that it names, else the part.
  const io::SourceMark& place_of(const std::string& sentence) const;
};

/// Start pose of a vehicle: a pose, a spawn point of the world, or an alley's entrance.
struct SpawnConfig {
  std::optional<Eigen::Vector2d> p_W;  ///< x_m, y_m
  double yaw_rad = 0.0;                ///< yaw_deg
  std::string point;                   ///< name of a WorldModel spawn point
  std::optional<int>
      alley;  ///< start on this alley's centre line, `offset_m` before its first point
  double offset_m = 0.0;
  bool reverse = false;    ///< start at the alley's last point, driving towards the first
  double lateral_m = 0.0;  ///< from that start to the left, as seen along the alley
  double turn_rad = 0.0;   ///< from the alley's direction to the left
  io::SourceMark where;
};

struct NamedPart {
  std::string name;
  PartConfig part;
};

/// Consequence of a crash for the run. The run fails either way.
enum class OnCrash {
  kEnd,  ///< the run ends immediately
  kFail  ///< the run continues for the other vehicles
};

struct VehicleConfig {
  std::string name;
  PartConfig vehicle;
  SpawnConfig spawn;
  OnCrash on_crash = OnCrash::kEnd;
  std::optional<PartConfig> map;        ///< absent: the vehicle knows the true rows
  std::vector<NamedPart> sensors;       ///< in file order
  std::optional<PartConfig> estimator;  ///< absent: estimate = truth
  std::vector<NamedPart> observers;     ///< further estimators, in file order
  std::optional<PartConfig> planner;
  std::optional<PartConfig> guidance;
  std::optional<PartConfig> controller;
  std::optional<PartConfig> autopilot;  ///< in place of estimator, guidance and controller
  std::vector<NamedPart> payloads;      ///< in file order
  io::SourceMark where;

  /// Its estimate is the truth: it has neither an estimator of its own nor firmware that reports
  /// one.
  bool estimate_is_truth() const;
};

enum class CameraKind { kFixed, kChase, kTop, kOnBoard, kShots };

struct CameraConfig {
  std::string name;
  CameraKind kind = CameraKind::kChase;
  std::string vehicle;                      ///< chase, on board, shots; top: follows it if given
  Eigen::Vector3d p_W = {0, 0, 10};         ///< fixed: position_m; z is above the ground
  Eigen::Vector3d target_W = {0, 0, 0};     ///< fixed: look_at_m
  std::optional<Eigen::Vector2d> centre_W;  ///< top: centre_m, the middle of the picture
  double distance_m = 6.0;                  ///< chase: behind the vehicle
  double height_m = 2.5;  ///< chase: above the vehicle; top: extent of the picture from south to
                          ///< north (0 = fits the world)
  Eigen::Vector3d offset_B = {0.3, 0, 0.6};  ///< on board
  double yaw_rad = 0.0;    ///< yaw_deg: chase, orbit angle from behind; on board, view direction
  double pitch_rad = 0.0;  ///< pitch_deg: on board, positive looks down
  double fov_rad = rad_from_deg(55.0);  ///< fov_deg, vertical
  bool show_sensor_rays = false;
  bool show_trail = true;
  bool show_plan = true;
  bool show_grid = false;         ///< the occupancy grid, of the log or the world
  bool show_tree = false;         ///< search trees of the planners
  bool show_estimate = false;     ///< estimates of vehicles and observers
  bool show_map = false;          ///< row meshes of the vehicles' maps
  std::string sensor = "camera";  ///< shots: the sensor whose pictures are drawn
  int every = 10;                 ///< shots: only every n-th picture is drawn
  io::SourceMark where;
};

/// Instant of a mission: a time after the start of a phase.
struct PhaseMoment {
  std::string phase;
  double after_s = 0.0;
  io::SourceMark where;
};

/// Limit on the frames of one camera at regular intervals; more are rejected as a likely mistake.
inline constexpr double kMaxPictureInstants = 10'000.0;

struct PicturesConfig {
  int width = 1280;
  int height = 720;
  int samples = 2;                        ///< antialiasing, 1..9
  std::vector<double> times_s;            ///< frames at these times
  std::vector<std::string> moment_texts;  ///< as written: "spray + 30"
  std::vector<PhaseMoment> moments;       ///< and at these instants of a mission
  double every_s = 0.0;                   ///< and at this interval; 0 = none
  std::vector<double>
      shares;  ///< and at these shares of the run's end (0..1), e.g. 1.0 = last instant
  std::vector<CameraConfig> cameras;
};

struct RecordConfig {
  bool enabled = true;
  double truth_rate_Hz = 20.0;  ///< log rate of truth, links and wheel states
  double sensor_rate_limit_Hz =
      100.0;  ///< faster sensors are thinned in the log (never in the simulation)
  std::string compression = "zstd";  ///< zstd | lz4 | none
};

/// A limit on a metric: `rover.cross_track_rms_m` at most / at least this.
struct Criterion {
  std::string name;    ///< default: the metric and the limit
  std::string metric;  ///< "<vehicle>.<metric>"
  std::optional<double> min;
  std::optional<double> max;
  io::SourceMark where;
};

/// Product that a phase takes: `map: from build_map`, or `pictures: from survey/plane/camera` if
/// the other phase gives several.
struct ProductSource {
  std::string key;    ///< "map"
  std::string phase;  ///< the producer
  std::string item;   ///< "plane/camera"; "" if the phase gives only one
  ProductKind kind = ProductKind::kMap;
  io::SourceMark where;
};

/// Consequence of a failed phase for the mission. Phases that wait for it are blocked.
enum class OnFailure {
  kAbort,    ///< the mission ends immediately
  kContinue  ///< phases that do not wait for the failed one continue
};

/// Weather condition for the start of a phase: weak wind for a certain time.
struct WeatherWindow {
  double max_wind_mps = 0.0;  ///< mean over `over_s`
  double height_m = 10.0;     ///< above the ground in the middle of the parcel
  double over_s = 30.0;
  double wait_s = 600.0;  ///< without such a window for this time, the phase fails
};

/// A node of the mission's graph: vehicles at work, or a job.
struct PhaseConfig {
  std::string name;
  std::vector<std::string> vehicles;  ///< empty: a job
  std::optional<PartConfig> job;
  std::vector<std::string> after;    ///< phases that must have succeeded, those of `takes` included
  std::vector<ProductSource> takes;  ///< in the order of the file
  double timeout_s = 0.0;            ///< of vehicles, from the phase's start; 0: no limit
  double duration_s = 0.0;           ///< of a job, in simulated time
  OnFailure on_failure = OnFailure::kAbort;
  std::optional<WeatherWindow> weather;
  /// Metrics are "<vehicle>.<metric>", or a number of the job.
  std::vector<Criterion> criteria;
  io::SourceMark where;
};

/// Vehicles that share the alleys by reservation, so that they do not meet between the rows.
struct TrafficConfig {
  std::vector<std::string> vehicles;  ///< in order of priority; empty: alleys are not reserved
  double stop_before_m = 1.0;         ///< distance before an occupied alley
  io::SourceMark where;
};

/// A run in which simulated time waits for the command of a program outside.
struct LockstepConfig {
  std::string signal;  ///< key `topic`: "rover/cmd_vel"; empty: no lock-step
  double rate_Hz = 20.0;
  Duration period{50'000'000};  ///< of the rate; a command is due at each multiple of it but 0
  double timeout_s = 10.0;      ///< wall time that the run waits for one command
  bool ends_on_timeout = true;  ///< false: the run goes on without commands until the next one
  io::SourceMark where;
};

struct Scenario {
  std::string name;
  std::string description;
  std::filesystem::path file;  ///< absolute; empty for a scenario from text
  std::uint64_t seed = 1;
  double duration_s = 60.0;        ///< the run ends here at the latest
  bool stop_when_finished = true;  ///< end when every controller has finished
  Duration physics_step{1'000'000};
  double gravity_mps2 = 9.80665;
  PartConfig world;
  std::vector<VehicleConfig> vehicles;  ///< in file order
  std::vector<NamedPart> metrics;       ///< run for every vehicle
  std::vector<PhaseConfig> phases;      ///< in file order; empty: every vehicle starts at once
  TrafficConfig traffic;
  LockstepConfig lockstep;
  std::vector<Criterion> criteria;
  RecordConfig record;
  PicturesConfig pictures;
  std::vector<std::filesystem::path> plugins;
  std::string resolved_yaml;               ///< includes and overrides applied, defaults written out
  std::vector<std::string> warnings = {};  ///< "file.yaml:12: ..." about former names of keys
};

/// Value for a key path. Errors name the value's own mark; relative paths in it start at its own
/// folder.
struct OverrideValue {
  std::string path;  ///< "rover.controller.lookahead_m"; `vehicles.` may be omitted
  io::YamlNode value;
};

/// Values that override those of the file: first `values`, then `sets`, each in order.
struct Overrides {
  std::vector<std::string> sets;  ///< of the command line: "rover.controller.lookahead_m=0.5"
  std::optional<std::uint64_t> seed;
  std::vector<OverrideValue> values = {};  ///< of a study
};

/// Reads only the plug-in list. It comes first because plug-ins extend the registry that the rest
/// is checked against. Only overrides of `plugins` are applied.
/// @returns absolute paths of existing files
std::vector<std::filesystem::path> load_plugin_list(const std::filesystem::path& file,
                                                    const Overrides& overrides = {});

/// The same of a scenario as a mapping without marks; relative paths start at `folder`.
std::vector<std::filesystem::path> parse_plugin_list(io::YamlNode tree,
                                                     const std::filesystem::path& folder,
                                                     const Overrides& overrides = {});

/// Scenario file that is read once and loaded with different overrides.
class ScenarioSource {
 public:
  /// Reads the file and its includes. @throws ConfigError
  explicit ScenarioSource(const std::filesystem::path& file);
  /// Applies overrides and checks all values. @throws ConfigError with "file:line: key = value,
  /// ..." in one sentence
  Scenario load(const Registry& registry, const Overrides& overrides = {}) const;
  /// The file with its includes merged in.
  const io::YamlNode& tree() const { return tree_; }

 private:
  std::filesystem::path file_;
  io::YamlNode tree_;
};

/// Loads one scenario from a file; exceptions as in ScenarioSource.
Scenario load_scenario(const std::filesystem::path& file, const Registry& registry,
                       const Overrides& overrides = {});
/// The same from text; relative paths start at `folder`, or at the current folder if it is empty.
/// @param name  of the text, in errors
Scenario parse_scenario(const std::string& yaml, const std::filesystem::path& folder,
                        const Registry& registry, const Overrides& overrides = {},
                        const std::string& name = "scenario");
/// The same from a mapping without marks, made by a program; errors then name the key alone.
Scenario parse_scenario(io::YamlNode tree, const std::filesystem::path& folder,
                        const Registry& registry, const Overrides& overrides = {});

/// JSON Schema (draft 2020-12) of scenario files for exactly the parts in the registry.
std::string scenario_json_schema(const Registry& registry);

}  // namespace vinerow::scenario

#pragma once
/// A scenario as loaded: every value checked against the specs of the parts it names, every path
/// absolute.

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

/// A part as named in a scenario: `type`, `rate_Hz`, and its parameters at the same level.
struct PartConfig {
  std::string type;
  /// The given one or the spec's default. Where that default is 0: the physics step's rate for
  /// sensors and controllers, and 0 ("as often as the controller") for estimators, guidance and
  /// metrics. 0 also where the kind has no rate.
  double rate_Hz = 0.0;
  ParameterSet parameters;
  io::SourceMark where;
};

/// How a vehicle starts. Either a pose, a spawn point of the world, or an alley's entrance.
struct SpawnConfig {
  std::optional<Eigen::Vector2d> p_W;  ///< x_m, y_m
  double yaw_rad = 0.0;                ///< yaw_deg
  std::string point;                   ///< name of a WorldModel spawn point
  std::optional<int>
      alley;  ///< start on this alley's centre line, `offset_m` before its first point
  double offset_m = 0.0;
  bool reverse = false;  ///< start at the alley's last point, driving towards the first
  io::SourceMark where;
};

struct NamedPart {
  std::string name;
  PartConfig part;
};

/// What becomes of a run in which a vehicle crashes. Its verdict is failed either way.
enum class OnCrash {
  kEnd,  ///< the run ends at that instant
  kFail  ///< it goes on for the others
};

struct VehicleConfig {
  std::string name;
  PartConfig vehicle;
  SpawnConfig spawn;
  OnCrash on_crash = OnCrash::kEnd;
  std::optional<PartConfig> map;        ///< absent: the vehicle knows the true rows
  std::vector<NamedPart> sensors;       ///< in file order
  std::optional<PartConfig> estimator;  ///< absent: estimate = truth
  std::vector<NamedPart> observers;     ///< estimators beside it, in file order
  std::optional<PartConfig> planner;
  std::optional<PartConfig> guidance;
  std::optional<PartConfig> controller;
  std::vector<NamedPart> payloads;  ///< in file order
  io::SourceMark where;
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
  double height_m = 2.5;  ///< chase: above the vehicle; top: what the picture shows from south to
                          ///< north (0 = fits the world)
  Eigen::Vector3d offset_B = {0.3, 0, 0.6};  ///< on board
  double yaw_rad = 0.0;    ///< yaw_deg: chase, orbit angle from behind; on board, view direction
  double pitch_rad = 0.0;  ///< pitch_deg: on board, positive looks down
  double fov_rad = rad_from_deg(55.0);  ///< fov_deg, vertical
  bool show_sensor_rays = false;
  bool show_trail = true;
  bool show_plan = true;
  bool show_grid = false;         ///< the occupancy grid, of the log or the world
  bool show_tree = false;         ///< what planners searched
  bool show_estimate = false;     ///< the estimates of vehicles and observers
  bool show_map = false;          ///< the row meshes of vehicles' own maps
  std::string sensor = "camera";  ///< shots: whose pictures are drawn
  int every = 10;                 ///< shots: those whose index is a multiple of it
  io::SourceMark where;
};

/// A moment of a mission: so long after a phase began.
struct PhaseMoment {
  std::string phase;
  double after_s = 0.0;
  io::SourceMark where;
};

/// Frames of one camera at regular intervals that are drawn without asking whether that was meant.
inline constexpr double kMostPictureInstants = 10'000.0;

struct PicturesConfig {
  int width = 1280;
  int height = 720;
  int samples = 4;                        ///< antialiasing, 1..8
  std::vector<double> times_s;            ///< frames at these times
  std::vector<std::string> moment_texts;  ///< as written: "spray + 30"
  std::vector<PhaseMoment> moments;       ///< and at these moments of a mission
  double every_s = 0.0;                   ///< and every so often; 0 = not
  std::vector<double>
      shares;  ///< and at these shares of the run's end (0..1), e.g. 1.0 = last instant
  std::vector<CameraConfig> cameras;
};

struct RecordConfig {
  bool enabled = true;
  double truth_rate_Hz = 20.0;  ///< how often truth, links and wheel states go into the log
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

/// A product that a phase takes: `map: from build_map`, or `pictures: from survey/plane/camera`
/// where a phase gives several.
struct ProductSource {
  std::string key;    ///< "map"
  std::string phase;  ///< that gives it
  std::string item;   ///< "plane/camera"; "" where the phase gives one alone
  ProductKind kind = ProductKind::kMap;
  io::SourceMark where;
};

/// What becomes of a mission in which a phase fails. What waits for that phase is blocked.
enum class OnFailure {
  kAbort,    ///< it ends at that instant
  kContinue  ///< phases that do not wait for the failed one go on
};

/// A phase begins when the wind has been weak enough for a while.
struct WeatherWindow {
  double max_wind_mps = 0.0;  ///< mean over `over_s`
  double height_m = 10.0;     ///< above the ground in the middle of the parcel
  double over_s = 30.0;
  double wait_s = 600.0;  ///< after so long without such a window the phase fails
};

/// A node of the mission's graph: vehicles at work, or a job.
struct PhaseConfig {
  std::string name;
  std::vector<std::string> vehicles;  ///< empty: a job
  std::optional<PartConfig> job;
  std::vector<std::string> after;    ///< phases that must have succeeded, those of `takes` included
  std::vector<ProductSource> takes;  ///< in the order of the file
  double timeout_s = 0.0;            ///< of vehicles, from the phase's begin; 0: as long as the run
  double duration_s = 0.0;           ///< of a job, in simulated time
  OnFailure on_failure = OnFailure::kAbort;
  std::optional<WeatherWindow> weather;
  /// Metrics are "<vehicle>.<metric>", those of a job its numbers.
  std::vector<Criterion> criteria;
  io::SourceMark where;
};

/// Who shares the alleys, so that nobody meets another between the rows.
struct TrafficConfig {
  std::vector<std::string> vehicles;  ///< first served first; empty: alleys are not reserved
  double stop_before_m = 1.0;         ///< before an alley that another one has
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
  std::vector<Criterion> criteria;
  RecordConfig record;
  PicturesConfig pictures;
  std::vector<std::filesystem::path> plugins;
  std::string resolved_yaml;  ///< includes and overrides applied, defaults written out
};

/// A value for a key path. Errors name the value's own mark, and a relative path in it starts at
/// its own folder.
struct OverrideValue {
  std::string path;  ///< "rover.controller.lookahead_m"; `vehicles.` may be left out
  io::YamlNode value;
};

/// Values applied over the file: first `values`, then `sets`, each in order.
struct Overrides {
  std::vector<std::string> sets;  ///< of the command line: "rover.controller.lookahead_m=0.5"
  std::optional<std::uint64_t> seed;
  std::vector<OverrideValue> values = {};  ///< of a study
};

/// Only the plug-in list, read first because plug-ins extend the registry that the rest is checked
/// against.
/// @returns absolute paths of files that exist. Of the overrides only those of `plugins` count.
std::vector<std::filesystem::path> load_plugin_list(const std::filesystem::path& file,
                                                    const Overrides& overrides = {});

/// A scenario file that is read once, for scenarios that differ by their overrides.
class ScenarioSource {
 public:
  /// Reads the file and what it includes. @throws ConfigError
  explicit ScenarioSource(const std::filesystem::path& file);
  /// Overrides and checks. @throws ConfigError with "file:line: key = value, ..." in one sentence
  Scenario load(const Registry& registry, const Overrides& overrides = {}) const;
  /// The file with its includes merged in.
  const io::YamlNode& tree() const { return tree_; }

 private:
  std::filesystem::path file_;
  io::YamlNode tree_;
};

/// The same for one scenario of a file.
Scenario load_scenario(const std::filesystem::path& file, const Registry& registry,
                       const Overrides& overrides = {});
/// The same from text; relative paths start at `folder`, and an empty one is the current folder.
Scenario parse_scenario(const std::string& yaml, const std::filesystem::path& folder,
                        const Registry& registry, const Overrides& overrides = {});

/// JSON Schema (draft 2020-12) of scenario files for exactly the parts in the registry.
std::string scenario_json_schema(const Registry& registry);

}  // namespace vinerow::scenario

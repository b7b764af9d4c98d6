#include "engine/scenario/scenario_keys.h"

#include <algorithm>

#include "engine/api/parameter_table.h"
#include "engine/core/suggest.h"

namespace vinerow::scenario {
namespace {

StructuralKey parameter(ParameterSpec spec) {
  return {std::move(spec), KeyShape::kParameter, PartKind::kWorld, false};
}

StructuralKey shaped(const char* name, KeyShape shape, const char* description) {
  ParameterSpec spec;
  spec.name = name;
  spec.kind = ParameterKind::kGroup;
  spec.description = description;
  return {std::move(spec), shape, PartKind::kWorld, false};
}

StructuralKey part(const char* name, KeyShape shape, PartKind kind, bool removable,
                   const char* description) {
  StructuralKey key = shaped(name, shape, description);
  key.part_kind = kind;
  key.removable = removable;
  return key;
}

StructuralKey required_key(StructuralKey key) {
  key.spec.required = true;
  return key;
}

StructuralKey group(const char* name, std::vector<ParameterSpec> fields, const char* description) {
  StructuralKey key = shaped(name, KeyShape::kGroup, description);
  key.spec.fields = std::move(fields);
  return key;
}

StructuralKey group_list(const char* name, std::vector<ParameterSpec> fields,
                         const char* description) {
  StructuralKey key = group(name, std::move(fields), description);
  key.spec.kind = ParameterKind::kGroupList;
  key.shape = KeyShape::kGroupList;
  return key;
}

std::vector<StructuralKey> parameters_of(std::vector<ParameterSpec> specs) {
  std::vector<StructuralKey> keys;
  for (ParameterSpec& spec : specs) keys.push_back(parameter(std::move(spec)));
  return keys;
}

}  // namespace

const ParameterTable<ScenarioValues>& scenario_table() {
  using P = ScenarioValues;
  const auto of = [](auto member) { return inside(&P::scenario, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("vinerow", &P::format, between(kFormatVersion, kFormatVersion),
                   "version of the file format")
          .required()
          .text("name", of(&Scenario::name), "name of the scenario; default: the file's name")
          .text("description", of(&Scenario::description), "purpose of the scenario")
          .integer("seed", of(&Scenario::seed), between(0, 9223372036854775807.0),
                   "seed of all random streams of the run")
          .number("duration_s", "s", of(&Scenario::duration_s), above(0.0, 1e7),
                  "latest end of the run")
          .boolean("stop_when_finished", of(&Scenario::stop_when_finished),
                   "end the run when every controller has finished")
          .number("gravity_mps2", "m/s2", of(&Scenario::gravity_mps2), between(0.0, 30.0),
                  "gravitational acceleration");
  return table;
}

const ParameterTable<PhysicsParams>& physics_table() {
  using P = PhysicsParams;
  static const ParameterTable<P> table =
      ParameterTable<P>().number("step_s", "s", &P::step_s, between(1e-5, 0.1),
                                 "physics step; the period of every part is a multiple of it");
  return table;
}

const ParameterTable<TrafficConfig>& traffic_table() {
  using P = TrafficConfig;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .texts("reserve_alleys", &P::vehicles,
                 "vehicles that reserve alleys: each enters an alley only if no other has reserved "
                 "it; the order of the list is the priority for simultaneous requests")
          .number("stop_before_m", "m", &P::stop_before_m, between(0.0, 100.0),
                  "distance before an occupied alley at which a vehicle waits");
  return table;
}

const ParameterTable<LockstepConfig>& lockstep_table() {
  using P = LockstepConfig;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("topic", &P::signal,
                "signal from outside whose commands the run waits for, <vehicle>/cmd_vel; needs "
                "'vinerow run --live' or '--ros2'")
          .required()
          .number("rate_Hz", "Hz", &P::rate_Hz, above(0.0, 1e6),
                  "rate at which commands are due: each is stamped with a multiple of the period, "
                  "the first with one period")
          .number("timeout_s", "s", &P::timeout_s, above(0.0, 1e6),
                  "wall time that the run waits for one command")
          .choice("on_timeout", &P::ends_on_timeout, {{"end", true}, {"continue", false}},
                  "after the timeout: end the run, or continue it without commands until the next "
                  "one comes");
  return table;
}

const ParameterTable<RecordConfig>& record_table() {
  using P = RecordConfig;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .boolean("enabled", &P::enabled, "write a log")
          .number("truth_rate_Hz", "Hz", &P::truth_rate_Hz, above(0.0, 1e6),
                  "log rate of true poses, links and wheel states")
          .number("sensor_rate_limit_Hz", "Hz", &P::sensor_rate_limit_Hz, above(0.0, 1e6),
                  "maximum log rate of a sensor; the simulation is not affected")
          .text("compression", &P::compression, "compression of the log's chunks")
          .one_of({"zstd", "lz4", "none"});
  return table;
}

const ParameterTable<VehicleConfig>& vehicle_table() {
  using P = VehicleConfig;
  static const ParameterTable<P> table = ParameterTable<P>().choice(
      "on_crash", &P::on_crash, {{"end", OnCrash::kEnd}, {"fail", OnCrash::kFail}},
      "after a crash of this vehicle, which fails the run: end the run, or "
      "continue it for the other vehicles");
  return table;
}

const ParameterTable<PicturesConfig>& pictures_table() {
  using P = PicturesConfig;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("width", &P::width, between(16, 8192), "width in pixels")
          .integer("height", &P::height, between(16, 8192), "height in pixels")
          .integer("samples", &P::samples, between(1, 9),
                   "antialiasing samples per pixel: 1, 2, 4 or 9, else the nearest")
          .number("every_s", "s", &P::every_s, between(0.0, 1e7), "interval of frames; 0 = none")
          .numbers("times_s", "s", &P::times_s, between(0.0, 1e7), "frames at these times")
          .texts("moments", &P::moment_texts,
                 "frames at instants of a mission: '<phase> + <seconds>'")
          .numbers("shares", "", &P::shares, between(0.0, 1.0),
                   "frames at these shares of the run; default [1] where no other moment is "
                   "given");
  return table;
}

const std::vector<StructuralKey>& scenario_keys() {
  static const std::vector<StructuralKey> keys = [] {
    std::vector<StructuralKey> all = parameters_of(scenario_table().specs());
    const std::vector<StructuralKey> more = {
        group("physics", physics_table().specs(), "physics settings"),
        shaped("plugins", KeyShape::kPathList, "shared libraries with further parts"),
        required_key(part("world", KeyShape::kPart, PartKind::kWorld, false,
                          "terrain, rows and other fixed objects")),
        required_key(shaped("vehicles", KeyShape::kVehicles, "vehicles by name")),
        shaped("phases", KeyShape::kPhases,
               "mission graph: phases of vehicles, and jobs; absent: every vehicle starts at "
               "once"),
        group("traffic", traffic_table().specs(), "reservation of alleys by several vehicles"),
        group("lockstep", lockstep_table().specs(),
              "simulated time waits for the commands of a program outside"),
        part("metrics", KeyShape::kNamedParts, PartKind::kMetric, false,
             "metrics computed for every vehicle; default: all known metrics"),
        group_list("criteria", criterion_table().specs(), "limits that the run must meet"),
        group("record", record_table().specs(), "contents of the log"),
        shaped("pictures", KeyShape::kPictures, "pictures that the run renders")};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return keys;
}

const std::vector<StructuralKey>& vehicle_keys() {
  static const std::vector<StructuralKey> keys = {
      required_key(shaped("spawn", KeyShape::kSpawn, "start pose of the vehicle")),
      parameter(vehicle_table().specs().front()),
      part("map", KeyShape::kPart, PartKind::kMap, true,
           "the vehicle's map of the world; absent: the true rows"),
      part("sensors", KeyShape::kNamedParts, PartKind::kSensor, true, "sensors by name"),
      part("estimator", KeyShape::kPart, PartKind::kEstimator, true,
           "computes the estimate from sensors; absent: the estimate is the truth"),
      part("observers", KeyShape::kNamedParts, PartKind::kEstimator, true,
           "further estimators by name, with the same sensors; the metric estimation "
           "evaluates them, no part uses them"),
      part("planner", KeyShape::kPart, PartKind::kPlanner, true, "computes the path from the map"),
      part("guidance", KeyShape::kPart, PartKind::kGuidance, true, "local planning"),
      part("controller", KeyShape::kPart, PartKind::kController, true, "commands the actuators"),
      part("autopilot", KeyShape::kPart, PartKind::kAutopilot, true,
           "firmware outside the run, in place of estimator, guidance and controller"),
      part("payloads", KeyShape::kNamedParts, PartKind::kPayload, true,
           "payloads by name: sprayers, scouting cameras")};
  return keys;
}

const std::vector<StructuralKey>& pictures_keys() {
  static const std::vector<StructuralKey> keys = [] {
    std::vector<StructuralKey> all = parameters_of(pictures_table().specs());
    all.push_back(shaped("cameras", KeyShape::kCameras,
                         "cameras by name; default: one that follows the first vehicle"));
    return all;
  }();
  return keys;
}

const ParameterTable<CriterionParams>& criterion_table() {
  using P = CriterionParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("metric", &P::metric, "<vehicle>.<metric>, e.g. rover.cross_track_rms_m")
          .required()
          .number("min", "", &P::min, kAnyNumber, "lower limit of the metric")
          .number("max", "", &P::max, kAnyNumber, "upper limit of the metric")
          .text("name", &P::name, "name in reports; default: the metric and its limits");
  return table;
}

const ParameterTable<PhaseConfig>& phase_table() {
  using P = PhaseConfig;
  using W = WeatherWindow;
  static const ParameterTable<W> weather_table =
      ParameterTable<W>()
          .number("max_wind_mps", "m/s", &W::max_wind_mps, kPositive,
                  "maximum mean wind at the start")
          .required()
          .number("height_m", "m", &W::height_m, between(0.5, 500.0),
                  "height of the wind measurement above the ground, in the middle of the rows")
          .number("over_s", "s", &W::over_s, kPositive, "averaging time of the wind")
          .number("wait_s", "s", &W::wait_s, between(0.0, 1e7),
                  "without such a window for this time, the phase fails");
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .texts("vehicles", &P::vehicles, "vehicles of this phase, each with its own controller")
          .texts("after", &P::after,
                 "phases that must have succeeded before, besides those whose products "
                 "it takes")
          .number("timeout_s", "s", &P::timeout_s, between(0.0, 1e7),
                  "time limit of the vehicles, after which the phase fails; 0: no limit")
          .number("duration_s", "s", &P::duration_s, between(0.0, 1e7),
                  "simulated duration of a job")
          .choice(
              "on_failure", &P::on_failure,
              {{"abort", OnFailure::kAbort}, {"continue", OnFailure::kContinue}},
              "after a failure: end the mission, or continue phases that do not wait for this one")
          .group("weather", &P::weather, weather_table,
                 "the phase starts only in a window of weak wind");
  return table;
}

std::vector<ProductPort> product_ports(const Registry& registry) {
  std::vector<ProductPort> ports = {
      {"map", ProductKind::kMap, false, "map of the phase's vehicles"},
      {"plan", ProductKind::kPlan, false, "plan that the phase's vehicle follows"}};
  for (const std::string& job : registry.names(PartKind::kJob)) {
    for (const ProductPort& port : registry.spec(PartKind::kJob, job).takes) {
      const bool is_known =
          std::any_of(ports.begin(), ports.end(), [&](const auto& p) { return p.key == port.key; });
      if (!is_known) ports.push_back(port);
    }
  }
  return ports;
}

namespace {

const ParameterTable<SpawnConfig>& alley_spawn_table() {
  using P = SpawnConfig;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("alley", &P::alley, between(0, 1e6), "start at this alley's entrance (id)")
          .required()
          .number("offset_m", "m", &P::offset_m, between(-1e6, 1e6),
                  "distance before the alley's first point")
          .boolean("reverse", &P::reverse, "start at the last point, driving to the first")
          .number("lateral_m", "m", &P::lateral_m, between(-100.0, 100.0),
                  "offset to the left of the centre line, as the vehicle heads")
          .degrees("turn_deg", &P::turn_rad, between(-360.0, 360.0),
                   "heading relative to the centre line, positive to the left");
  return table;
}

struct PlacedSpawn {
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;
};

const ParameterTable<PlacedSpawn>& placed_spawn_table() {
  using P = PlacedSpawn;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number(
              "x_m", "m", [](P& p) -> double& { return p.p_W.x(); }, between(-1e7, 1e7),
              "east of the world's origin")
          .required()
          .number(
              "y_m", "m", [](P& p) -> double& { return p.p_W.y(); }, between(-1e7, 1e7),
              "north of the world's origin")
          .required()
          .degrees("yaw_deg", &P::yaw_rad, between(-360.0, 360.0),
                   "heading, from east, positive to the left");
  return table;
}

const ParameterTable<SpawnConfig>& point_spawn_table() {
  using P = SpawnConfig;
  static const ParameterTable<P> table =
      ParameterTable<P>().text("point", &P::point, "name of a spawn point of the world").required();
  return table;
}

}  // namespace

const std::vector<SpawnForm>& spawn_forms() {
  static const std::vector<SpawnForm> forms = {{"alley", alley_spawn_table().specs()},
                                               {"x_m", placed_spawn_table().specs()},
                                               {"point", point_spawn_table().specs()}};
  return forms;
}

SpawnConfig read_spawn_form(const std::string& form, const ParameterSet& values) {
  if (form == "alley") return alley_spawn_table().read(values, "");
  if (form == "point") return point_spawn_table().read(values, "");
  const PlacedSpawn placed = placed_spawn_table().read(values, "");
  SpawnConfig spawn;
  spawn.p_W = placed.p_W;
  spawn.yaw_rad = placed.yaw_rad;
  return spawn;
}

std::string spawn_form_of(const io::YamlNode& spawn) {
  for (const SpawnForm& form : spawn_forms()) {
    for (const ParameterSpec& field : form.fields) {
      if (spawn.has(field.name)) return form.name;
    }
  }
  return "";
}

std::string spawn_forms_text() {
  std::string text;
  for (std::size_t i = 0; i < spawn_forms().size(); ++i) {
    std::vector<std::string> names;
    for (const ParameterSpec& field : spawn_forms()[i].fields) names.push_back(field.name);
    text += (i == 0 ? "" : i + 1 == spawn_forms().size() ? " or " : ", ");
    text += "{" + join(names) + "}";
  }
  return text;
}

namespace {

/// Camera of a kind with default values.
CameraConfig make_camera(CameraKind kind) {
  CameraConfig camera;
  camera.kind = kind;
  if (kind == CameraKind::kTop) camera.height_m = 0.0;
  // A survey camera's picture has no lines over the ground.
  if (kind == CameraKind::kShots) camera.show_trail = camera.show_plan = false;
  return camera;
}

template <CameraKind kKind>
struct CameraFields {
  std::optional<std::string> vehicle;
  CameraConfig camera = make_camera(kKind);
};

template <CameraKind kKind>
ParameterTable<CameraFields<kKind>> make_camera_table() {
  using P = CameraFields<kKind>;
  using C = CameraConfig;
  const auto of = [](auto member) { return inside(&P::camera, member); };
  ParameterTable<P> table;
  if constexpr (kKind == CameraKind::kFixed) {
    table
        .numbers("position_m", "m", of(&C::p_W), between(-1e5, 1e5),
                 "x, y and height above the ground")
        .required()
        .numbers("look_at_m", "m", of(&C::target_W), between(-1e5, 1e5),
                 "x, y and height above the ground")
        .required();
  } else {
    table.text("vehicle", &P::vehicle,
               kKind == CameraKind::kTop
                   ? "the vehicle below the camera; absent: the middle of the world"
                   : "the vehicle of the camera; default: the first");
  }
  if constexpr (kKind == CameraKind::kChase) {
    table
        .number("distance_m", "m", of(&C::distance_m), between(0.1, 1e4),
                "distance behind the vehicle")
        .number("height_m", "m", of(&C::height_m), between(-1e4, 1e4), "height above the vehicle")
        .degrees("yaw_deg", of(&C::yaw_rad), between(-360.0, 360.0),
                 "orbit angle from behind, positive to the left");
  } else if constexpr (kKind == CameraKind::kTop) {
    table
        .numbers("centre_m", "m", of(&C::centre_W), between(-1e5, 1e5),
                 "x and y of the middle of the picture, instead of a vehicle")
        .number("height_m", "m", of(&C::height_m), between(0.0, 1e5),
                "extent of the picture from south to north; 0 = the whole world");
  } else if constexpr (kKind == CameraKind::kShots) {
    table.text("sensor", of(&C::sensor), "the camera_trigger whose pictures are drawn")
        .integer("every", of(&C::every), between(1, 1e6),
                 "draw only pictures whose index is a multiple of this");
  } else if constexpr (kKind == CameraKind::kOnBoard) {
    table
        .numbers("offset_m", "m", of(&C::offset_B), between(-1e3, 1e3),
                 "position in the body frame: forward, left, up")
        .degrees("yaw_deg", of(&C::yaw_rad), between(-360.0, 360.0),
                 "view direction, positive to the left")
        .degrees("pitch_deg", of(&C::pitch_rad), between(-90.0, 90.0),
                 "view direction, positive looks down");
  }
  if constexpr (kKind != CameraKind::kShots) {
    table.degrees("fov_deg", of(&C::fov_rad), between(1.0, 170.0), "vertical field of view");
  }
  table.boolean("show_sensor_rays", of(&C::show_sensor_rays), "draw the rays of range sensors")
      .boolean("show_trail", of(&C::show_trail), "draw the tracks of the vehicles")
      .boolean("show_plan", of(&C::show_plan), "draw the planned paths")
      .boolean("show_grid", of(&C::show_grid), "draw the occupancy grid")
      .boolean("show_tree", of(&C::show_tree), "draw the search trees of the planners")
      .boolean("show_estimate", of(&C::show_estimate),
               "draw the estimates of estimators and observers")
      .boolean("show_map", of(&C::show_map), "draw the vehicles' own maps");
  return table;
}

template <CameraKind kKind>
const ParameterTable<CameraFields<kKind>>& camera_table() {
  static const ParameterTable<CameraFields<kKind>> table = make_camera_table<kKind>();
  return table;
}

/// Calls `use` with the table of a kind; for an unknown kind, with that of an on-board camera.
template <class Use>
auto with_camera_table(const std::string& kind, Use&& use) {
  if (kind == "fixed") return use(camera_table<CameraKind::kFixed>());
  if (kind == "chase") return use(camera_table<CameraKind::kChase>());
  if (kind == "top") return use(camera_table<CameraKind::kTop>());
  if (kind == "shots") return use(camera_table<CameraKind::kShots>());
  return use(camera_table<CameraKind::kOnBoard>());
}

}  // namespace

const std::vector<std::string>& camera_kinds() {
  static const std::vector<std::string> kinds = {"fixed", "chase", "top", "on_board", "shots"};
  return kinds;
}

std::vector<ParameterSpec> camera_fields(const std::string& kind) {
  return with_camera_table(kind, [](const auto& table) { return table.specs(); });
}

CameraConfig read_camera_fields(const std::string& kind, const ParameterSet& values) {
  return with_camera_table(kind, [&](const auto& table) {
    auto fields = table.read(values, "");
    fields.camera.vehicle = fields.vehicle.value_or("");
    return fields.camera;
  });
}

bool has_rate(PartKind kind) {
  return kind == PartKind::kSensor || kind == PartKind::kEstimator || kind == PartKind::kGuidance ||
         kind == PartKind::kController || kind == PartKind::kAutopilot ||
         kind == PartKind::kPayload || kind == PartKind::kMetric;
}

bool follows_controller(PartKind kind) {
  return kind == PartKind::kEstimator || kind == PartKind::kGuidance ||
         kind == PartKind::kPayload || kind == PartKind::kMetric;
}

const ParameterTable<RateParams>& rate_table() {
  using P = RateParams;
  static const ParameterTable<P> table =
      ParameterTable<P>().number("rate_Hz", "Hz", &P::rate_Hz, between(1e-6, 1e6),
                                 "rate; its period is a multiple of the physics step");
  return table;
}

ParameterSpec rate_field(PartKind kind, const PartSpec& part) {
  ParameterSpec spec = rate_table().specs().front();
  if (part.default_rate_Hz > 0.0) {
    spec.default_value = part.default_rate_Hz;
  } else {
    spec.description = follows_controller(kind) ? "rate; default: like the controller"
                                                : "rate; default: every physics step";
  }
  return spec;
}

bool is_valid_name(const std::string& name) {
  const auto is_letter = [](unsigned char c) { return (c | 0x20) >= 'a' && (c | 0x20) <= 'z'; };
  const auto is_inner = [&](unsigned char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (name.empty() || !(is_letter(static_cast<unsigned char>(name[0])) || name[0] == '_')) {
    return false;
  }
  return std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_inner(static_cast<unsigned char>(c)); });
}

const std::vector<std::string>& reserved_signal_names() {
  static const std::vector<std::string> names = {
      "truth",    "estimate",  "plan",      "reference",     "links",     "actuators",
      "follower", "command",   "plan_tree", "local_command", "ellipsoid", "estimator_state",
      "contacts", "map_edges", "landing",   "authority"};
  return names;
}

}  // namespace vinerow::scenario

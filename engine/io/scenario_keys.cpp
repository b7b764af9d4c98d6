#include "engine/io/scenario_keys.h"

#include <algorithm>

#include "engine/core/constants.h"
#include "engine/core/suggest.h"

namespace vinerow::io {
namespace {

StructuralKey parameter(ParameterSpec spec) {
  return {std::move(spec), KeyShape::kParameter, PartKind::kWorld, false};
}

StructuralKey group(const char* name, std::vector<ParameterSpec> fields, const char* description) {
  return {group_parameter(name, std::move(fields), description), KeyShape::kGroup, PartKind::kWorld,
          false};
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

std::vector<ParameterSpec> record_fields() {
  ParameterSpec truth_rate = positive_parameter(
      "truth_rate_Hz", "Hz", 20.0, "how often true poses, links and wheel states are logged");
  truth_rate.max = 1e6;
  ParameterSpec limit =
      positive_parameter("sensor_rate_limit_Hz", "Hz", 100.0,
                         "faster sensors are thinned in the log, never in the simulation");
  limit.max = 1e6;
  return {boolean_parameter("enabled", true, "whether a log is written"), truth_rate, limit,
          choice_parameter("compression", "zstd", {"zstd", "lz4", "none"}, "of the log's chunks")};
}

std::vector<ParameterSpec> traffic_fields() {
  return {text_list_parameter("reserve_alleys", {},
                              "vehicles that enter an alley only when no other of them has it; of "
                              "two that ask at once the first named is served"),
          number_parameter("stop_before_m", "m", 1.0, 0.0, 100.0,
                           "so far before an alley that another has they wait")};
}

ParameterSpec list_in_range(const char* name, const char* unit, double max,
                            const char* description) {
  ParameterSpec spec = number_list_parameter(name, unit, {}, description);
  spec.min = 0.0;
  spec.max = max;
  return spec;
}

ParameterSpec point(const char* name, std::vector<double> value, const char* description) {
  return number_list_parameter(name, "m", std::move(value), description, 3);
}

}  // namespace

const std::vector<StructuralKey>& scenario_keys() {
  static const std::vector<StructuralKey> keys = [] {
    ParameterSpec duration =
        positive_parameter("duration_s", "s", 60.0, "the run ends here at the latest");
    duration.max = 1e7;
    ParameterSpec step =
        positive_parameter("step_s", "s", 0.001, "physics step; every part's period is a multiple");
    step.max = 0.1;
    return std::vector<StructuralKey>{
        parameter(required(integer_parameter("vinerow", kFormatVersion, kFormatVersion,
                                             kFormatVersion, "version of the file format"))),
        parameter(text_parameter("name", "", "of the scenario; default: the file's name")),
        parameter(text_parameter("description", "", "what the scenario shows")),
        parameter(integer_parameter("seed", 1, 0, 9223372036854775807.0,
                                    "of every random stream of the run")),
        parameter(duration),
        parameter(boolean_parameter("stop_when_finished", true,
                                    "end when every controller has finished")),
        parameter(number_parameter("gravity_mps2", "m/s2", 9.80665, 0.0, 30.0,
                                   "gravitational acceleration")),
        group("physics", {step}, "settings of the physics"),
        shaped("plugins", KeyShape::kPathList, "shared libraries that bring parts of their own"),
        required_key(part("world", KeyShape::kPart, PartKind::kWorld, false,
                          "terrain, rows and everything else that stands in it")),
        required_key(shaped("vehicles", KeyShape::kVehicles, "the vehicles by name")),
        shaped("phases", KeyShape::kPhases,
               "the mission's graph: vehicles at work, and jobs; absent: every vehicle starts at "
               "once"),
        group("traffic", traffic_fields(), "how vehicles share the alleys"),
        part("metrics", KeyShape::kNamedParts, PartKind::kMetric, false,
             "what is measured for every vehicle; default: every known metric"),
        {group_list_parameter("criteria", criterion_fields(), "limits that the run must meet"),
         KeyShape::kGroupList, PartKind::kWorld, false},
        group("record", record_fields(), "what goes into the log"),
        shaped("pictures", KeyShape::kPictures, "frames that the run renders")};
  }();
  return keys;
}

const std::vector<StructuralKey>& vehicle_keys() {
  static const std::vector<StructuralKey> keys = {
      required_key(shaped("spawn", KeyShape::kSpawn, "where the vehicle starts")),
      parameter(choice_parameter("on_crash", "end", {"end", "fail"},
                                 "what a crash of the vehicle does beside failing the run: it ends "
                                 "there, or goes on for the others")),
      part("map", KeyShape::kPart, PartKind::kMap, true,
           "what the vehicle is told of the world; absent: the true rows"),
      part("sensors", KeyShape::kNamedParts, PartKind::kSensor, true, "the sensors by name"),
      part("estimator", KeyShape::kPart, PartKind::kEstimator, true,
           "makes the estimate from sensors; absent: the estimate is the truth"),
      part("observers", KeyShape::kNamedParts, PartKind::kEstimator, true,
           "estimators by name that run beside it, on the same sensors, and are judged by "
           "the metric estimation; nothing acts on them"),
      part("planner", KeyShape::kPart, PartKind::kPlanner, true, "makes the path from the map"),
      part("guidance", KeyShape::kPart, PartKind::kGuidance, true, "local planning"),
      part("controller", KeyShape::kPart, PartKind::kController, true, "drives the actuators"),
      part("payloads", KeyShape::kNamedParts, PartKind::kPayload, true,
           "what the vehicle works with, by name: sprayers, scouting cameras")};
  return keys;
}

const std::vector<StructuralKey>& pictures_keys() {
  static const std::vector<StructuralKey> keys = {
      parameter(integer_parameter("width", 1280, 16, 8192, "pixels")),
      parameter(integer_parameter("height", 720, 16, 8192, "pixels")),
      parameter(integer_parameter("samples", 4, 1, 8, "antialiasing samples per pixel")),
      parameter(number_parameter("every_s", "s", 0.0, 0.0, 1e7, "a frame every so often; 0 = not")),
      parameter(list_in_range("times_s", "s", 1e7, "frames at these times")),
      parameter(text_list_parameter("moments", {},
                                    "frames at moments of a mission: '<phase> + <seconds>'")),
      parameter(
          list_in_range("shares", "", 1.0,
                        "frames at these shares of the run; default [1] where no other moment is "
                        "given")),
      shaped("cameras", KeyShape::kCameras,
             "the cameras by name; default: one that chases the first vehicle")};
  return keys;
}

const std::vector<ParameterSpec>& criterion_fields() {
  static const std::vector<ParameterSpec> fields = {
      required(text_parameter("metric", "", "<vehicle>.<metric>, e.g. rover.cross_track_rms_m")),
      optional(
          number_parameter("min", "", 0.0, -kInfinity, kInfinity, "the metric must reach this")),
      optional(number_parameter("max", "", 0.0, -kInfinity, kInfinity,
                                "the metric must not exceed this")),
      optional(text_parameter("name", "", "in reports; default: the metric and its limits"))};
  return fields;
}

const std::vector<ParameterSpec>& phase_fields() {
  static const std::vector<ParameterSpec> fields = [] {
    ParameterSpec weather = group_parameter(
        "weather",
        {required(positive_parameter("max_wind_mps", "m/s", 5.0, "mean wind to begin in, at most")),
         number_parameter("height_m", "m", 10.0, 0.5, 500.0,
                          "above the ground in the middle of the rows, where it is measured"),
         positive_parameter("over_s", "s", 30.0, "time over which the mean is taken"),
         number_parameter("wait_s", "s", 600.0, 0.0, 1e7,
                          "the phase fails where no such window came in this time")},
        "the phase begins in a window of weak wind");
    return std::vector<ParameterSpec>{
        text_list_parameter("vehicles", {}, "that work in this phase, each by its own controller"),
        text_list_parameter("after", {},
                            "phases that must have succeeded before, beside those whose products "
                            "it takes"),
        number_parameter("timeout_s", "s", 0.0, 0.0, 1e7,
                         "vehicles that have not finished by then have failed; 0: as long as the "
                         "run"),
        number_parameter("duration_s", "s", 0.0, 0.0, 1e7, "simulated time that a job takes"),
        choice_parameter("on_failure", "abort", {"abort", "continue"},
                         "a failure ends the mission, or phases that do not wait for this one go "
                         "on"),
        optional(weather)};
  }();
  return fields;
}

std::vector<ProductPort> product_ports(const Registry& registry) {
  std::vector<ProductPort> ports = {
      {"map", ProductKind::kMap, false, "what the phase's vehicles are told of the world"},
      {"plan", ProductKind::kPlan, false, "what the phase's vehicle follows"}};
  for (const std::string& job : registry.names(PartKind::kJob)) {
    for (const ProductPort& port : registry.spec(PartKind::kJob, job).takes) {
      const bool is_known =
          std::any_of(ports.begin(), ports.end(), [&](const auto& p) { return p.key == port.key; });
      if (!is_known) ports.push_back(port);
    }
  }
  return ports;
}

const std::vector<SpawnForm>& spawn_forms() {
  static const std::vector<SpawnForm> forms = {
      {"alley",
       {required(integer_parameter("alley", 0, 0, 1e6, "start at this alley's entrance (id)")),
        number_parameter("offset_m", "m", 0.0, -1e6, 1e6, "so far before the alley's first point"),
        boolean_parameter("reverse", false, "start at the last point, driving to the first")}},
      {"x_m",
       {required(number_parameter("x_m", "m", 0.0, -1e7, 1e7, "east of the world's origin")),
        required(number_parameter("y_m", "m", 0.0, -1e7, 1e7, "north of the world's origin")),
        number_parameter("yaw_deg", "deg", 0.0, -360.0, 360.0,
                         "heading, from east, positive to the left")}},
      {"point", {required(text_parameter("point", "", "name of a spawn point of the world"))}}};
  return forms;
}

std::string spawn_form_of(const YamlNode& spawn) {
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

const std::vector<std::string>& camera_kinds() {
  static const std::vector<std::string> kinds = {"fixed", "chase", "top", "on_board", "shots"};
  return kinds;
}

std::vector<ParameterSpec> camera_fields(const std::string& kind) {
  const ParameterSpec vehicle =
      optional(text_parameter("vehicle", "", "the vehicle it belongs to; default: the first"));
  std::vector<ParameterSpec> fields;
  if (kind == "fixed") {
    fields = {required(point("position_m", {}, "x, y and height above the ground")),
              required(point("look_at_m", {}, "x, y and height above the ground"))};
  } else if (kind == "chase") {
    fields = {vehicle, number_parameter("distance_m", "m", 6.0, 0.1, 1e4, "behind the vehicle"),
              number_parameter("height_m", "m", 2.5, -1e4, 1e4, "above the vehicle"),
              number_parameter("yaw_deg", "deg", 0.0, -360.0, 360.0,
                               "orbit angle from behind, positive to the left")};
  } else if (kind == "top") {
    ParameterSpec followed = vehicle;
    followed.description = "the vehicle it stays above; absent: the middle of the world";
    fields = {followed,
              optional(number_list_parameter("centre_m", "m", {},
                                             "x and y in the middle of the picture, instead of a "
                                             "vehicle",
                                             2)),
              number_parameter("height_m", "m", 0.0, 0.0, 1e5,
                               "what the picture shows from south to north; 0 = the whole world")};
  } else if (kind == "shots") {
    fields = {vehicle,
              text_parameter("sensor", "camera", "the camera_trigger whose pictures are drawn"),
              integer_parameter("every", 10, 1, 1e6, "pictures whose index is a multiple of it")};
  } else {
    fields = {vehicle, point("offset_m", {0.3, 0.0, 0.6}, "in the body frame: forward, left, up"),
              number_parameter("yaw_deg", "deg", 0.0, -360.0, 360.0, "view direction, to the left"),
              number_parameter("pitch_deg", "deg", 0.0, -90.0, 90.0, "positive looks down")};
  }
  // What a survey camera sees is known, and lines over the ground are none of it.
  const bool is_plain = kind == "shots";
  if (!is_plain) {
    fields.push_back(
        number_parameter("fov_deg", "deg", 55.0, 1.0, 170.0, "vertical field of view"));
  }
  fields.push_back(boolean_parameter("show_sensor_rays", false, "draw the rays of range sensors"));
  fields.push_back(boolean_parameter("show_trail", !is_plain, "draw where the vehicles have been"));
  fields.push_back(boolean_parameter("show_plan", !is_plain, "draw the planned paths"));
  fields.push_back(boolean_parameter("show_grid", false, "draw the occupancy grid"));
  fields.push_back(boolean_parameter("show_tree", false, "draw what the planners searched"));
  fields.push_back(boolean_parameter("show_estimate", false,
                                     "draw where estimator and observers think the vehicles are"));
  fields.push_back(boolean_parameter("show_map", false, "draw the vehicles' own maps"));
  return fields;
}

bool has_rate(PartKind kind) {
  return kind == PartKind::kSensor || kind == PartKind::kEstimator || kind == PartKind::kGuidance ||
         kind == PartKind::kController || kind == PartKind::kPayload || kind == PartKind::kMetric;
}

bool follows_controller(PartKind kind) {
  return kind == PartKind::kEstimator || kind == PartKind::kGuidance ||
         kind == PartKind::kPayload || kind == PartKind::kMetric;
}

ParameterSpec rate_field(PartKind kind, const PartSpec& part) {
  ParameterSpec spec = number_parameter("rate_Hz", "Hz", part.default_rate_Hz, 1e-6, 1e6,
                                        "how often it runs; its period is a multiple of the "
                                        "physics step");
  if (part.default_rate_Hz <= 0.0) {
    spec = optional(spec);
    spec.description = follows_controller(kind) ? "how often it runs; default: like the controller"
                                                : "how often it runs; default: every physics step";
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
      "truth",     "estimate",        "plan",     "reference", "links",
      "actuators", "follower",        "command",  "plan_tree", "local_command",
      "ellipsoid", "estimator_state", "contacts", "map_edges", "authority"};
  return names;
}

}  // namespace vinerow::io

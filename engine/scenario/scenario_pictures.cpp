#include <fmt/format.h>

#include <algorithm>

#include "engine/api/parameter_table.h"
#include "engine/api/registry.h"
#include "engine/core/suggest.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/scenario_part.h"
#include "engine/scenario/yaml_include.h"

namespace vinerow::scenario {
namespace {

/// Kind of a camera; chase if not given.
std::string read_kind(const io::YamlNode& camera, const std::string& path) {
  const io::YamlNode* kind = camera.find("kind");
  if (!kind) return "chase";
  const std::vector<std::string>& kinds = camera_kinds();
  if (!kind->is_scalar() || std::find(kinds.begin(), kinds.end(), kind->text) == kinds.end()) {
    io::fail_at(kind->mark,
                fmt::format("{}.kind = {}, must be one of: {}{}", path, io::shown(*kind),
                            join(kinds), did_you_mean(kind->text, kinds)));
  }
  return kind->text;
}

/// Checks a view of a fixed place: it needs an extent and cannot follow a vehicle.
void check_centre(const io::YamlNode& camera, const io::YamlEntry& centre, const std::string& path,
                  double height_m) {
  if (camera.has("vehicle")) {
    io::fail_at(centre.mark,
                fmt::format("{}: centre_m and vehicle are both given, must be one of them", path));
  }
  if (height_m <= 0.0) {
    io::fail_at(centre.mark,
                fmt::format("{}.centre_m needs height_m > 0, the extent of the picture from "
                            "south to north",
                            path));
  }
}

/// Checks a fixed camera: it stands above the ground and looks at another place than its own.
void check_fixed(const io::YamlNode& camera, const CameraConfig& read, const std::string& path) {
  if (read.p_W.z() <= 0.0) {
    io::fail_at(camera.find_entry("position_m")->value.mark,
                fmt::format("{}.position_m = [{:g}, {:g}, {:g}]: the camera would not be above the "
                            "ground, from which its height is measured",
                            path, read.p_W.x(), read.p_W.y(), read.p_W.z()));
  }
  if (read.target_W == read.p_W) {
    io::fail_at(camera.find_entry("look_at_m")->value.mark,
                fmt::format("{}.look_at_m is the camera's own place, must be another", path));
  }
}

CameraConfig read_camera(const io::YamlEntry& entry, const std::string& path,
                         const std::vector<std::string>& vehicles, io::YamlNode& resolved) {
  const io::YamlNode& node = entry.value;
  require_mapping(node, path, "{kind: chase}");
  const std::string kind = read_kind(node, path);
  const std::vector<ParameterSpec> fields = camera_fields(kind);
  std::vector<std::string> known = names_of(fields);
  known.push_back("kind");
  check_keys(node, path, known, fmt::format("camera of kind '{}'", kind), nullptr);
  ReadParameters read = read_parameters(node, entry.mark, path, fields, path);
  CameraConfig camera = read_camera_fields(kind, read.values);
  camera.name = entry.key;
  camera.where = entry.mark;
  if (const io::YamlEntry* centre = node.find_entry("centre_m"); centre && kind == "top") {
    check_centre(node, *centre, path, camera.height_m);
  }
  if (camera.kind == CameraKind::kFixed) check_fixed(node, camera, path);
  const bool follows = kind == "chase" || kind == "on_board" || kind == "shots";
  const io::YamlEntry* named = node.find_entry("vehicle");
  if (named) {
    check_vehicle(camera.vehicle, vehicles, named->value.mark, path + ".vehicle");
  } else if (follows) {
    if (vehicles.empty()) {
      io::fail_at(entry.mark, fmt::format("{}: a camera of kind '{}' needs a vehicle, but the "
                                          "scenario has no vehicles",
                                          path, kind));
    }
    camera.vehicle = vehicles.front();
  }
  resolved.put("kind", io::yaml_text(kind));
  if (!camera.vehicle.empty()) resolved.put("vehicle", io::yaml_text(camera.vehicle));
  for (io::YamlEntry& written : read.resolved.entries) {
    resolved.put(written.key, std::move(written.value));
  }
  return camera;
}

/// Default cameras of a scenario.
io::YamlNode default_cameras(const std::vector<std::string>& vehicles) {
  io::YamlNode cameras = io::yaml_mapping();
  if (!vehicles.empty()) cameras.put("chase", io::yaml_mapping());
  return cameras;
}

}  // namespace

void check_shot_cameras(const PicturesConfig& pictures, const std::vector<VehicleConfig>& vehicles,
                        const Registry& registry) {
  for (const CameraConfig& camera : pictures.cameras) {
    if (camera.kind != CameraKind::kShots) continue;
    for (const VehicleConfig& vehicle : vehicles) {
      if (vehicle.name != camera.vehicle) continue;
      std::vector<std::string> known;
      for (const NamedPart& sensor : vehicle.sensors) {
        const PartSpec& spec = registry.spec(PartKind::kSensor, sensor.part.type);
        if (spec.gives == ProductKind::kPictures) known.push_back(sensor.name);
      }
      if (std::find(known.begin(), known.end(), camera.sensor) != known.end()) continue;
      io::fail_at(
          camera.where,
          fmt::format("pictures.cameras.{}.sensor = '{}', must be a camera_trigger of {}{} "
                      "(known: {})",
                      camera.name, camera.sensor, vehicle.name, did_you_mean(camera.sensor, known),
                      known.empty() ? "none" : join(known)));
    }
  }
}

PicturesConfig read_pictures(const io::YamlEntry* entry, const std::vector<std::string>& vehicles,
                             io::YamlNode& resolved) {
  io::YamlNode node = io::yaml_mapping();
  io::SourceMark where;
  if (entry) {
    require_mapping(entry->value, "pictures", "{shares: [1.0]}");
    node = entry->value;
    where = entry->mark;
  }
  std::vector<std::string> known;
  std::vector<ParameterSpec> fields;
  for (const StructuralKey& key : pictures_keys()) {
    known.push_back(key.spec.name);
    if (key.shape == KeyShape::kParameter) fields.push_back(key.spec);
  }
  check_keys(node, "pictures", known, "", nullptr);
  if (!node.has("times_s") && !node.has("every_s") && !node.has("moments") && !node.has("shares")) {
    io::YamlNode last_instant = io::yaml_list();
    last_instant.items.push_back(io::yaml_number(1.0));
    node.put("shares", std::move(last_instant));
  }
  ReadParameters read = read_parameters(node, where, "pictures", fields, "pictures");
  resolved = std::move(read.resolved);

  PicturesConfig pictures = pictures_table().read(read.values, "");
  if (pictures.moment_texts.empty()) resolved.erase("moments");

  const io::YamlNode* given = node.find("cameras");
  const io::YamlNode cameras = given ? *given : default_cameras(vehicles);
  require_mapping(cameras, "pictures.cameras", "{chase: {kind: chase}}");
  io::YamlNode written = io::yaml_mapping();
  for (const io::YamlEntry& camera : cameras.entries) {
    check_name(camera, "pictures.cameras", "camera");
    if (camera.value.is_null()) continue;
    io::YamlNode one = io::yaml_mapping();
    pictures.cameras.push_back(
        read_camera(camera, "pictures.cameras." + camera.key, vehicles, one));
    written.put(camera.key, std::move(one));
  }
  resolved.put("cameras", std::move(written));
  return pictures;
}

}  // namespace vinerow::scenario

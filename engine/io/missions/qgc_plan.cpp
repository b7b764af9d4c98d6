#include "engine/io/missions/qgc_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/io/files/json_text.h"
#include "engine/io/missions/mission_item_check.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

using nlohmann::json;

/// Reader of JSON members, with the file and the place in it for error messages.
class Reader {
 public:
  Reader(const json& object, std::string place) : object_(object), place_(std::move(place)) {
    if (!object_.is_object()) fail("it is not a JSON object");
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw ConfigError(fmt::format("{}: {}", place_, what));
  }
  const json& member(const char* name) const {
    const auto found = object_.find(name);
    if (found == object_.end()) fail(fmt::format("'{}' is missing", name));
    return *found;
  }
  const json& list(const char* name) const {
    const json& value = member(name);
    if (!value.is_array()) fail(fmt::format("'{}' must be a list", name));
    return value;
  }
  Reader object(const char* name) const {
    return {member(name), fmt::format("{}, {}", place_, name)};
  }
  int integer(const char* name) const {
    const json& value = member(name);
    if (!value.is_number_integer() || std::abs(value.get<double>()) > 1e6) {
      fail(fmt::format("'{}' = {} must be a whole number", name, value.dump()));
    }
    return value.get<int>();
  }
  std::string text(const char* name) const {
    const json& value = member(name);
    if (!value.is_string()) fail(fmt::format("'{}' = {} must be a text", name, value.dump()));
    return value.get<std::string>();
  }
  bool boolean(const char* name) const {
    const json& value = member(name);
    if (!value.is_boolean())
      fail(fmt::format("'{}' = {} must be true or false", name, value.dump()));
    return value.get<bool>();
  }
  double positive(const char* name) const {
    const json& value = member(name);
    if (!value.is_number() || !(value.get<double>() > 0.0)) {
      fail(fmt::format("'{}' = {} must be a number > 0", name, value.dump()));
    }
    return value.get<double>();
  }
  void require_version(int wanted) const {
    const int version = integer("version");
    if (version != wanted) {
      fail(fmt::format("version {} is not known, only version {} is", version, wanted));
    }
  }
  bool has(const char* name) const { return object_.contains(name); }
  const std::string& place() const { return place_; }

  /// [latitude, longitude] or with altitude.
  Geodetic position(const json& value, bool with_altitude) const {
    const std::size_t count = with_altitude ? 3 : 2;
    const auto is_number = [](const json& number) { return number.is_number(); };
    if (!value.is_array() || value.size() < count ||
        !std::all_of(value.begin(), value.end(), is_number)) {
      fail(fmt::format("{} must be [latitude, longitude{}]", value.dump(),
                       with_altitude ? ", altitude" : ""));
    }
    const double latitude_deg = value[0], longitude_deg = value[1];
    if (!(std::abs(latitude_deg) <= 90.0) || !(std::abs(longitude_deg) <= 180.0)) {
      fail(fmt::format(
          "{} is not a valid position: latitude must be within +-90 deg, longitude within +-180",
          value.dump()));
    }
    return {rad_from_deg(latitude_deg), rad_from_deg(longitude_deg),
            with_altitude ? value[2].get<double>() : 0.0};
  }

 private:
  const json& object_;
  std::string place_;
};

MissionItem read_simple_item(const Reader& reader, int number, const std::filesystem::path& file) {
  MissionItem item;
  item.number = number;
  item.command = reader.integer("command");
  item.frame = reader.integer("frame");
  item.auto_continue = reader.boolean("autoContinue");
  const json& params = reader.list("params");
  if (params.size() != item.params.size()) {
    reader.fail(fmt::format("'params' has {} numbers, must be 7", params.size()));
  }
  for (std::size_t i = 0; i < item.params.size(); ++i) {
    if (!params[i].is_number() && !params[i].is_null()) {
      reader.fail(
          fmt::format("parameter {} = {} must be a number or null", i + 1, params[i].dump()));
    }
    item.params[i] =
        params[i].is_null() ? std::numeric_limits<double>::quiet_NaN() : params[i].get<double>();
  }
  check_mission_item(item, file);
  return item;
}

void read_complex_item(const Reader& reader, int number, MissionFile& mission) {
  const std::string kind = reader.text("complexItemType");
  if (kind != "survey") {
    reader.fail(fmt::format(
        "complex items of type '{}' are not known, only 'survey' is; save the mission with simple "
        "items instead",
        kind));
  }
  constexpr int kSurveyVersion = 5;
  reader.require_version(kSurveyVersion);
  const Reader transects = reader.object("TransectStyleComplexItem");
  int inner = 0;
  for (const json& entry : transects.list("Items")) {
    const Reader item(entry, fmt::format("{}.{}", reader.place(), ++inner));
    if (item.text("type") != "SimpleItem") item.fail("an item of a survey must be a SimpleItem");
    mission.items.push_back(read_simple_item(item, number, mission.file));
  }
}

void read_items(const Reader& reader, MissionFile& mission) {
  int number = 0;
  for (const json& entry : reader.list("items")) {
    ++number;
    const Reader item(entry, mission_place(mission.file, number));
    const std::string type = item.text("type");
    if (type == "SimpleItem") {
      mission.items.push_back(read_simple_item(item, number, mission.file));
    } else if (type == "ComplexItem") {
      read_complex_item(item, number, mission);
    } else {
      item.fail(fmt::format("type '{}' is not known, only SimpleItem and ComplexItem are", type));
    }
  }
}

void read_fences(const Reader& root, MissionFile& mission) {
  if (!root.has("geoFence")) return;
  const Reader fences = root.object("geoFence");
  fences.require_version(2);
  int number = 0;
  for (const json& entry : fences.list("polygons")) {
    const Reader polygon(entry, fmt::format("{}, polygon {}", fences.place(), ++number));
    FencePolygon& fence = mission.fence_polygons.emplace_back();
    fence.inclusion = polygon.boolean("inclusion");
    for (const json& point : polygon.list("polygon")) {
      fence.points.push_back(polygon.position(point, false));
    }
    if (fence.points.size() < 3) {
      polygon.fail(fmt::format("it has {} points, needs at least 3", fence.points.size()));
    }
  }
  number = 0;
  for (const json& entry : fences.list("circles")) {
    const Reader circle(entry, fmt::format("{}, circle {}", fences.place(), ++number));
    const Reader shape = circle.object("circle");
    mission.fence_circles.push_back({circle.boolean("inclusion"),
                                     shape.position(shape.member("center"), false),
                                     shape.positive("radius")});
  }
}

void read_rally_points(const Reader& root, MissionFile& mission) {
  if (!root.has("rallyPoints")) return;
  const Reader rally = root.object("rallyPoints");
  rally.require_version(2);
  for (const json& point : rally.list("points")) {
    mission.rally_points.push_back(rally.position(point, true));
  }
}

}  // namespace

MissionFile parse_qgc_plan(const std::string& text, const std::filesystem::path& file) {
  const json root = parse_json(text, fmt::format("mission file '{}'", file.string()));
  const Reader reader(root, fmt::format("mission '{}'", file.string()));
  if (!reader.has("fileType") || !reader.member("fileType").is_string() ||
      reader.text("fileType") != "Plan") {
    reader.fail("it is JSON, but its 'fileType' is not 'Plan': it is not a QGroundControl plan");
  }
  reader.require_version(1);
  MissionFile mission;
  mission.file = file;
  mission.format = "QGroundControl plan";
  const Reader part = reader.object("mission");
  part.require_version(2);
  read_items(part, mission);
  if (part.has("plannedHomePosition")) {
    mission.planned_home = part.position(part.member("plannedHomePosition"), true);
  }
  if (part.has("cruiseSpeed")) mission.cruise_speed_mps = part.positive("cruiseSpeed");
  if (part.has("hoverSpeed")) mission.hover_speed_mps = part.positive("hoverSpeed");
  read_fences(reader, mission);
  read_rally_points(reader, mission);
  return mission;
}

}  // namespace vinerow::io

#include "engine/io/missions/gis_mission.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/io/geo/geo_features.h"
#include "engine/io/missions/mission_item_check.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

constexpr int kWaypointCommand = 16, kReturnCommand = 20, kLandCommand = 21;
constexpr int kSpeedCommand = 178, kSprayerCommand = 216;
constexpr int kAboveSea = 0, kNoPlace = 2, kAboveHome = 3, kAboveGround = 10;

std::string place_of_feature(const std::filesystem::path& file, const GeoFeature& feature) {
  return fmt::format("mission '{}', feature {}", file.string(), feature.index);
}

/// Value of a property; nullopt if it is missing.
std::optional<double> property_number(const std::filesystem::path& file, const GeoFeature& feature,
                                      const std::string& name) {
  const std::string text = feature.property(name);
  if (text.empty() || text == "null") return std::nullopt;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(value)) {
    return value;
  }
  throw ConfigError(fmt::format("{}: {} = '{}' is not a number", place_of_feature(file, feature),
                                name, text.substr(0, 40)));
}

/// Value of a property; nullopt if it is missing.
std::optional<bool> property_switch(const std::filesystem::path& file, const GeoFeature& feature,
                                    const std::string& name) {
  const std::string text = feature.property(name);
  if (text.empty() || text == "null") return std::nullopt;
  if (text == "1" || text == "true" || text == "on") return true;
  if (text == "0" || text == "false" || text == "off") return false;
  throw ConfigError(fmt::format("{}: {} = '{}', must be true or false",
                                place_of_feature(file, feature), name, text.substr(0, 40)));
}

class Route {
 public:
  explicit Route(const std::filesystem::path& file) { mission_.file = file; }

  void add_fence(const GeoFeature& feature) {
    const std::string kind = feature.property("fence");
    if (kind.empty() || kind == "null") return;
    if (kind != "inclusion" && kind != "exclusion") {
      throw ConfigError(fmt::format("{}: fence = '{}', must be inclusion or exclusion",
                                    place_of_feature(mission_.file, feature), kind.substr(0, 40)));
    }
    FencePolygon fence{kind == "inclusion", feature.points};
    // The last point of the ring repeats the first.
    if (fence.points.size() > 3) fence.points.pop_back();
    for (Geodetic& point : fence.points) point.altitude_m = 0.0;
    mission_.fence_polygons.push_back(std::move(fence));
  }

  /// Adds a line from start to end, or a point.
  void add_path(const GeoFeature& feature) {
    const std::optional<double> speed_mps = property_number(mission_.file, feature, "speed_mps");
    if (speed_mps && !(*speed_mps > 0.0)) {
      throw ConfigError(fmt::format("{}: speed_mps = {}, must be > 0",
                                    place_of_feature(mission_.file, feature), *speed_mps));
    }
    const bool sprays = property_switch(mission_.file, feature, "sprayer").value_or(false);
    const std::optional<double> height_m = property_number(mission_.file, feature, "height_m");
    const int number = feature.index + 1;
    // As <altitudeMode> of KML defines it; other formats have no such property.
    const std::string mode = feature.property("altitudemode");
    const bool has_altitude = !height_m && feature.has_altitude && mode != "clampToGround";
    const int frame = !has_altitude                ? kAboveHome
                      : mode == "relativeToGround" ? kAboveGround
                                                   : kAboveSea;
    bool is_first = true;
    for (const Geodetic& point : feature.points) {
      MissionItem item;
      item.command = kWaypointCommand;
      item.frame = frame;
      item.number = number;
      item.params[4] = deg_from_rad(point.latitude_rad);
      item.params[5] = deg_from_rad(point.longitude_rad);
      item.params[6] = has_altitude ? point.altitude_m : height_m.value_or(0.0);
      add(item);
      last_place_ = item;
      if (!is_first) continue;
      // These take effect from the preceding position.
      if (speed_mps) add_command(kSpeedCommand, number, 1.0, *speed_mps);
      if (sprays) add_command(kSprayerCommand, number, 1.0, 0.0);
      is_first = false;
    }
    if (sprays) add_command(kSprayerCommand, number, 0.0, 0.0);
  }

  /// What comes after a line or point, its property `at_end`. @param is_last  whether nothing
  /// follows
  void add_end(const GeoFeature& feature, bool is_last) {
    const std::string end = feature.property("at_end");
    if (end.empty() || end == "null") return;
    const std::string place = place_of_feature(mission_.file, feature);
    if (end != "land" && end != "return") {
      throw ConfigError(
          fmt::format("{}: at_end = '{}', must be land or return", place, end.substr(0, 40)));
    }
    if (!is_last) {
      throw ConfigError(
          fmt::format("{}: at_end = '{}', but another line or point follows", place, end));
    }
    if (end == "return") return add_command(kReturnCommand, feature.index + 1, 0.0, 0.0);
    MissionItem landing = last_place_;
    landing.command = kLandCommand;
    landing.frame = kAboveHome;
    landing.params[6] = 0.0;
    add(landing);
  }

  MissionFile take() { return std::move(mission_); }

 private:
  void add(const MissionItem& item) {
    check_mission_item(item, mission_.file);
    mission_.items.push_back(item);
  }
  void add_command(int command, int number, double first, double second) {
    MissionItem item;
    item.command = command;
    item.frame = kNoPlace;
    item.number = number;
    item.params[0] = first;
    item.params[1] = second;
    add(item);
  }

  MissionFile mission_;
  MissionItem last_place_;
};

/// Sorts by `order` or `number` if all have it.
void sort_points(const std::filesystem::path& file, std::vector<GeoFeature>& points) {
  for (const char* name : {"order", "number"}) {
    const bool all_have = std::all_of(points.begin(), points.end(), [&](const GeoFeature& point) {
      return property_number(file, point, name).has_value();
    });
    if (!all_have) continue;
    std::stable_sort(points.begin(), points.end(), [&](const GeoFeature& a, const GeoFeature& b) {
      return *property_number(file, a, name) < *property_number(file, b, name);
    });
    return;
  }
}

}  // namespace

bool is_gis_mission(const std::filesystem::path& file) {
  const std::string ending = lower_extension(file);
  return ending == ".gpkg" || ending == ".kml" || ending == ".kmz" || ending == ".shp" ||
         ending == ".geojson";
}

MissionFile read_gis_mission(const std::filesystem::path& file) {
  Route route(file);
  std::vector<GeoFeature> lines, points;
  for (GeoFeature& feature : read_features(file)) {
    if (feature.kind == GeometryKind::kPolygon) {
      route.add_fence(feature);
    } else {
      (feature.kind == GeometryKind::kPoint ? points : lines).push_back(std::move(feature));
    }
  }
  if (lines.empty() && points.empty()) {
    throw ConfigError(fmt::format("mission '{}' has neither lines nor points", file.string()));
  }
  sort_points(file, points);
  const std::vector<GeoFeature>& features = lines.empty() ? points : lines;
  for (std::size_t i = 0; i < features.size(); ++i) {
    route.add_path(features[i]);
    const bool is_last = i + 1 == features.size();
    // The parts of a multiple geometry have its properties each.
    if (!is_last && features[i + 1].index == features[i].index) continue;
    route.add_end(features[i], is_last);
  }
  MissionFile mission = route.take();
  mission.format = "lines and points of a map";
  return mission;
}

}  // namespace vinerow::io

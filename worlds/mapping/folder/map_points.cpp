#include "worlds/mapping/folder/map_points.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/whole_file.h"
#include "worlds/mapping/folder/json_reader.h"

namespace vinerow::mapping {
namespace {

constexpr int kPointsVersion = 1;
constexpr const char *kHowRead = "points.json", *kClasses = "points.classes";

nlohmann::json parse_points(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  try {
    return nlohmann::json::parse(in);
  } catch (const nlohmann::json::exception&) {
    throw ConfigError(fmt::format("points of a map '{}' are not valid JSON", file.string()));
  }
}

PointClass point_class(char byte, const std::filesystem::path& file) {
  const auto of = static_cast<PointClass>(byte);
  switch (of) {
    case PointClass::kUnclassified:
    case PointClass::kGround:
    case PointClass::kLowVegetation:
    case PointClass::kCanopy:
    case PointClass::kOther:
      return of;
  }
  throw ConfigError(
      fmt::format("'{}' contains {}, which is not a point class", file.string(), int{byte}));
}

void write_bytes(const std::filesystem::path& file, const char* bytes, std::size_t count) {
  write_whole_file(file, {bytes, count});
}

}  // namespace

void save_map_points(const MapPoints& points, const std::filesystem::path& folder) {
  nlohmann::ordered_json out;
  out["vinerow_map_points"] = kPointsVersion;
  out["points"] = points.classes.size();
  out["crs"] = points.reading.crs;
  out["thin"] = points.reading.thin;
  const std::optional<GeoOrigin>& origin = points.reading.origin;
  // In radians: degrees would lose the last bits.
  out["origin"] = origin ? nlohmann::ordered_json{{"latitude_rad", origin->latitude_rad},
                                                  {"longitude_rad", origin->longitude_rad},
                                                  {"altitude_m", origin->altitude_m}}
                         : nlohmann::ordered_json(nullptr);
  const OccupancyOptions& occupancy = points.occupancy;
  out["occupancy"] = {{"cell_m", occupancy.cell_m},
                      {"virtual_walls", occupancy.virtual_walls ? 1 : 0},
                      {"first_wall", !occupancy.first_wall                     ? "auto"
                                     : *occupancy.first_wall == RowEnd::kFirst ? "first"
                                                                               : "last"}};
  static_assert(sizeof(PointClass) == 1);
  write_bytes(folder / kClasses, reinterpret_cast<const char*>(points.classes.data()),
              points.classes.size());
  const std::string text = out.dump(1) + "\n";
  write_bytes(folder / kHowRead, text.data(), text.size());
}

std::optional<MapPoints> load_map_points(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kHowRead, classes = folder / kClasses;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  const nlohmann::json parsed = parse_points(file);
  const JsonReader in(parsed, fmt::format("points of a map '{}'", file.string()));
  if (in.at("vinerow_map_points").whole(0) != kPointsVersion) {
    in.fail(fmt::format("are of another version, must be of version {}", kPointsVersion));
  }
  MapPoints points;
  points.reading.crs = in.at("crs").text();
  points.reading.thin = static_cast<std::uint64_t>(in.at("thin").whole(1));
  if (const auto origin = in.optional_at("origin")) {
    points.reading.origin =
        GeoOrigin{origin->at("latitude_rad").number(), origin->at("longitude_rad").number(),
                  origin->at("altitude_m").number()};
  }
  const JsonReader occupancy = in.at("occupancy");
  points.occupancy.cell_m = occupancy.at("cell_m").number();
  points.occupancy.virtual_walls = occupancy.at("virtual_walls").whole(0) != 0;
  const std::string wall = occupancy.at("first_wall").text();
  if (wall != "auto" && wall != "first" && wall != "last") {
    occupancy.at("first_wall").fail("must be auto, first or last");
  }
  if (wall != "auto")
    points.occupancy.first_wall = wall == "first" ? RowEnd::kFirst : RowEnd::kLast;

  const std::string all = read_bytes(classes).value_or("");
  const std::int64_t count = in.at("points").whole(0);
  if (static_cast<std::int64_t>(all.size()) != count) {
    throw ConfigError(fmt::format("'{}' contains {} classes, but points.json states {}",
                                  classes.string(), all.size(), count));
  }
  points.classes.reserve(all.size());
  for (const char byte : all) points.classes.push_back(point_class(byte, classes));
  return points;
}

ParcelCloud read_classified_cloud(const MapPoints& points, const std::filesystem::path& cloud) {
  CloudReadReport report;
  ParcelCloud read = read_parcel_cloud(cloud, points.reading, report);
  if (read.points.size() != points.classes.size()) {
    throw ConfigError(fmt::format("point cloud '{}' gives {} points, its map was made from {}",
                                  cloud.string(), read.points.size(), points.classes.size()));
  }
  read.classes = points.classes;
  return read;
}

}  // namespace vinerow::mapping

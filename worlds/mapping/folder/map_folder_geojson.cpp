#include <fmt/format.h>

#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "worlds/mapping/folder/map_folder.h"
#include "worlds/mapping/folder/map_gis.h"

namespace vinerow::mapping {
namespace {

/// 1e-9 deg is 0.1 mm.
std::string position(const LocalFrame& frame, const Eigen::Vector3d& p_W) {
  const Geodetic place = frame.to_geodetic(p_W);
  return fmt::format("[{:.9f}, {:.9f}, {:.3f}]", deg_from_rad(place.longitude_rad),
                     deg_from_rad(place.latitude_rad), place.altitude_m);
}

std::string line(const LocalFrame& frame, const std::vector<Eigen::Vector3d>& line_W) {
  std::string text;
  for (const Eigen::Vector3d& p : line_W) {
    text += (text.empty() ? "" : ", ") + position(frame, p);
  }
  return "[" + text + "]";
}

std::string feature(const std::string& properties, const char* kind,
                    const std::string& coordinates) {
  return fmt::format(
      "  {{\"type\": \"Feature\", \"properties\": {{{}}}, \"geometry\": {{\"type\": \"{}\", "
      "\"coordinates\": {}}}}}",
      properties, kind, coordinates);
}

}  // namespace

std::string map_to_geojson(const CloudMap& map) {
  const LocalFrame frame(map.origin);
  std::vector<std::string> features;
  for (std::size_t k = 0; k < map.map.rows.size(); ++k) {
    const PlantRow& row = map.map.rows[k];
    std::string properties = fmt::format("\"type\": \"row\", \"row\": {}", row.id);
    if (k < map.report.rows.size()) {
      properties += fmt::format(", \"block\": {}", map.report.rows[k].block);
      for (const auto& [name, value] : row_values(map.report.rows[k])) {
        properties += fmt::format(", \"{}\": {:.6g}", name, value);
      }
    }
    features.push_back(feature(properties, "LineString", line(frame, row.line_W)));
  }
  for (const PlantRow& row : map.map.rows) {
    for (const bool last : {false, true}) {
      features.push_back(feature(fmt::format("\"type\": \"row_end\", \"row\": {}, \"end\": \"{}\"",
                                             row.id, last ? "last" : "first"),
                                 "Point",
                                 position(frame, last ? row.line_W.back() : row.line_W.front())));
    }
  }
  for (const Alley& alley : map.map.alleys) {
    features.push_back(feature(fmt::format("\"type\": \"mid_row_line\", \"alley\": {}, "
                                           "\"width_m\": {:.3f}",
                                           alley.id, alley.width_m),
                               "LineString", line(frame, alley.line_W)));
  }
  if (!map.map.boundary_W.empty()) {
    std::vector<Eigen::Vector3d> ring_W;
    for (const Eigen::Vector2d& p : map.map.boundary_W) {
      const double z = map.map.terrain ? map.map.terrain->height_m(p.x(), p.y()) : 0.0;
      ring_W.emplace_back(p.x(), p.y(), z);
    }
    ring_W.push_back(ring_W.front());
    features.push_back(
        feature("\"type\": \"boundary\"", "Polygon", "[" + line(frame, ring_W) + "]"));
  }
  std::string text = "{\"type\": \"FeatureCollection\", \"features\": [\n";
  for (std::size_t k = 0; k < features.size(); ++k) {
    text += features[k] + (k + 1 < features.size() ? ",\n" : "\n");
  }
  return text + "]}\n";
}

}  // namespace vinerow::mapping

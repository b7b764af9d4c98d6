#include "worlds/mapping/folder/map_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "worlds/mapping/folder/json_reader.h"

namespace vinerow::mapping {
namespace {

using json = nlohmann::ordered_json;

json json_of(const Eigen::Vector2d& p) {
  return json::array({p.x(), p.y()});
}
json json_of(const Eigen::Vector3d& p) {
  return json::array({p.x(), p.y(), p.z()});
}
template <class Point>
json json_of(const std::vector<Point>& points) {
  json list = json::array();
  for (const Point& p : points) list.push_back(json_of(p));
  return list;
}

/// Degrees from which rad_from_deg() returns the same bits, if there are any.
double exact_deg(double angle_rad) {
  const double middle_deg = deg_from_rad(angle_rad);
  double up = middle_deg, down = middle_deg;
  for (int k = 0; k < 4; ++k) {
    if (rad_from_deg(up) == angle_rad) return up;
    if (rad_from_deg(down) == angle_rad) return down;
    up = std::nextafter(up, 1e3);
    down = std::nextafter(down, -1e3);
  }
  return middle_deg;
}

json figures_json(const MappedRowFigures& f) {
  json gaps = json::array();
  for (const auto& [from, to] : f.gaps_m) gaps.push_back(json::array({from, to}));
  return {{"row", f.row},
          {"block", f.block},
          {"first_m", json_of(f.first_W)},
          {"last_m", json_of(f.last_W)},
          {"length_m", f.length_m},
          {"bearing_deg", f.bearing_deg},
          {"spacing_m", f.spacing_m},
          {"canopy_base_m", f.canopy_base_m},
          {"canopy_top_m", f.canopy_top_m},
          {"canopy_width_m", f.canopy_width_m},
          {"volume_m3", f.volume_m3},
          {"seen_volume_m3", f.seen_volume_m3},
          {"containment", f.containment},
          {"points", f.points},
          {"triangles", f.triangles},
          {"gaps_m", gaps}};
}

MappedRowFigures read_figures(const JsonReader& in) {
  MappedRowFigures f;
  f.row = static_cast<int>(in.at("row").whole(0));
  // Maps of versions without blocks lack the key.
  if (in.has("block")) f.block = static_cast<int>(in.at("block").whole(0));
  f.first_W = in.at("first_m").vector<3>();
  f.last_W = in.at("last_m").vector<3>();
  f.length_m = in.at("length_m").number();
  f.bearing_deg = in.at("bearing_deg").number();
  f.spacing_m = in.at("spacing_m").number();
  f.canopy_base_m = in.at("canopy_base_m").number();
  f.canopy_top_m = in.at("canopy_top_m").number();
  f.canopy_width_m = in.at("canopy_width_m").number();
  f.volume_m3 = in.at("volume_m3").number();
  f.seen_volume_m3 = in.at("seen_volume_m3").number();
  f.containment = in.at("containment").number();
  f.points = in.at("points").whole(0);
  f.triangles = in.at("triangles").whole(0);
  for (const JsonReader& gap : in.at("gaps_m").items()) {
    const Eigen::Vector2d ends = gap.vector<2>();
    f.gaps_m.emplace_back(ends.x(), ends.y());
  }
  return f;
}

json report_json(const CloudMapReport& r) {
  json rows = json::array(), notes = json::array();
  for (const MappedRowFigures& row : r.rows) rows.push_back(figures_json(row));
  for (const std::string& note : r.notes) notes.push_back(note);
  return {{"cloud",
           {{"file", r.file},
            {"format", r.format},
            {"crs", r.crs},
            {"bytes", r.cloud_bytes},
            {"points", r.points},
            {"not_finite", r.not_finite},
            {"ground_points", r.ground_points},
            {"low_points", r.low_points},
            {"canopy_points", r.canopy_points},
            {"other_points", r.other_points},
            {"density_per_m2", r.density_per_m2},
            {"noise_m", r.noise_m}}},
          {"vineyard",
           {{"row_count", r.rows.size()},
            {"bearing_deg", r.bearing_deg},
            {"spacing_m", r.spacing_m},
            {"spacing_std_m", r.spacing_std_m},
            {"canopy_top_m", r.canopy_top_m},
            {"canopy_width_m", r.canopy_width_m},
            {"volume_m3", r.volume_m3},
            {"seen_volume_m3", r.seen_volume_m3}}},
          {"meshes",
           {{"triangles", r.triangles},
            {"bytes", r.mesh_bytes},
            {"reduction", r.reduction},
            {"containment", r.containment}}},
          {"rows", rows},
          {"notes", notes}};
}

CloudMapReport read_report(const JsonReader& in) {
  CloudMapReport r;
  const JsonReader cloud = in.at("cloud"), vineyard = in.at("vineyard"), meshes = in.at("meshes");
  r.file = cloud.at("file").text();
  r.format = cloud.at("format").text();
  r.crs = cloud.at("crs").text();
  r.cloud_bytes = cloud.at("bytes").whole(0);
  r.points = cloud.at("points").whole(0);
  r.not_finite = cloud.at("not_finite").whole(0);
  r.ground_points = cloud.at("ground_points").whole(0);
  r.low_points = cloud.at("low_points").whole(0);
  r.canopy_points = cloud.at("canopy_points").whole(0);
  r.other_points = cloud.at("other_points").whole(0);
  r.density_per_m2 = cloud.at("density_per_m2").number();
  r.noise_m = cloud.at("noise_m").number();
  r.bearing_deg = vineyard.at("bearing_deg").number();
  r.spacing_m = vineyard.at("spacing_m").number();
  r.spacing_std_m = vineyard.at("spacing_std_m").number();
  r.canopy_top_m = vineyard.at("canopy_top_m").number();
  r.canopy_width_m = vineyard.at("canopy_width_m").number();
  r.volume_m3 = vineyard.at("volume_m3").number();
  r.seen_volume_m3 = vineyard.at("seen_volume_m3").number();
  r.triangles = meshes.at("triangles").whole(0);
  r.mesh_bytes = meshes.at("bytes").whole(0);
  r.reduction = meshes.at("reduction").number();
  r.containment = meshes.at("containment").number();
  for (const JsonReader& row : in.at("rows").items()) r.rows.push_back(read_figures(row));
  for (const JsonReader& note : in.at("notes").items()) r.notes.push_back(note.text());
  return r;
}

json grid_json(const char* file, int columns, int rows, double cell_m,
               const Eigen::Vector2d& corner_W) {
  return {{"file", file},
          {"columns", columns},
          {"rows", rows},
          {"cell_m", cell_m},
          {"corner_m", json_of(corner_W)}};
}

std::optional<MapFiles::Grid> read_grid(const JsonReader& in, const std::string& key, int minimum) {
  const auto given = in.optional_at(key);
  if (!given) return std::nullopt;
  MapFiles::Grid grid;
  grid.columns = static_cast<int>(given->at("columns").whole(minimum));
  grid.rows = static_cast<int>(given->at("rows").whole(minimum));
  grid.cell_m = given->at("cell_m").number_above(0.0);
  grid.corner_W = given->at("corner_m").vector<2>();
  return grid;
}

std::vector<Eigen::Vector3d> read_line(const JsonReader& in) {
  std::vector<Eigen::Vector3d> line_W;
  for (const JsonReader& p : in.items()) line_W.push_back(p.vector<3>());
  return line_W;
}

void check_line(const std::vector<Eigen::Vector3d>& line_W, const std::string& owner) {
  if (line_W.size() < 2) {
    throw ConfigError(
        fmt::format("{}: its line has {} points, needs at least 2", owner, line_W.size()));
  }
  for (std::size_t k = 0; k < line_W.size(); ++k) {
    if (!line_W[k].allFinite()) {
      throw ConfigError(fmt::format("{}: point {} of its line is not finite", owner, k));
    }
    if (k > 0 && !((line_W[k] - line_W[k - 1]).head<2>().norm() > 1e-6)) {
      throw ConfigError(
          fmt::format("{}: points {} and {} of its line are the same place", owner, k - 1, k));
    }
  }
}

void check_positive(double value, const std::string& what) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw ConfigError(fmt::format("{} is {} m, must be > 0", what, value));
  }
}

}  // namespace

std::string map_to_json(const CloudMap& map) {
  const RowMap& m = map.map;
  json out;
  out["vinerow_map"] = kMapVersion;
  out["frame"] = "metres east, north and up of the origin, straight axes";
  out["origin"] = map.has_origin ? json{{"latitude_deg", exact_deg(map.origin.latitude_rad)},
                                        {"longitude_deg", exact_deg(map.origin.longitude_rad)},
                                        {"altitude_m", map.origin.altitude_m}}
                                 : json(nullptr);
  std::map<int, int> hulls;
  for (const RowMesh& mesh : m.meshes) ++hulls[mesh.row];
  out["rows"] = json::array();
  for (const PlantRow& row : m.rows) {
    out["rows"].push_back({{"id", row.id},
                           {"canopy_width_m", row.canopy_width_m},
                           {"canopy_base_m", row.canopy_base_m},
                           {"canopy_top_m", row.canopy_top_m},
                           {"hulls", hulls[row.id]},
                           {"line_m", json_of(row.line_W)}});
  }
  out["alleys"] = json::array();
  for (const Alley& alley : m.alleys) {
    out["alleys"].push_back(
        {{"id", alley.id}, {"width_m", alley.width_m}, {"line_m", json_of(alley.line_W)}});
  }
  out["boundary_m"] = json_of(m.boundary_W);
  out["accuracy"] = {{"surface_std_m", m.accuracy.surface_std_m},
                     {"correlation_length_m", m.accuracy.correlation_length_m},
                     {"offset_std_m", json_of(m.accuracy.offset_std_m)}};
  out["terrain"] = m.terrain ? grid_json("terrain.tif", m.terrain->columns, m.terrain->rows,
                                         m.terrain->cell_m, m.terrain->corner_W)
                             : json(nullptr);
  out["occupancy"] = m.occupancy.empty()
                         ? json(nullptr)
                         : grid_json("occupancy.yaml", m.occupancy.columns, m.occupancy.rows,
                                     m.occupancy.cell_m, m.occupancy.corner_W);
  out["report"] = report_json(map.report);
  return out.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string report_to_json(const CloudMapReport& report) {
  json out;
  out["vinerow_map_report"] = kMapVersion;
  out.update(report_json(report));
  return out.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

CloudMap map_from_json(const std::string& text, const std::filesystem::path& file,
                       MapFiles& files) {
  const std::string subject = fmt::format("map file '{}'", file.string());
  nlohmann::json parsed;
  try {
    parsed = nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception&) {
    // The number of lines before the position gives the line of the error.
    throw ConfigError(fmt::format("{} is not valid JSON, or cut off", subject));
  }
  const JsonReader in(parsed, subject);
  const std::int64_t version = in.at("vinerow_map").whole(1);
  if (version != kMapVersion) {
    throw ConfigError(fmt::format("{} is of version {}, this program reads version {}", subject,
                                  version, kMapVersion));
  }
  CloudMap map;
  if (const auto origin = in.optional_at("origin")) {
    map.has_origin = true;
    map.origin = {rad_from_deg(origin->at("latitude_deg").number()),
                  rad_from_deg(origin->at("longitude_deg").number()),
                  origin->at("altitude_m").number()};
  }
  RowMap& m = map.map;
  files = {};
  for (const JsonReader& row : in.at("rows").items()) {
    m.rows.push_back({static_cast<int>(row.at("id").whole(0)), read_line(row.at("line_m")),
                      row.at("canopy_width_m").number(), row.at("canopy_base_m").number(),
                      row.at("canopy_top_m").number()});
    const int hulls = static_cast<int>(row.at("hulls").whole(0));
    if (hulls > 0) files.hulls.emplace_back(m.rows.back().id, hulls);
  }
  for (const JsonReader& alley : in.at("alleys").items()) {
    m.alleys.push_back({static_cast<int>(alley.at("id").whole(0)), read_line(alley.at("line_m")),
                        alley.at("width_m").number()});
  }
  for (const JsonReader& corner : in.at("boundary_m").items()) {
    m.boundary_W.push_back(corner.vector<2>());
  }
  const JsonReader accuracy = in.at("accuracy");
  m.accuracy.surface_std_m = accuracy.at("surface_std_m").number();
  m.accuracy.correlation_length_m = accuracy.at("correlation_length_m").number();
  m.accuracy.offset_std_m = accuracy.at("offset_std_m").vector<3>();
  files.terrain = read_grid(in, "terrain", 2);
  files.occupancy = read_grid(in, "occupancy", 1);
  map.report = read_report(in.at("report"));
  return map;
}

void check_map(const CloudMap& map, const std::string& name) {
  const RowMap& m = map.map;
  if (map.has_origin &&
      (!(std::abs(map.origin.latitude_rad) <= 0.5 * kPi) ||
       !(std::abs(map.origin.longitude_rad) <= kPi) || !std::isfinite(map.origin.altitude_m))) {
    throw ConfigError(fmt::format(
        "{}: its origin is {:g} deg north, {:g} deg east, {:g} m, must be within +-90, +-180", name,
        deg_from_rad(map.origin.latitude_rad), deg_from_rad(map.origin.longitude_rad),
        map.origin.altitude_m));
  }
  if (m.rows.empty()) throw ConfigError(fmt::format("{} has no rows", name));
  std::set<int> ids;
  for (const PlantRow& row : m.rows) {
    const std::string owner = fmt::format("{}: row {}", name, row.id);
    if (row.id < 0 || !ids.insert(row.id).second) {
      throw ConfigError(fmt::format("{}: its number is negative, or another row's too", owner));
    }
    check_line(row.line_W, owner);
    check_positive(row.canopy_width_m, owner + ": its canopy_width_m");
    if (!(row.canopy_base_m < row.canopy_top_m) || !std::isfinite(row.canopy_base_m) ||
        !std::isfinite(row.canopy_top_m)) {
      throw ConfigError(fmt::format("{}: its canopy reaches from {} m to {} m, must be upward",
                                    owner, row.canopy_base_m, row.canopy_top_m));
    }
  }
  for (const Alley& alley : m.alleys) {
    const std::string owner = fmt::format("{}: alley {}", name, alley.id);
    check_line(alley.line_W, owner);
    check_positive(alley.width_m, owner + ": its width_m");
  }
  if (!m.boundary_W.empty() && m.boundary_W.size() < 3) {
    throw ConfigError(fmt::format("{}: its boundary has {} corners, needs at least 3, or none",
                                  name, m.boundary_W.size()));
  }
  for (const Eigen::Vector2d& corner : m.boundary_W) {
    if (!corner.allFinite()) {
      throw ConfigError(fmt::format("{}: a corner of its boundary is not finite", name));
    }
  }
  check_positive(m.accuracy.surface_std_m, name + ": its surface_std_m");
  check_positive(m.accuracy.correlation_length_m, name + ": its correlation_length_m");
  if (!m.accuracy.offset_std_m.allFinite() || m.accuracy.offset_std_m.minCoeff() < 0.0) {
    throw ConfigError(fmt::format("{}: its offset_std_m must be three numbers >= 0", name));
  }
  for (const RowMesh& mesh : m.meshes) {
    if (ids.count(mesh.row) == 0) {
      throw ConfigError(
          fmt::format("{}: a mesh is of row {}, which it does not have", name, mesh.row));
    }
    for (const Eigen::Vector3f& v : mesh.mesh_W.vertices) {
      if (!v.allFinite()) {
        throw ConfigError(
            fmt::format("{}: a mesh of row {} has a vertex that is not finite", name, mesh.row));
      }
    }
  }
  if (m.terrain) {
    const HeightField& t = *m.terrain;
    if (t.columns < 2 || t.rows < 2 ||
        t.heights_m.size() != static_cast<std::size_t>(t.columns) * t.rows) {
      throw ConfigError(fmt::format("{}: its terrain of {} x {} samples holds {} heights", name,
                                    t.columns, t.rows, t.heights_m.size()));
    }
    check_positive(t.cell_m, name + ": its terrain's cell_m");
  }
}

}  // namespace vinerow::mapping

#include <nlohmann/json.hpp>

#include "worlds/mapping/folder/map_json.h"

namespace vinerow::mapping {
namespace {

using json = nlohmann::ordered_json;

json number(const char* description) {
  return {{"type", "number"}, {"description", description}};
}
json positive(const char* description) {
  json spec = number(description);
  spec["exclusiveMinimum"] = 0;
  return spec;
}
json at_least_zero(const char* description) {
  json spec = number(description);
  spec["minimum"] = 0;
  return spec;
}
json share(const char* description) {
  json spec = at_least_zero(description);
  spec["maximum"] = 1;
  return spec;
}
json whole(const char* description, int minimum = 0) {
  return {{"type", "integer"}, {"minimum", minimum}, {"description", description}};
}
json text(const char* description) {
  return {{"type", "string"}, {"description", description}};
}
json point(int size, const char* description) {
  return {{"type", "array"},
          {"items", {{"type", "number"}}},
          {"minItems", size},
          {"maxItems", size},
          {"description", description}};
}
json list(const json& items, int minimum, const char* description) {
  return {{"type", "array"}, {"items", items}, {"minItems", minimum}, {"description", description}};
}
/// Every key is there and there is no other.
json object(const json& properties, const char* description) {
  json keys = json::array();
  for (const auto& [key, value] : properties.items()) keys.push_back(key);
  return {{"type", "object"},
          {"properties", properties},
          {"required", keys},
          {"additionalProperties", false},
          {"description", description}};
}
json or_null(json spec) {
  return {{"oneOf", json::array({json{{"type", "null"}}, std::move(spec)})}};
}

json line_schema() {
  return list(point(3, "x, y, z in W, m"), 2, "from one end to the other, on the ground");
}

json row_figures() {
  return object(
      {{"row", whole("its id")},
       {"block", whole("of rows side by side, the largest is 0")},
       {"first_m", point(3, "the canopy's first point on the ground, W, m")},
       {"last_m", point(3, "the canopy's last point on the ground, W, m")},
       {"length_m", at_least_zero("along the line")},
       {"bearing_deg", number("first to last point, clockwise from north")},
       {"spacing_m", at_least_zero("mean distance to the next row; 0: the last row")},
       {"canopy_base_m", number("above the ground, mean over the row")},
       {"canopy_top_m", number("above the ground, mean over the row")},
       {"canopy_width_m", at_least_zero("mean over the row")},
       {"volume_m3", at_least_zero("inside its meshes")},
       {"seen_volume_m3", number("estimate of the seen canopy without the bias of noise")},
       {"containment", share("of its points within 1 cm of the inside of its meshes")},
       {"points", whole("of canopy")},
       {"triangles", whole("of its meshes")},
       {"gaps_m", list(point(2, "from, to"), 0, "without canopy, along the line")}},
      "figures of a row");
}

json report_properties() {
  return {
      {"cloud", object({{"file", text("as it was given")},
                        {"format", text("like LAS 1.4")},
                        {"crs", text("coordinate reference system, or empty")},
                        {"bytes", whole("of the file")},
                        {"points", whole("read")},
                        {"not_finite", whole("points left out: NaN or infinite")},
                        {"ground_points", whole("points on the ground")},
                        {"low_points", whole("points of grass, weeds, under the canopy")},
                        {"canopy_points", whole("points of plant rows")},
                        {"other_points", whole("points as high as canopy, of no row")},
                        {"density_per_m2", at_least_zero("points over the covered ground")},
                        {"noise_m", at_least_zero("1 sigma of ground points about the terrain")}},
                       "the point cloud")},
      {"vineyard", object({{"row_count", whole("rows")},
                           {"bearing_deg", number("mean of the rows, 0 to 180")},
                           {"spacing_m", at_least_zero("mean between neighbouring rows")},
                           {"spacing_std_m", at_least_zero("of the same")},
                           {"canopy_top_m", number("mean")},
                           {"canopy_width_m", at_least_zero("mean")},
                           {"volume_m3", at_least_zero("sum")},
                           {"seen_volume_m3", number("sum")}},
                          "all rows together")},
      {"meshes",
       object({{"triangles", whole("of all row meshes")},
               {"bytes", whole("of all row meshes as binary PLY")},
               {"reduction", number("1 - mesh bytes / cloud bytes")},
               {"containment", share("of all canopy points within 1 cm of their row's meshes")}},
              "the low-complexity meshes")},
      {"rows", list(row_figures(), 0, "row by row")},
      {"notes", list(text("a sentence"), 0, "sentences for the user")}};
}

json head(const char* title) {
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
}

json grid(const char* file, int minimum, const char* description) {
  return or_null(object({{"file", {{"const", file}}},
                         {"columns", whole("along x", minimum)},
                         {"rows", whole("along y", minimum)},
                         {"cell_m", positive("distance between places")},
                         {"corner_m", point(2, "x, y in W, m")}},
                        description));
}

}  // namespace

std::string map_json_schema() {
  json latitude = number("WGS84"), longitude = number("WGS84");
  latitude["minimum"] = -90, latitude["maximum"] = 90;
  longitude["minimum"] = -180, longitude["maximum"] = 180;
  const json row = object({{"id", whole("number of the row")},
                           {"canopy_width_m", positive("of its cross-section")},
                           {"canopy_base_m", number("lowest leaves above the ground")},
                           {"canopy_top_m", number("highest leaves above the ground")},
                           {"hulls", whole("number of its files meshes/row_<id>_hull_*.ply")},
                           {"line_m", line_schema()}},
                          "a plant row");
  const json alley = object({{"id", whole("number of the alley")},
                             {"width_m", positive("between the rows' lines")},
                             {"line_m", line_schema()}},
                            "the free strip between two rows");
  json boundary = list(point(2, "x, y in W, m"), 0, "the parcel, counter-clockwise, or empty");
  json offset = point(3, "1 sigma of a shift of the whole map, east, north, up");
  offset["items"]["minimum"] = 0;
  const json properties = {
      {"vinerow_map", {{"const", kMapVersion}, {"description", "version of the format"}}},
      {"frame", text("of all coordinates")},
      {"origin", or_null(object({{"latitude_deg", latitude},
                                 {"longitude_deg", longitude},
                                 {"altitude_m", number("above the ellipsoid, or as the cloud's")}},
                                "of W; null: not known"))},
      {"rows", list(row, 1, "in order across the block")},
      {"alleys", list(alley, 0, "in driving order across the block")},
      {"boundary_m", boundary},
      {"accuracy",
       object({{"surface_std_m", positive("1 sigma of the meshes' surface along its normals")},
               {"correlation_length_m", positive("correlation length of that error along the row")},
               {"offset_std_m", offset}},
              "errors that the map states")},
      {"terrain", grid("terrain.tif", 2, "samples of the ground; corner: the south-western one")},
      {"occupancy", grid("occupancy.yaml", 1, "ROS map; corner: of the south-western cell")},
      {"report", object(report_properties(), "figures")}};
  json schema = head("Vinerow map: map.json");
  schema.update(object(properties, "A low-complexity map of a vineyard, made from a point cloud"));
  return schema.dump(2);
}

std::string report_json_schema() {
  json properties = {{"vinerow_map_report", {{"const", kMapVersion}}}};
  properties.update(report_properties());
  json schema = head("Vinerow map: report.json");
  schema.update(object(properties, "Making and quality of a map"));
  return schema.dump(2);
}

}  // namespace vinerow::mapping

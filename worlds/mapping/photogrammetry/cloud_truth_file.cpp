#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/math/angles.h"
#include "worlds/mapping/photogrammetry/cloud_truth.h"

namespace vinerow::mapping {
namespace {

using Json = nlohmann::ordered_json;

template <int N>
Json json_of(const Eigen::Matrix<double, N, 1>& p) {
  Json list = Json::array();
  for (int k = 0; k < N; ++k) list.push_back(p[k]);
  return list;
}

template <class Points>
Json json_of_points(const Points& points) {
  Json list = Json::array();
  for (const auto& p : points) list.push_back(json_of(p));
  return list;
}

template <int N>
Eigen::Matrix<double, N, 1> point_of(const Json& list) {
  if (!list.is_array() || list.size() != static_cast<std::size_t>(N)) {
    throw ConfigError(fmt::format("'{}' must be {} numbers", list.dump().substr(0, 60), N));
  }
  Eigen::Matrix<double, N, 1> p;
  for (int k = 0; k < N; ++k) p[k] = list[static_cast<std::size_t>(k)].get<double>();
  return p;
}

Json json_of(const RowTruth& row) {
  Json gaps = Json::array();
  for (const auto& [from_m, to_m] : row.gaps_m) gaps.push_back({from_m, to_m});
  return {{"row", row.row},
          {"line_m", json_of_points(row.line_W)},
          {"first_m", json_of(row.first_W)},
          {"last_m", json_of(row.last_W)},
          {"length_m", row.length_m},
          {"bearing_deg", row.bearing_deg},
          {"spacing_m", row.spacing_m},
          {"canopy_base_m", row.canopy_base_m},
          {"canopy_top_m", row.canopy_top_m},
          {"canopy_width_m", row.canopy_width_m},
          {"volume_m3", row.volume_m3},
          {"gaps_m", gaps}};
}

RowTruth row_of(const Json& json) {
  RowTruth row;
  json.at("row").get_to(row.row);
  for (const Json& p : json.at("line_m")) row.line_W.push_back(point_of<3>(p));
  row.first_W = point_of<3>(json.at("first_m"));
  row.last_W = point_of<3>(json.at("last_m"));
  json.at("length_m").get_to(row.length_m);
  json.at("bearing_deg").get_to(row.bearing_deg);
  json.at("spacing_m").get_to(row.spacing_m);
  json.at("canopy_base_m").get_to(row.canopy_base_m);
  json.at("canopy_top_m").get_to(row.canopy_top_m);
  json.at("canopy_width_m").get_to(row.canopy_width_m);
  json.at("volume_m3").get_to(row.volume_m3);
  for (const Json& gap : json.at("gaps_m")) {
    const Eigen::Vector2d from_to = point_of<2>(gap);
    row.gaps_m.emplace_back(from_to.x(), from_to.y());
  }
  return row;
}

/// Calls f(key, value) for every number and text of the sampling, whichever way it goes.
template <class Sampling, class F>
void for_each_field(Sampling& sampling, F&& f) {
  f("method", sampling.method);
  f("file", sampling.file);
  f("crs", sampling.crs);
  f("seed", sampling.seed);
  f("pictures", sampling.pictures);
  f("gsd_m", sampling.gsd_m);
  f("match_px", sampling.match_px);
  f("noise_m", sampling.noise_m);
  f("weeds_m", sampling.weeds_m);
  f("outliers", sampling.outliers);
  f("wanted_density_per_m2", sampling.wanted_density_per_m2);
  f("area_m2", sampling.area_m2);
  f("density_per_m2", sampling.density_per_m2);
  f("points", sampling.points);
  f("ground_points", sampling.ground_points);
  f("canopy_points", sampling.canopy_points);
  f("outlier_points", sampling.outlier_points);
  f("views_mean", sampling.views_mean);
  f("horizontal_noise_rms_m", sampling.horizontal_noise_rms_m);
  f("height_noise_rms_m", sampling.height_noise_rms_m);
  f("georeference", sampling.georeference);
  f("georeference_east_m", sampling.georeference_east_m);
  f("georeference_north_m", sampling.georeference_north_m);
  f("georeference_up_m", sampling.georeference_up_m);
  f("georeference_tilt_deg", sampling.georeference_tilt_deg);
  f("georeference_turn_deg", sampling.georeference_turn_deg);
  f("georeference_scale", sampling.georeference_scale);
}

}  // namespace

void write_cloud_truth(const CloudTruth& truth, const std::filesystem::path& file) {
  Json rows = Json::array(), sampling;
  for (const RowTruth& row : truth.rows) rows.push_back(json_of(row));
  for_each_field(truth.sampling,
                 [&](const char* key, const auto& value) { sampling[key] = value; });
  const Json json{{"scenario", truth.scenario},
                  {"world", truth.world},
                  {"origin",
                   {{"latitude_deg", deg_from_rad(truth.origin.latitude_rad)},
                    {"longitude_deg", deg_from_rad(truth.origin.longitude_rad)},
                    {"altitude_m", truth.origin.altitude_m}}},
                  {"boundary_m", json_of_points(truth.boundary_W)},
                  {"bearing_deg", truth.bearing_deg},
                  {"spacing_m", truth.spacing_m},
                  {"volume_m3", truth.volume_m3},
                  {"sampling", sampling},
                  {"rows", rows}};
  write_whole_file(file, json.dump(1) + "\n");
}

CloudTruth read_cloud_truth(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw ConfigError(fmt::format("'{}' cannot be read", file.string()));
  CloudTruth truth;
  try {
    const Json json = Json::parse(in);
    json.at("scenario").get_to(truth.scenario);
    json.at("world").get_to(truth.world);
    const Json& origin = json.at("origin");
    truth.origin.latitude_rad = rad_from_deg(origin.at("latitude_deg").get<double>());
    truth.origin.longitude_rad = rad_from_deg(origin.at("longitude_deg").get<double>());
    origin.at("altitude_m").get_to(truth.origin.altitude_m);
    for (const Json& p : json.at("boundary_m")) truth.boundary_W.push_back(point_of<2>(p));
    json.at("bearing_deg").get_to(truth.bearing_deg);
    json.at("spacing_m").get_to(truth.spacing_m);
    json.at("volume_m3").get_to(truth.volume_m3);
    const Json& sampling = json.at("sampling");
    for_each_field(truth.sampling, [&](const char* key, auto& value) {
      // Files of versions without a common error lack these keys.
      const bool is_new = std::string_view(key).starts_with("georeference");
      if (!is_new || sampling.contains(key)) sampling.at(key).get_to(value);
    });
    for (const Json& row : json.at("rows")) truth.rows.push_back(row_of(row));
  } catch (const nlohmann::json::exception& error) {
    throw ConfigError(
        fmt::format("'{}' is not a truth file of a cloud: {}", file.string(), error.what()));
  } catch (const ConfigError& error) {
    throw ConfigError(
        fmt::format("'{}' is not a truth file of a cloud: {}", file.string(), error.what()));
  }
  return truth;
}

}  // namespace vinerow::mapping

#include "worlds/surveyed/surveyed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/geo/geo_features.h"
#include "engine/math/angles.h"
#include "engine/math/statistics.h"
#include "worlds/mapping/from_truth/map_parameters.h"
#include "worlds/mapping/model/row_map.h"
#include "worlds/parts/alley_spawns.h"
#include "worlds/parts/common.h"
#include "worlds/parts/leaf_area.h"
#include "worlds/parts/obstacles.h"
#include "worlds/parts/terrain.h"
#include "worlds/plants/planted_folder.h"
#include "worlds/plants/vine_rows.h"

namespace vinerow::worlds {
namespace {

struct SurveyedParams {
  std::filesystem::path survey_file, vines_file, poles_file;
  std::string row_type;         ///< empty: detected
  double vine_spacing_m = 1.4;  ///< if the survey has no vines
  double headland_m = 12.0;
  double surroundings_m = 6.0;
  std::optional<double> latitude_rad, longitude_rad;  ///< of the origin; absent: the rows' mean
  double altitude_m = 0.0;
  std::filesystem::path mesh_folder;  ///< empty: find_cache_folder()
  SlopeParams slope{rad_from_deg(1.5), rad_from_deg(20.0)};
  TerrainParams terrain{.waves_m = 0.12};
  VinePlanting planting;
  Surroundings surroundings;
  mapping::MapParams map;
  ObstaclesParams obstacles;
};

const ParameterTable<SurveyedParams>& surveyed_table() {
  using P = SurveyedParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .path("survey_file", &P::survey_file,
                "GeoJSON, KML, shapefile or GeoPackage with one line per row, or its end poles as "
                "points with the row's number (property row); poles and vines as points")
          .required()
          .path("vines_file", &P::vines_file, "a further file whose points are vines")
          .path("poles_file", &P::poles_file, "a further file whose points are poles")
          .text("row_type", &P::row_type,
                "property `type` of the LineStrings that are rows; empty: detected")
          .number("vine_spacing_m", "m", &P::vine_spacing_m, between(0.1, 100.0),
                  "distance between vines if the survey contains no vines")
          .number("headland_m", "m", &P::headland_m, between(8.0, 200.0),
                  "free ground beyond the row ends")
          .number("surroundings_m", "m", &P::surroundings_m, between(0.0, 5000.0),
                  "ground beyond the parcel's box, for flying vehicles")
          .degrees("origin_latitude_deg", &P::latitude_rad, between(-90.0, 90.0),
                   "WGS84 latitude of the world's origin; default: the rows' mean")
          .degrees("origin_longitude_deg", &P::longitude_rad, between(-180.0, 180.0),
                   "WGS84 longitude of the world's origin; default: the rows' mean")
          .number("origin_altitude_m", "m", &P::altitude_m, between(-500.0, 9000.0),
                  "altitude of the world's z = 0")
          .path("mesh_folder", &P::mesh_folder, kMeshFolderText)
          .may_be_missing()
          .include(&P::slope, slope_table())
          .include(&P::terrain, terrain_table())
          .include(&P::planting, planting_table())
          .include(&P::surroundings, surroundings_table())
          .include(&P::map, mapping::map_table())
          .include(&P::obstacles, obstacles_table());
  return table;
}

PartSpec surveyed_spec() {
  PartSpec spec;
  spec.name = "surveyed";
  spec.description =
      "vineyard from surveyed rows, poles and vines (GeoJSON, KML, shapefile, GeoPackage)";
  surveyed_table().add_to(spec);
  return spec;
}

GeoOrigin mean_of_rows(const std::vector<io::GeoFeature>& rows) {
  GeoOrigin mean;
  std::size_t count = 0;
  for (const io::GeoFeature& row : rows) {
    for (const Geodetic& point : row.points) {
      mean.latitude_rad += point.latitude_rad;
      mean.longitude_rad += point.longitude_rad;
      ++count;
    }
  }
  mean.latitude_rad /= static_cast<double>(count);
  mean.longitude_rad /= static_cast<double>(count);
  return mean;
}

Eigen::Vector2d to_plane(const LocalFrame& frame, const Geodetic& point) {
  // At the origin's altitude: heights of a survey, if any, are not the simulated ground's.
  return frame.to_local({point.latitude_rad, point.longitude_rad, frame.origin().altitude_m})
      .head<2>();
}

std::vector<mapping::RowCurve> read_rows(const std::vector<io::GeoFeature>& features,
                                         const LocalFrame& frame, const std::string& file) {
  constexpr double kSamePoint_m = 1e-3;
  constexpr double kFarAway_m = 20000.0;
  constexpr double kLongest_m = 5000.0;  // planted ones seldom have one kilometre
  std::vector<mapping::RowCurve> rows;
  for (const io::GeoFeature& feature : features) {
    std::vector<Eigen::Vector2d> points;
    for (const Geodetic& geodetic : feature.points) {
      const Eigen::Vector2d p = to_plane(frame, geodetic);
      if (p.norm() > kFarAway_m) {
        throw ConfigError(fmt::format(
            "'{}', feature {}: the row is {:.0f} km from the world's origin, must be within 20 "
            "km",
            file, feature.index, p.norm() / 1000.0));
      }
      if (points.empty() || (p - points.back()).norm() > kSamePoint_m) points.push_back(p);
    }
    if (points.size() < 2) {
      throw ConfigError(
          fmt::format("'{}', feature {}: the row has no length", file, feature.index));
    }
    rows.emplace_back(std::move(points));
    if (rows.back().length_m() > kLongest_m) {
      throw ConfigError(
          fmt::format("'{}', feature {}: the row is {:.1f} km long, must be at most {:g} km", file,
                      feature.index, rows.back().length_m() / 1000.0, kLongest_m / 1000.0));
    }
  }
  return mapping::order_rows(std::move(rows));
}

/// Points assigned to rows, as arc lengths.
struct Assigned {
  std::vector<std::vector<double>> s_m;  // per row, ascending
  int far_off = 0;
};

Assigned assign_points(const std::vector<io::GeoFeature>& points, const LocalFrame& frame,
                       const std::vector<mapping::RowCurve>& rows, double reach_m) {
  Assigned assigned;
  assigned.s_m.resize(rows.size());
  for (const io::GeoFeature& feature : points) {
    const Eigen::Vector2d p = to_plane(frame, feature.points.front());
    double best_m = std::numeric_limits<double>::infinity(), best_s_m = 0.0;
    std::size_t best = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      double distance_m = 0.0;
      const double s_m = rows[i].nearest_s_m(p, &distance_m);
      if (distance_m < best_m) {
        best_m = distance_m;
        best_s_m = s_m;
        best = i;
      }
    }
    if (best_m > reach_m) {
      ++assigned.far_off;
    } else {
      assigned.s_m[best].push_back(best_s_m);
    }
  }
  // Two readings of one plant or pole: the first counts.
  constexpr double kSamePlace_m = 0.05;
  for (auto& s : assigned.s_m) {
    std::sort(s.begin(), s.end());
    s.erase(
        std::unique(s.begin(), s.end(), [&](double a, double b) { return b - a < kSamePlace_m; }),
        s.end());
  }
  return assigned;
}

double median_spacing_m(const std::vector<double>& s_m, double otherwise) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < s_m.size(); ++i) gaps.push_back(s_m[i] - s_m[i - 1]);
  return gaps.empty() ? otherwise : upper_median(gaps);
}

double smallest_pitch_m(const RowMap& map) {
  double pitch_m = 3.0;  // for a single row
  for (const Alley& alley : map.alleys) pitch_m = std::min(pitch_m, alley.width_m);
  return pitch_m;
}

void append_points(const std::filesystem::path& file, std::vector<io::GeoFeature>& points) {
  if (file.empty()) return;
  for (io::GeoFeature& feature : io::read_features(file)) {
    if (feature.kind == io::GeometryKind::kPoint) points.push_back(std::move(feature));
  }
}

std::unique_ptr<WorldModel> make_surveyed(const ParameterSet& parameters,
                                          const WorldContext& context) {
  const SurveyedParams params = surveyed_table().read(parameters, "");
  const VinePlanting planting = settle_growth(params.planting);
  const std::string file = params.survey_file.string();
  io::SurveyFile survey = io::read_survey(file, params.row_type);
  append_points(params.vines_file, survey.vines);
  append_points(params.poles_file, survey.poles);

  auto world = std::make_unique<WorldModel>();
  world->name = "surveyed";
  const GeoOrigin mean = mean_of_rows(survey.rows);
  world->origin = {params.latitude_rad.value_or(mean.latitude_rad),
                   params.longitude_rad.value_or(mean.longitude_rad), params.altitude_m};
  set_surroundings(params.surroundings, context.seed, *world);
  world->depends_on_seed = false;  // plants and terrain have a seed of their own
  const LocalFrame frame(world->origin);
  const std::vector<mapping::RowCurve> rows = read_rows(survey.rows, frame, file);

  const std::vector<Eigen::Vector2d> boundary =
      mapping::parcel_boundary(rows, params.headland_m, 4.0);
  Eigen::AlignedBox2d box = mapping::box_around(boundary);
  const Eigen::Vector2d margin(params.surroundings_m, params.surroundings_m);
  box =
      Eigen::AlignedBox2d(Eigen::Vector2d(box.min() - margin), Eigen::Vector2d(box.max() + margin));
  TerrainShape shape;
  shape.centre_W = box.center();
  shape.gradient = params.slope.gradient();
  world->terrain = build_terrain(params.terrain, planting.seed, world->origin, shape, box);
  const mapping::GroundHeight ground = ground_of(*world->terrain);
  world->rows = mapping::make_row_map(rows, ground, canopy_size(planting.canopy), boundary);
  check_pitch(planting, world->rows);
  add_alley_spawn_points(*world);

  // A point belongs to the nearest row if it is nearer than a third of the way to the next.
  const double reach_m = smallest_pitch_m(world->rows) / 3.0;
  const Assigned vines = assign_points(survey.vines, frame, rows, reach_m);
  const Assigned poles = assign_points(survey.poles, frame, rows, reach_m);
  const auto note = [&](int count, const char* what, const std::string& why) {
    if (count == 0) return;
    world->notes.push_back(
        fmt::format("{}: {} {}{} left out: {}", file, count, what, count == 1 ? "" : "s", why));
  };
  note(survey.areas, "polygon", "the parcel's border runs headland_m around the rows");
  note(survey.other_points, "point", "neither type nor name says vine, tree, pole or post");
  const std::string far_off = fmt::format("farther than {:.2f} m from every row", reach_m);
  note(vines.far_off, "vine", far_off);
  note(poles.far_off, "pole", far_off);

  std::vector<VineRow> vine_rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double length_m = rows[i].length_m();
    VineRow row{rows[i], vines.s_m[i], params.vine_spacing_m, poles.s_m[i]};
    if (row.vine_s_m.empty()) {
      row.vine_s_m = regular_vines(length_m, row.vine_spacing_m, 0.0, RandomStream(0, "", ""));
    } else {
      row.vine_spacing_m = median_spacing_m(row.vine_s_m, row.vine_spacing_m);
    }
    if (row.post_s_m.size() < 2) {
      row.post_s_m = spread_posts(0.0, length_m, planting.trellis.post_spacing_m);
    }
    if (!planting.trellis.posts) row.post_s_m.clear();
    vine_rows.push_back(std::move(row));
  }
  FileMeshStore store(
      planted_folder(params.mesh_folder, "surveyed", parameters, vine_rows, *world->terrain));
  plant_vine_rows(*world, vine_rows, ground, planting, store);
  mapping::fill_occupancy(params.map, *world, place_obstacles(params.obstacles, *world),
                          row_end_margin_m(planting));
  settle_shelter(*world);
  return world;
}

}  // namespace

void register_surveyed(Registry& registry) {
  registry.add_world(surveyed_spec(), make_surveyed);
}

}  // namespace vinerow::worlds

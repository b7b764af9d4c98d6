#include "worlds/surveyed/surveyed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/geojson.h"
#include "engine/math/angles.h"
#include "worlds/mapping/map_parameters.h"
#include "worlds/parts/common.h"
#include "worlds/parts/obstacles.h"
#include "worlds/parts/row_map.h"
#include "worlds/parts/terrain.h"
#include "worlds/parts/vine_rows.h"

namespace vinerow::worlds {
namespace {

constexpr double kGroundMargin_m = 6.0;

PartSpec surveyed_spec() {
  PartSpec spec;
  spec.name = "surveyed";
  spec.description = "vineyard from surveyed rows, poles and vines (GeoJSON, WGS84)";
  spec.parameters = concatenate(
      {{required(path_parameter(
            "survey_file", "GeoJSON with one LineString per row, and poles and vines as points")),
        path_parameter("vines_file", "further GeoJSON whose points are vines"),
        path_parameter("poles_file", "further GeoJSON whose points are poles"),
        text_parameter("row_type", "",
                       "property `type` of the LineStrings that are rows; empty: found out"),
        positive_parameter("vine_spacing_m", "m", 1.4, "between vines where the survey has none"),
        number_parameter("headland_m", "m", 12, 8, 200, "free ground beyond the row ends"),
        number_parameter("surroundings_m", "m", kGroundMargin_m, 0, 5000,
                         "ground beyond the parcel's box, for what flies over it"),
        optional(number_parameter("origin_latitude_deg", "deg", 0, -90, 90,
                                  "WGS84 latitude of the world's origin; default: the rows' mean")),
        optional(
            number_parameter("origin_longitude_deg", "deg", 0, -180, 180,
                             "WGS84 longitude of the world's origin; default: the rows' mean")),
        number_parameter("origin_altitude_m", "m", 0, -500, 9000, "altitude of the world's z = 0")},
       slope_parameters(1.5, 20),
       terrain_parameters(0.12),
       canopy_parameters(),
       trellis_parameters(),
       planting_parameters(),
       surroundings_parameters(),
       map_parameters(),
       obstacle_parameters()});
  return spec;
}

GeoOrigin mean_of_rows(const std::vector<io::GeoFeature>& rows) {
  GeoOrigin mean;
  std::size_t count = 0;
  for (const io::GeoFeature& row : rows) {
    for (const io::Geodetic& point : row.points) {
      mean.latitude_rad += point.latitude_rad;
      mean.longitude_rad += point.longitude_rad;
      ++count;
    }
  }
  mean.latitude_rad /= static_cast<double>(count);
  mean.longitude_rad /= static_cast<double>(count);
  return mean;
}

Eigen::Vector2d to_plane(const io::LocalFrame& frame, const io::Geodetic& point) {
  // At the origin's altitude: heights of a survey, if any, are not the simulated ground's.
  return frame.to_local({point.latitude_rad, point.longitude_rad, frame.origin().altitude_m})
      .head<2>();
}

std::vector<RowCurve> read_rows(const std::vector<io::GeoFeature>& features,
                                const io::LocalFrame& frame, const std::string& file) {
  constexpr double kSamePoint_m = 1e-3;
  constexpr double kFarAway_m = 20000.0;
  std::vector<RowCurve> rows;
  for (const io::GeoFeature& feature : features) {
    std::vector<Eigen::Vector2d> points;
    for (const io::Geodetic& geodetic : feature.points) {
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
  }
  return order_rows(std::move(rows));
}

/// Points sorted to the rows they stand in, as arc lengths.
struct Assigned {
  std::vector<std::vector<double>> s_m;  // per row, ascending
  int far_off = 0;
};

Assigned assign_points(const std::vector<io::GeoFeature>& points, const io::LocalFrame& frame,
                       const std::vector<RowCurve>& rows, double reach_m) {
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
  if (gaps.empty()) return otherwise;
  std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2),
                   gaps.end());
  return gaps[gaps.size() / 2];
}

double smallest_pitch_m(const RowMap& map) {
  double pitch_m = 3.0;  // a single row has none
  for (const Alley& alley : map.alleys) pitch_m = std::min(pitch_m, alley.width_m);
  return pitch_m;
}

void append_points(const ParameterSet& parameters, const char* name,
                   std::vector<io::GeoFeature>& points) {
  if (!parameters.has(name)) return;
  for (io::GeoFeature& feature : io::read_geojson(parameters.text(name))) {
    if (feature.kind == io::GeometryKind::kPoint) points.push_back(std::move(feature));
  }
}

std::unique_ptr<WorldModel> make_surveyed(const ParameterSet& parameters,
                                          const WorldContext& context) {
  const std::string& file = parameters.text("survey_file");
  io::SurveyFile survey = io::read_survey(file, parameters.text("row_type"));
  append_points(parameters, "vines_file", survey.vines);
  append_points(parameters, "poles_file", survey.poles);
  const VinePlanting planting = read_planting(parameters);

  auto world = std::make_unique<WorldModel>();
  world->name = "surveyed";
  world->origin = read_origin(parameters, mean_of_rows(survey.rows));
  read_surroundings(parameters, context.seed, *world);
  const io::LocalFrame frame(world->origin);
  const std::vector<RowCurve> rows = read_rows(survey.rows, frame, file);

  const std::vector<Eigen::Vector2d> boundary =
      parcel_boundary(rows, parameters.number("headland_m"), 4.0);
  Eigen::AlignedBox2d box = box_around(boundary);
  const double margin_m = parameters.number("surroundings_m");
  const Eigen::Vector2d margin(margin_m, margin_m);
  box =
      Eigen::AlignedBox2d(Eigen::Vector2d(box.min() - margin), Eigen::Vector2d(box.max() + margin));
  TerrainShape shape;
  shape.centre_W = box.center();
  shape.gradient = std::tan(rad_from_deg(parameters.number("slope_deg"))) *
                   bearing_direction(parameters.number("uphill_bearing_deg"));
  world->terrain = build_terrain(parameters, planting.seed, world->origin, shape, box);
  const GroundHeight ground = ground_of(*world->terrain);
  world->rows = make_row_map(rows, ground, planting.canopy, boundary);
  add_alley_spawn_points(*world);

  // A point belongs to the nearest row if it is nearer than a third of the way to the next.
  const double reach_m = smallest_pitch_m(world->rows) / 3.0;
  const Assigned vines = assign_points(survey.vines, frame, rows, reach_m);
  const Assigned poles = assign_points(survey.poles, frame, rows, reach_m);
  const auto note = [&](int count, const char* what) {
    if (count == 0) return;
    world->notes.push_back(
        fmt::format("{}: {} {} stand farther than {:.2f} m from every row and are left out", file,
                    count, what, reach_m));
  };
  note(vines.far_off, "vines");
  note(poles.far_off, "poles");

  std::vector<VineRow> vine_rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double length_m = rows[i].length_m();
    VineRow row{rows[i], vines.s_m[i], parameters.number("vine_spacing_m"), poles.s_m[i]};
    if (row.vine_s_m.empty()) {
      row.vine_s_m = regular_vines(length_m, row.vine_spacing_m, 0.0, RandomStream(0, "", ""));
    } else {
      row.vine_spacing_m = median_spacing_m(row.vine_s_m, row.vine_spacing_m);
    }
    if (row.post_s_m.size() < 2) {
      row.post_s_m = spread_posts(0.0, length_m, planting.trellis.post_spacing_m);
    }
    if (!parameters.boolean("posts")) row.post_s_m.clear();
    vine_rows.push_back(std::move(row));
  }
  MemoryMeshStore store;
  plant_vine_rows(*world, vine_rows, ground, planting, store);
  fill_occupancy(parameters, *world, place_obstacles(parameters, *world),
                 row_end_margin_m(planting, parameters.boolean("posts")));
  return world;
}

}  // namespace

void register_surveyed(Registry& registry) {
  registry.add_world(surveyed_spec(), make_surveyed);
}

}  // namespace vinerow::worlds

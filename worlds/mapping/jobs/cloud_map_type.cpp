#include "worlds/mapping/jobs/cloud_map_type.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "engine/api/file_shelf.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/log.h"
#include "worlds/mapping/folder/map_folder.h"
#include "worlds/mapping/folder/map_frame.h"
#include "worlds/mapping/folder/map_numbering.h"
#include "worlds/mapping/grid/occupancy.h"

namespace vinerow::mapping {
namespace {

constexpr double kMaxMapOffset_m = 50.0;  ///< a map so far beside the world's rows is of others
constexpr double kHigh_m = 2.0;           ///< so far off the ground two height systems were mixed

enum class FirstWall { kAuto, kFirst, kLast };

struct CloudMapParams {
  std::filesystem::path folder;
  bool like_world = true;             ///< numbered so
  double stated_surface_std_m = 0.0;  ///< 0: as the map states
  std::optional<Eigen::Vector3d> offset_std_m;
  // Any of these redraws the grid.
  std::optional<double> occupancy_cell_m;
  std::optional<bool> virtual_walls;
  std::optional<FirstWall> first_wall;
};

const ParameterTable<CloudMapParams>& cloud_map_table() {
  using P = CloudMapParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .path("folder", &P::folder, "folder that `vinerow map` wrote")
          .required()
          .choice("numbering", &P::like_world, {{"world", true}, {"map", false}},
                  "rows and alleys are numbered and directed like the world's, or as in the folder")
          .number("stated_surface_std_m", "m", &P::stated_surface_std_m, between(0.0, 1.0),
                  "1 sigma of the meshes' surface for estimators; 0: as the map states")
          .numbers("offset_std_m", "m", &P::offset_std_m, kNotNegative,
                   "1 sigma of a shift of the whole map, east, north, up, for estimators; default: "
                   "as the map states")
          .number("occupancy_cell_m", "m", &P::occupancy_cell_m, between(0.005, 10.0),
                  "draws the occupancy grid again from the map's rows and boundary with cells "
                  "of this size; default: the map's own grid")
          .boolean("virtual_walls", &P::virtual_walls,
                   "draws the grid again with or without walls from row ends to the boundary")
          .choice("first_wall", &P::first_wall,
                  {{"auto", FirstWall::kAuto},
                   {"first", FirstWall::kFirst},
                   {"last", FirstWall::kLast}},
                  "draws the grid again; point of row 0 that is closed by a virtual wall");
  return table;
}

/// "1.24 km", "63 m".
std::string format_distance(double distance_m) {
  return distance_m < 1000.0 ? fmt::format("{:.0f} m", distance_m)
                             : fmt::format("{:.2f} km", distance_m / 1000.0);
}

/// Worlds without a given origin are at 0 deg north, 0 deg east.
bool has_place(const WorldModel& world) {
  return world.origin.latitude_rad != 0.0 || world.origin.longitude_rad != 0.0;
}

/// Distance to the world's rows, or to its terrain if it has no rows.
double distance_to_m(const RowMap& map, const WorldModel& world) {
  if (!world.rows->rows.empty()) return distance_between_m(map.rows, world.rows->rows);
  if (!world.terrain) return 0.0;
  const HeightField& t = *world.terrain;
  const Eigen::Vector2d end = t.corner_W + Eigen::Vector2d(t.width_m(), t.depth_m());
  PlantRow diagonal;
  diagonal.line_W = {{t.corner_W.x(), t.corner_W.y(), 0.0}, {end.x(), end.y(), 0.0}};
  return distance_between_m(map.rows, {diagonal});
}

void refuse_distant_map(const CloudMap& map, bool moved, const WorldModel& world,
                        const std::string& folder) {
  const double apart_m = distance_to_m(map.map, world);
  if (apart_m <= kMaxMapOffset_m) return;
  throw ConfigError(fmt::format(
      "map cloud_map: the rows of map '{}' lie {} from world '{}', must be within {:g} m: {}",
      folder, format_distance(apart_m), world.name, kMaxMapOffset_m,
      moved ? "it is of another place, or one of the two origins is wrong"
            : "its x and y are taken for the world's, as one of the two has no origin"));
}

/// Two height systems (ellipsoid and geoid) are tens of metres apart and easily mixed.
void note_heights(const RowMap& map, const MapContext& context, const std::string& folder) {
  double sum_m = 0.0;
  int count = 0;
  for (const PlantRow& row : map.rows) {
    for (const Eigen::Vector3d& p : row.line_W) {
      const auto ground_m = context.scene->ground_height_m(p.x(), p.y(), 1e5);
      if (!ground_m) continue;
      sum_m += p.z() - *ground_m;
      ++count;
    }
  }
  if (count == 0 || std::abs(sum_m / count) <= kHigh_m) return;
  log_note(fmt::format(
      "map of {}: the rows of map '{}' lie {:.1f} m {} the world's ground: is the altitude of its "
      "origin in another height system?",
      context.vehicle, folder, std::abs(sum_m / count), sum_m > 0.0 ? "above" : "below"));
}

void redraw_grid(const CloudMapParams& params, RowMap& map) {
  OccupancyOptions options;
  if (!map.occupancy.empty()) options.cell_m = map.occupancy.cell_m;
  options.cell_m = params.occupancy_cell_m.value_or(options.cell_m);
  options.virtual_walls = params.virtual_walls.value_or(options.virtual_walls);
  if (params.first_wall == FirstWall::kFirst) options.first_wall = RowEnd::kFirst;
  if (params.first_wall == FirstWall::kLast) options.first_wall = RowEnd::kLast;
  map.occupancy = make_occupancy_grid(map, options);
}

}  // namespace

RowMap map_in_world(CloudMap map, bool like_world, const MapContext& context,
                    const std::string& folder) {
  VINEROW_DEMAND(context.world != nullptr && context.scene != nullptr);
  const bool moves = map.has_origin && has_place(*context.world);
  if (moves) {
    move_map(context.world->origin, map);
  } else {
    log_note(
        fmt::format("map of {}: {} has no origin, the map's x, y and z are taken for the world's",
                    context.vehicle,
                    map.has_origin ? fmt::format("world '{}'", context.world->name)
                                   : fmt::format("map '{}'", folder)));
  }
  refuse_distant_map(map, moves, *context.world, folder);
  if (like_world && !context.world->rows->rows.empty()) number_like(context.world->rows, map.map);
  note_heights(map.map, context, folder);
  return std::move(map.map);
}

std::unique_ptr<RowMap> make_map_of_folder(const ParameterSet& parameters,
                                           const MapContext& context) {
  const CloudMapParams params = cloud_map_table().read(parameters, "");
  const auto read = keep<CloudMap>(context.shelf, file_mark(params.folder),
                                   [&] { return load_map(params.folder); });
  if (const int blocks = count_blocks(*read); blocks > 1) {
    throw ConfigError(fmt::format(
        "map cloud_map: folder '{}' holds {} blocks of rows, must be one: give one block's map, "
        "like '{}'",
        params.folder.string(), blocks, block_folder(params.folder, 0).string()));
  }
  RowMap map = map_in_world(*read, params.like_world, context, params.folder.string());
  const bool anew = params.occupancy_cell_m || params.virtual_walls || params.first_wall;
  if (anew) redraw_grid(params, map);
  if (params.stated_surface_std_m > 0.0) map.accuracy.surface_std_m = params.stated_surface_std_m;
  if (params.offset_std_m) map.accuracy.offset_std_m = *params.offset_std_m;
  return std::make_unique<RowMap>(std::move(map));
}

void register_cloud_map(Registry& registry) {
  PartSpec spec;
  spec.name = "cloud_map";
  spec.description =
      "a map that `vinerow map` made from a point cloud: rows, alleys, parcel, ground, row meshes "
      "and occupancy grid, after paper A, section 3";
  cloud_map_table().add_to(spec);
  registry.add_map(std::move(spec), make_map_of_folder);
}

}  // namespace vinerow::mapping

#include "worlds/vineyard/vineyard_params.h"

#include <fmt/format.h>

#include "engine/api/parameter_table.h"

namespace vinerow::worlds {

const ParameterTable<VineyardParams>& vineyard_table() {
  using P = VineyardParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("row_count", &P::row_count, between(1, 1000), "number of rows")
          .number("row_length_m", "m", &P::row_length_m, between(1.0, 5000.0), "length of each row")
          .number("pitch_m", "m", &P::pitch_m, between(0.3, 1000.0), "distance between rows")
          .number("vine_spacing_m", "m", &P::vine_spacing_m, between(0.1, 100.0),
                  "distance between vines of a row")
          .number("missing_vine_share", "", &P::missing_vine_share, between(0.0, 0.9),
                  "share of vines that are missing")
          .degrees("row_bearing_deg", &P::row_bearing_rad, between(-360.0, 360.0),
                   "direction of the rows, from north clockwise")
          .degrees("row_bend_deg", &P::row_bend_rad, between(-180.0, 180.0),
                   "angle by which rows turn to the left from end to end, as arcs about one "
                   "centre; 0: straight")
          .number("headland_m", "m", &P::headland_m, between(8.0, 200.0),
                  "free ground beyond the row ends")
          .number(
              "centre_x_m", "m", [](P& p) -> double& { return p.centre_W.x(); }, between(-1e5, 1e5),
              "east of the block's centre from the origin")
          .number(
              "centre_y_m", "m", [](P& p) -> double& { return p.centre_W.y(); }, between(-1e5, 1e5),
              "north of the block's centre from the origin")
          .number("relief_m", "m", &P::relief_m, between(0.0, 500.0),
                  "highest minus lowest ground under the rows; default: 30 m for "
                  "each 118 m of row length")
          .degrees("uphill_bearing_deg", &P::uphill_bearing_rad, between(-360.0, 360.0),
                   "direction in which the ground rises, from north clockwise")
          .number("surroundings_m", "m", &P::surroundings_m, between(0.0, 5000.0),
                  "ground beyond the parcel's box, for flying vehicles")
          .number("slope_fade_m", "m", &P::slope_fade_m, between(0.1, 1e5),
                  "beyond the parcel the slope fades out over this distance, to a ridge above and "
                  "a valley below")
          .path("mesh_folder", &P::mesh_folder, kMeshFolderText)
          .may_be_missing()
          .include(&P::planting, planting_table())
          .include(&P::terrain, terrain_table())
          .include(&P::origin, origin_table())
          .include(&P::surroundings, surroundings_table())
          .group("neighbours", &P::neighbours, neighbours_table(),
                 "neighbouring vineyards, meadows, tracks and trees in pictures only; nothing "
                 "collides with them; absent: none")
          .include(&P::map, mapping::map_table())
          .include(&P::obstacles, obstacles_table())
          .rule([](const P& p) -> std::string {
            return find_fault_in_pitch(p.planting, p.pitch_m, "pitch_m");
          });
  return table;
}

}  // namespace vinerow::worlds

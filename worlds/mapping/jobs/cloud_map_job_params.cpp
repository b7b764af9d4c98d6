#include "worlds/mapping/jobs/cloud_map_job_params.h"

#include <optional>

#include "engine/api/parameter_table.h"

namespace vinerow::mapping {

const ParameterTable<CloudMapJobParams>& cloud_map_job_table() {
  using P = CloudMapJobParams;
  using Options = CloudMapOptions;
  using Grid = OccupancyOptions;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("boundary", &P::with_parcel, {{"parcel", true}, {"none", false}},
                  "of the map: the world's parcel, as its farmer knows it from the land "
                  "register; none: a box around the rows")
          .choice("numbering", &P::like_world, {{"world", true}, {"map", false}},
                  "rows and alleys are numbered and directed like the world's, or as found")
          .text("crs", inside(&P::reading, &CloudReadOptions::crs),
                "coordinate system of the cloud, e.g. EPSG:25832; none: metres in the world's "
                "frame; default: as stated in the file")
          .integer("thin", inside(&P::reading, &CloudReadOptions::thin), between(1, 1e6),
                   "use only every n-th point")
          .number("canopy_cut_m", "m", inside(&P::options, &Options::canopy_cut_m),
                  between(0.05, 5.0),
                  "height above the ground at which canopy may begin; anything lower is grass and "
                  "weeds")
          .members("row_spacing_m", "m", between(0.1, 100.0),
                   "smallest and largest row spacing that is searched",
                   inside(&P::options, &Options::spacing_low_m),
                   inside(&P::options, &Options::spacing_high_m))
          .number("min_row_length_m", "m", inside(&P::options, &Options::row_length_low_m),
                  between(1.0, 1000.0), "shorter lines are not rows")
          .formerly("least_row_length_m")
          .number("terrain_cell_m", "m", inside(&P::options, &Options::terrain_cell_m),
                  between(0.1, 20.0), "distance between heights of the ground")
          .number("headland_m", "m", inside(&P::options, &Options::headland_m),
                  between(0.1, 1000.0),
                  "width of the headland beyond row ends and outer rows, if there is no boundary")
          .integer("corners", inside(&P::options, &Options::corners), between(5, 16),
                   "corners of a cross-section")
          .number("slice_m", "m", inside(&P::options, &Options::slice_m), between(0.02, 5.0),
                  "distance between cross-sections before any is removed")
          .number("gap_m", "m", inside(&P::options, &Options::gap_m), between(0.05, 100.0),
                  "length without canopy that splits a row's mesh")
          .number("budget_MB", "MB", inside(&P::options, &Options::budget_MB), between(0.0, 1e4),
                  "maximum size of all row meshes together; 0: 1.3 kB per metre of row")
          .number("occupancy_cell_m", "m", inside(&P::options, &Options::occupancy, &Grid::cell_m),
                  between(0.0, 10.0), "cell of the occupancy grid; 0: no grid")
          .boolean("virtual_walls", inside(&P::options, &Options::occupancy, &Grid::virtual_walls),
                   "the grid has walls from row ends to the boundary that leave only the "
                   "serpentine free")
          .choice("first_wall", inside(&P::options, &Options::occupancy, &Grid::first_wall),
                  {{"auto", std::nullopt}, {"first", RowEnd::kFirst}, {"last", RowEnd::kLast}},
                  "end of row 0 that is closed by a virtual wall; the others alternate");
  return table;
}

}  // namespace vinerow::mapping

#include "worlds/mapping/from_truth/row_mesh_parameters.h"

#include <fmt/format.h>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"

namespace vinerow::mapping {
namespace {

const ParameterTable<MissingStretch>& missing_stretch_table() {
  using P = MissingStretch;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("row", &P::row, between(0, 1e6), "number of the row")
          .required()
          .number("from_m", "m", &P::from_m, between(-10.0, 1e5),
                  "start of the gap along the row's line")
          .required()
          .number("to_m", "m", &P::to_m, between(-10.0, 1e5), "end of the gap along the row's line")
          .required()
          .rule([](const P& p) -> std::string {
            if (p.from_m < p.to_m) return "";
            return fmt::format("from_m = {} m of row {}, must be < to_m = {} m", p.from_m, p.row,
                               p.to_m);
          });
  return table;
}

const ParameterTable<RandomMissing>& random_missing_table() {
  using P = RandomMissing;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("count", &P::count, between(0, 10'000), "number of gaps")
          .required()
          .number("length_m", "m", &P::length_m, kPositive, "length of each gap");
  return table;
}

}  // namespace

const ParameterTable<RowMeshParams>& row_mesh_table() {
  using P = RowMeshParams;
  using Sections = CanopySurveyOptions;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .members("section_spacing_m", "m", between(0.2, 20.0),
                   "distance between cross-sections, drawn evenly between the two numbers",
                   inside(&P::sections, &Sections::spacing_low_m),
                   inside(&P::sections, &Sections::spacing_high_m))
          .integer("levels", inside(&P::sections, &Sections::levels), between(2, 20),
                   "heights of a cross-section from the lowest leaves to the highest, closer "
                   "together at both ends")
          .text("survey", &P::survey,
                "name of the survey: vehicles that name the same one have the same map; "
                "without a name each has its own")
          .numbers("offset_m", "m", &P::offset_m, kAnyNumber,
                   "shift of the map from the truth, east, north, up, which the map does not state")
          .numbers("offset_std_m", "m", &P::offset_std_m, kNotNegative,
                   "1 sigma of a further random shift, east, north, up, which the map states")
          .number("scale", "", &P::scale, between(0.9, 1.1),
                  "scale of the map about the middle of its rows")
          .degrees("rotation_deg", &P::rotation_rad, between(-180.0, 180.0),
                   "rotation of the map about the middle of its rows, counter-clockwise")
          .boolean("move_rows", &P::move_rows,
                   "rows, alleys, parcel and occupancy grid are shifted, rotated and scaled with "
                   "the meshes; false: they stay true")
          .number("surface_noise_std_m", "m", &P::surface_noise_std_m, between(0.0, 1.0),
                  "1 sigma of an error of the half widths at every section and level")
          .number("surface_noise_length_m", "m", &P::surface_noise_length_m, kPositive,
                  "correlation length of that error along the row and over height")
          .groups("missing", &P::missing, missing_stretch_table(),
                  "gaps in the map; the true row may have vines there")
          .group("random_missing", &P::random_missing, random_missing_table(),
                 "such gaps at random places")
          .boolean("fill_gaps", &P::fill_gaps,
                   "the map has vines where the truth has gaps between vines, as an old survey")
          .number("stated_surface_std_m", "m", &P::stated_surface_std_m, between(0.0, 10.0),
                  "1 sigma of its surfaces' error that the map states; 0: as measured")
          .number(
              "stated_correlation_length_m", "m", &P::stated_correlation_length_m,
              between(0.0, 100.0),
              "correlation length of that error along the row that the map states; 0: as measured")
          .path("folder", &P::folder,
                "folder of row_<number>_hull_<number>.ply used as the map instead of a survey; "
                "shifted, rotated and scaled like one")
          .text("save_to", &P::save_to,
                "folder that the finished meshes are written to as PLY; \"\": nowhere")
          .rule([](const P& p) -> std::string {
            const Sections& s = p.sections;
            if (s.spacing_low_m <= s.spacing_high_m) return "";
            return fmt::format("section_spacing_m = [{}, {}] m, the first must be <= the second",
                               s.spacing_low_m, s.spacing_high_m);
          });
  return table;
}

void check_folder_parameters(const RowMeshParams& params) {
  const auto refuse = [](const char* name) {
    throw ConfigError(
        fmt::format("{} changes a survey, not the meshes of a folder: give one of both", name));
  };
  if (params.surface_noise_std_m > 0.0) refuse("surface_noise_std_m");
  if (!params.missing.empty()) refuse("missing");
  if (params.random_missing) refuse("random_missing");
  if (params.fill_gaps) refuse("fill_gaps");
}

}  // namespace vinerow::mapping

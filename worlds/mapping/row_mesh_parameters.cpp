#include "worlds/mapping/row_mesh_parameters.h"

#include <fmt/format.h>

#include "engine/core/error.h"

namespace vinerow::worlds {
namespace {

ParameterSpec spacing_parameter() {
  ParameterSpec spec = number_list_parameter(
      "section_spacing_m", "m", {1.0, 2.0},
      "between cross-sections, drawn evenly from the first number to the second", 2);
  spec.min = 0.2;
  spec.max = 20.0;
  return spec;
}

ParameterSpec offset_std_parameter() {
  ParameterSpec spec = number_list_parameter(
      "offset_std_m", "m", {0, 0, 0},
      "1 sigma of a further shift that is drawn, east, north, up; the map states it", 3);
  spec.min = 0.0;
  return spec;
}

}  // namespace

std::vector<ParameterSpec> row_mesh_parameters() {
  return {
      spacing_parameter(),
      integer_parameter(
          "levels", 4, 2, 20,
          "heights of a cross-section from the lowest leaves to the highest, closer together "
          "at both ends"),
      text_parameter("survey", "",
                     "name of the survey: vehicles that name the same one have the same map; "
                     "without a name each has its own"),
      number_list_parameter("offset_m", "m", {0, 0, 0},
                            "the map lies so far east, north and up of the truth; it does not say "
                            "so",
                            3),
      offset_std_parameter(),
      number_parameter("scale", "", 1.0, 0.9, 1.1, "of the map about the middle of its rows"),
      number_parameter("rotation_deg", "deg", 0.0, -180, 180,
                       "of the map about the middle of its rows, counter-clockwise"),
      boolean_parameter("move_rows", true,
                        "rows, alleys, parcel and occupancy grid are shifted, turned and scaled "
                        "with the meshes; false: they stay true"),
      number_parameter("surface_noise_std_m", "m", 0.0, 0, 1,
                       "1 sigma of an error of the half widths at every section and level"),
      positive_parameter("surface_noise_length_m", "m", 0.3,
                         "correlation length of that error along the row and over height"),
      group_list_parameter(
          "missing",
          {required(integer_parameter("row", 0, 0, 1e6, "number of the row")),
           required(number_parameter("from_m", "m", 0, -10, 1e5, "along the row's line")),
           required(number_parameter("to_m", "m", 0, -10, 1e5, "along the row's line"))},
          "gaps in the map where vines may stand"),
      group_parameter("random_missing",
                      {required(integer_parameter("count", 0, 0, 10'000, "number of gaps")),
                       positive_parameter("length_m", "m", 1.0, "of each gap")},
                      "such gaps at places that are drawn"),
      boolean_parameter("fill_gaps", false,
                        "the map has vines where the truth has gaps between vines, as an old "
                        "survey"),
      number_parameter("stated_surface_std_m", "m", 0.0, 0, 10,
                       "what the map says of its surfaces' error; 0: as measured"),
      number_parameter("stated_correlation_length_m", "m", 0.0, 0, 100,
                       "how far along the row such an error stays, as the map says; 0: as "
                       "measured"),
      path_parameter("folder",
                     "folder of row_<number>_hull_<number>.ply that is the map instead of a "
                     "survey; it is shifted, turned and scaled like one"),
      text_parameter("save_to", "",
                     "folder that the finished meshes are written to as PLY; \"\": nowhere")};
}

void check_folder_parameters(const ParameterSet& parameters) {
  const auto refuse = [](const char* name) {
    throw ConfigError(
        fmt::format("{} changes a survey, not the meshes of a folder: give one of both", name));
  };
  if (parameters.number("surface_noise_std_m") > 0.0) refuse("surface_noise_std_m");
  if (!parameters.groups("missing").empty()) refuse("missing");
  if (parameters.has("random_missing")) refuse("random_missing");
  if (parameters.boolean("fill_gaps")) refuse("fill_gaps");
}

}  // namespace vinerow::worlds

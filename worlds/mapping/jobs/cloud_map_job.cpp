#include "worlds/mapping/jobs/cloud_map_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "worlds/mapping/cloud/folder/cloud_map_type.h"
#include "worlds/mapping/cloud/folder/map_folder.h"
#include "worlds/mapping/cloud/folder/map_points.h"
#include "worlds/mapping/cloud/make_cloud_map.h"
#include "worlds/mapping/cloud/map_comparison.h"
#include "worlds/mapping/cloud/reading/cloud_source.h"

namespace vinerow::worlds {
namespace {

std::vector<ParameterSpec> cloud_map_job_parameters() {
  const CloudMapOptions usual;
  ParameterSpec spacing =
      number_list_parameter("row_spacing_m", "m", {usual.spacing_low_m, usual.spacing_high_m},
                            "least and largest distance of rows that are looked for", 2);
  spacing.min = 0.1;
  spacing.max = 100.0;
  return {
      choice_parameter("boundary", "parcel", {"parcel", "none"},
                       "of the map: the world's parcel, as its farmer knows it from the land "
                       "register; none: a box around the rows"),
      choice_parameter("numbering", "world", {"world", "map"},
                       "rows and alleys are counted from the side, and run the way, that the "
                       "world's do; or as they were found"),
      text_parameter("crs", "",
                     "of the cloud's numbers, like EPSG:25832; none: metres of the world's frame; "
                     "default: as the file says"),
      integer_parameter("thin", 1, 1, 1e6, "takes every n-th point"),
      number_parameter("canopy_cut_m", "m", usual.canopy_cut_m, 0.05, 5.0,
                       "above the ground where canopy may begin; what is lower is grass and weeds"),
      std::move(spacing),
      number_parameter("least_row_length_m", "m", usual.row_length_low_m, 1.0, 1000.0,
                       "shorter ones are no rows"),
      number_parameter("terrain_cell_m", "m", usual.terrain_cell_m, 0.1, 20.0,
                       "between heights of the ground"),
      number_parameter("headland_m", "m", usual.headland_m, 0.1, 1000.0,
                       "of ground beyond row ends and outer rows, where there is no boundary"),
      integer_parameter("corners", usual.corners, 5, 16, "of a cross-section"),
      number_parameter("slice_m", "m", usual.slice_m, 0.02, 5.0,
                       "between cross-sections, before any is left out"),
      number_parameter("gap_m", "m", usual.gap_m, 0.05, 100.0,
                       "without canopy that splits a row's mesh"),
      number_parameter("budget_MB", "MB", usual.budget_MB, 0.0, 1e4,
                       "that all row meshes may take; 0: 1.3 kB per metre of row"),
      number_parameter("occupancy_cell_m", "m", usual.occupancy.cell_m, 0.0, 10.0,
                       "cell of the occupancy grid; 0: no grid"),
      boolean_parameter("virtual_walls", true,
                        "the grid has walls from row ends to the boundary that leave the "
                        "serpentine as the only way"),
      choice_parameter("first_wall", "auto", {"auto", "first", "last"},
                       "end of row 0 that is walled; the others alternate"),
  };
}

CloudMapOptions read_cloud_map_options(const ParameterSet& parameters) {
  CloudMapOptions options;
  options.terrain_cell_m = parameters.number("terrain_cell_m");
  options.canopy_cut_m = parameters.number("canopy_cut_m");
  options.spacing_low_m = parameters.numbers("row_spacing_m")[0];
  options.spacing_high_m = parameters.numbers("row_spacing_m")[1];
  options.row_length_low_m = parameters.number("least_row_length_m");
  options.headland_m = parameters.number("headland_m");
  options.corners = static_cast<int>(parameters.integer("corners"));
  options.slice_m = parameters.number("slice_m");
  options.gap_m = parameters.number("gap_m");
  options.budget_MB = parameters.number("budget_MB");
  options.occupancy.cell_m = parameters.number("occupancy_cell_m");
  options.occupancy.virtual_walls = parameters.boolean("virtual_walls");
  const std::string& wall = parameters.text("first_wall");
  if (wall != "auto") {
    options.occupancy.first_wall = wall == "first" ? RowEnd::kFirst : RowEnd::kLast;
  }
  check_options(options);
  return options;
}

/// Counter-clockwise. @throws ConfigError where the world has none
Polygon parcel_of(const WorldModel& world) {
  Polygon parcel = world.rows->boundary_W;
  if (parcel.size() < 3) {
    throw ConfigError(fmt::format("boundary: world '{}' has no parcel, must be none", world.name));
  }
  if (signed_area_m2(parcel) < 0.0) std::reverse(parcel.begin(), parcel.end());
  return parcel;
}

void add_comparison(const MapComparison& comparison, std::map<std::string, double>& numbers) {
  numbers["rows_found"] = comparison.found();
  numbers["rows_true"] = static_cast<double>(comparison.rows.size());
  numbers["rows_extra"] = static_cast<double>(comparison.extra_rows.size());
  numbers["direction_error_deg"] = comparison.bearing_deg;
  numbers["spacing_error_m"] = comparison.spacing_m;
  numbers["end_error_max_m"] = comparison.worst_end_m();
  numbers["volume_error_share"] = comparison.volume_share;
}

CloudMapOptions read_cloud_map_options(const ParameterSet& parameters, const WorldModel& world) {
  CloudMapOptions options = read_cloud_map_options(parameters);
  if (parameters.text("boundary") == "parcel") options.boundary_W = parcel_of(world);
  return options;
}

CloudReadOptions read_reading(const ParameterSet& parameters, const WorldModel& world) {
  CloudReadOptions reading;
  reading.crs = parameters.text("crs");
  reading.origin = world.origin;
  reading.thin = static_cast<std::uint64_t>(parameters.integer("thin"));
  reading.with_colours = false;
  return reading;
}

class CloudMapJob : public Job {
 public:
  CloudMapJob(const ParameterSet& parameters, const JobContext& context)
      : context_(context),
        options_(read_cloud_map_options(parameters, *context.world)),
        reading_(read_reading(parameters, *context.world)),
        like_world_(parameters.text("numbering") == "world") {}

  Result<JobOutcome> run(const std::map<std::string, Product>& inputs) override {
    try {
      return make(inputs.at("cloud").file);
    } catch (const ConfigError& error) {
      return Failure{error.what()};
    }
  }

 private:
  JobOutcome make(const std::filesystem::path& file) const {
    const CloudMap map = make_files(file);
    JobOutcome outcome;
    outcome.numbers = {
        {"points", static_cast<double>(map.report.points)},
        {"rows", static_cast<double>(map.map.rows.size())},
        {"alleys", static_cast<double>(map.map.alleys.size())},
        {"mesh_MB", 1e-6 * static_cast<double>(map.report.mesh_bytes)},
        {"reduction_share", map.report.reduction},
        {"containment_share", map.report.containment},
    };
    outcome.notes = map.report.notes;
    if (std::filesystem::exists(truth_file_of(file))) {
      const CloudTruth truth = read_cloud_truth(truth_file_of(file));
      add_comparison(compare_with_truth(map, truth), outcome.numbers);
    }
    outcome.product.kind = ProductKind::kMap;
    outcome.product.file = context_.folder;
    outcome.product.map = std::make_shared<RowMap>(told_map());
    return outcome;
  }

  /// The map, and the folder's files. The points are as many as the memory of a mission: they go
  /// before the truth comes.
  CloudMap make_files(const std::filesystem::path& file) const {
    CloudReadReport read;
    ParcelCloud cloud = read_parcel_cloud(file, reading_, read);
    CloudMap map = make_cloud_map(cloud, options_);
    add_source(read, map);
    save_map(map, context_.folder);
    save_map_points({reading_, options_.occupancy, std::move(cloud.classes)}, context_.folder);
    return map;
  }

  /// From the folder, so that a run on the same folder later knows the same bits.
  RowMap told_map() const {
    MapContext context;
    static_cast<PartContext&>(context) = context_;
    context.vehicle = context_.part;
    context.world = context_.world;
    context.scene = context_.scene;
    return map_in_world(load_map(context_.folder), like_world_, context, context_.folder.string());
  }

  const JobContext context_;
  const CloudMapOptions options_;
  const CloudReadOptions reading_;
  const bool like_world_;
};

}  // namespace

void register_cloud_map_job(Registry& registry) {
  PartSpec spec;
  spec.name = "cloud_map";
  spec.description =
      "turns a point cloud into a low-complexity map: rows, alleys, ground, row meshes and "
      "occupancy grid, after paper A, section 3";
  spec.parameters = cloud_map_job_parameters();
  spec.takes = {{"cloud", ProductKind::kCloud, true, "points of the whole parcel"}};
  spec.gives = ProductKind::kMap;
  registry.add_job(std::move(spec), [](const ParameterSet& parameters, const JobContext& context) {
    return std::make_unique<CloudMapJob>(parameters, context);
  });
}

}  // namespace vinerow::worlds

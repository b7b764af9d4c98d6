#include "worlds/mapping/jobs/cloud_map_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/geo/local_to_crs.h"
#include "worlds/mapping/folder/map_folder.h"
#include "worlds/mapping/folder/map_gis.h"
#include "worlds/mapping/folder/map_points.h"
#include "worlds/mapping/jobs/cloud_map_job_params.h"
#include "worlds/mapping/jobs/cloud_map_type.h"
#include "worlds/mapping/photogrammetry/map_comparison.h"
#include "worlds/mapping/pipeline/make_cloud_map.h"
#include "worlds/mapping/reading/cloud_source.h"

namespace vinerow::mapping {
namespace {

CloudMapJobParams read_cloud_map_job(const ParameterSet& parameters) {
  CloudMapJobParams params = cloud_map_job_table().read(parameters, "");
  check_options(params.options);
  return params;
}

/// The world's parcel, counter-clockwise. @throws ConfigError if the world has no parcel
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

CloudMapOptions options_in(const WorldModel& world, const CloudMapJobParams& params) {
  CloudMapOptions options = params.options;
  if (params.with_parcel) options.boundary_W = parcel_of(world);
  return options;
}

CloudReadOptions reading_in(const WorldModel& world, const CloudMapJobParams& params) {
  CloudReadOptions reading = params.reading;
  if (!reading.crs.empty() && reading.crs != "none") {
    io::LocalToCrs(reading.crs, world.origin);  // an unknown one is refused before the flight
  }
  reading.origin = world.origin;
  reading.with_colours = false;
  return reading;
}

class CloudMapJob : public Job {
 public:
  CloudMapJob(const CloudMapJobParams& params, const JobContext& context)
      : context_(context),
        options_(options_in(*context.world, params)),
        reading_(reading_in(*context.world, params)),
        like_world_(params.like_world) {}

  Result<JobOutcome> run(const std::map<std::string, Product>& inputs) override {
    try {
      return make(inputs.at("cloud").file);
    } catch (const ConfigError& error) {
      return Failure{error.what()};
    }
  }

 private:
  JobOutcome make(const std::filesystem::path& file) const {
    const CloudMap made = make_files(file);
    // Of several blocks that of the parcel, or the one with the largest total length of rows.
    const CloudMap& map = made.blocks.empty() ? made : made.blocks.front();
    JobOutcome outcome;
    outcome.numbers = {
        {"points", static_cast<double>(map.report.points)},
        {"rows", static_cast<double>(map.map.rows.size())},
        {"alleys", static_cast<double>(map.map.alleys.size())},
        {"mesh_MB", static_cast<double>(map.report.mesh_bytes) / 1e6},
        {"reduction_share", map.report.reduction},
        {"containment_share", map.report.containment},
    };
    outcome.notes = made.report.notes;
    if (std::filesystem::exists(truth_file_of(file))) {
      const CloudTruth truth = read_cloud_truth(truth_file_of(file));
      add_comparison(compare_with_truth(map, truth), outcome.numbers);
    }
    outcome.product.kind = ProductKind::kMap;
    outcome.product.file = context_.folder;
    outcome.product.map = std::make_shared<RowMap>(
        given_map(made.blocks.empty() ? context_.folder : block_folder(context_.folder, 0)));
    return outcome;
  }

  /// Makes the map and the folder's files. The points take most of the memory and are released
  /// before the truth is read.
  CloudMap make_files(const std::filesystem::path& file) const {
    CloudReadReport read;
    ParcelCloud cloud = read_parcel_cloud(file, reading_, read);
    CloudMap map = make_cloud_map(cloud, options_);
    add_source(read, map);
    save_map(map, context_.folder);
    save_gis(map, cloud, context_.folder);
    save_map_points({reading_, options_.occupancy, std::move(cloud.classes)}, context_.folder);
    return map;
  }

  /// Reads the map from the folder, so that a later run on the same folder has the same bits.
  RowMap given_map(const std::filesystem::path& folder) const {
    MapContext context;
    static_cast<PartContext&>(context) = context_;
    context.vehicle = context_.part;
    context.world = context_.world;
    context.scene = context_.scene;
    return map_in_world(load_map(folder), like_world_, context, folder.string());
  }

  const JobContext context_;
  const CloudMapOptions options_;
  const CloudReadOptions reading_;
  const bool like_world_;
};

std::vector<ResultSpec> cloud_map_results() {
  using Range = ResultRange;
  return {{"points", "1", Range::count(), "points",
           "Number of points that the job produced or read.", ""},
          {"rows", "1", Range::count(), "rows on map", "Number of plant rows on the resulting map.",
           "paper A, §3"},
          {"alleys", "1", Range::count(), "alleys on map", "Number of alleys on the resulting map.",
           ""},
          {"containment_share", "1", Range::share(), "canopy inside meshes",
           "Fraction of the canopy points within 1 cm of the inside of the map's meshes. The mesh "
           "sides are moved outwards until it reaches the setting (0.985), so it shows whether "
           "that setting was met.",
           "paper A, §3"},
          {"reduction_share", "1", Range::any(), "data reduction",
           "1 minus the size of the meshes divided by the size of the cloud.", "paper A, §3"},
          {"mesh_MB", "MB", Range::from_zero(), "mesh size",
           "Size of the map's meshes as binary PLY.", "paper A, §3"},
          {"rows_found", "1", Range::count(), "true rows found",
           "Number of true rows that have a row on the map.", "paper A, §3"},
          {"rows_true", "1", Range::count(), "true rows", "Number of true rows with canopy.", ""},
          {"rows_extra", "1", Range::count(), "false rows on map",
           "Number of rows on the map where there is no true row.", ""},
          {"direction_error_deg", "deg", Range::any(), "row direction error",
           "Direction of the rows on the map minus the true direction.", ""},
          {"spacing_error_m", "m", Range::any(), "row spacing error",
           "Row spacing of the map minus the true spacing.", ""},
          {"end_error_max_m", "m", Range::from_zero(), "max row end error",
           "Largest horizontal distance between a row end on the map and the true row end.", ""},
          {"volume_error_share", "1", Range::any(), "canopy volume error",
           "Relative error of the canopy volume inside the map's meshes: estimated divided by true "
           "volume, minus 1.",
           ""}};
}

}  // namespace

void register_cloud_map_job(Registry& registry) {
  PartSpec spec;
  spec.name = "cloud_map";
  spec.results = cloud_map_results();
  spec.description =
      "turns a point cloud into a low-complexity map: rows, alleys, ground, row meshes and "
      "occupancy grid, after paper A, section 3";
  cloud_map_job_table().add_to(spec);
  spec.takes = {{"cloud", ProductKind::kCloud, true, "points of the whole parcel"}};
  spec.gives = ProductKind::kMap;
  registry.add_job(std::move(spec), [](const ParameterSet& parameters, const JobContext& context) {
    return std::make_unique<CloudMapJob>(read_cloud_map_job(parameters), context);
  });
}

}  // namespace vinerow::mapping

#include "worlds/mapping/photogrammetry/write_cloud.h"

#include <fmt/format.h>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::mapping {
namespace {

/// Some point on the ground of the area.
Eigen::Vector3d cloud_middle(const SurveyArea& area, const WorldModel& world) {
  const Eigen::Vector2d p = area.box_W().center();
  return {p.x(), p.y(), world.terrain ? world.terrain->height_m(p.x(), p.y()) : 0.0};
}

/// Area by the share of a fine grid's points inside.
double area_m2_of(const SurveyArea& area) {
  const Eigen::AlignedBox2d box = area.box_W();
  constexpr int kSteps = 1000;
  int inside = 0;
  for (int k = 0; k < kSteps * kSteps; ++k) {
    const Eigen::Vector2d share((k % kSteps + 0.5) / kSteps, (k / kSteps + 0.5) / kSteps);
    inside += area.contains(box.min() + share.cwiseProduct(box.sizes())) ? 1 : 0;
  }
  return box.volume() * inside / (static_cast<double>(kSteps) * kSteps);
}

void note_tally(const CloudTally& tally, CloudSampling& sampling) {
  sampling.points = tally.points;
  sampling.ground_points = tally.ground_points;
  sampling.canopy_points = tally.canopy_points;
  sampling.outlier_points = tally.outliers;
  sampling.views_mean = tally.mean_views();
  sampling.horizontal_noise_rms_m = tally.horizontal_rms_m();
  sampling.height_noise_rms_m = tally.height_rms_m();
  sampling.density_per_m2 = static_cast<double>(tally.points) / sampling.area_m2;
}

/// @param sample  fills a cloud: (sink, its record) -> its tally
/// @param empty   reason why there are no points, from a tally
template <class Sample, class Empty>
Result<WrittenCloud> write(const SceneQuery& scene, const WorldModel& world, const SurveyArea& area,
                           std::uint64_t seed, const CloudTarget& target, const Sample& sample,
                           const Empty& empty) {
  CloudFile file(target.file, target.options, world.origin, cloud_middle(area, world));
  CloudSampling sampling;
  sampling.file = target.name;
  sampling.crs = target.options.crs;
  sampling.seed = seed;
  sampling.area_m2 = area_m2_of(area);
  WrittenCloud written;
  written.tally =
      sample([&file](std::span<const SampledPoint> points) { file.write(points); }, sampling);
  if (written.tally.points == 0) return Failure{empty(written.tally)};
  written.bytes = file.finish();
  note_tally(written.tally, sampling);
  written.truth = measure_truth(scene, world);
  written.truth.scenario = target.scenario;
  written.truth.sampling = sampling;
  write_cloud_truth(written.truth, truth_file_of(target.file));
  return written;
}

GeoreferenceRequest request_of(const WorldModel& world, const PictureSet& pictures,
                               const SurveyArea& area, const PhotogrammetryOptions& options) {
  GeoreferenceRequest request;
  for (const Pose& X_WS : pictures.X_WS) request.cameras_W.push_back(X_WS.p);
  request.estimated_W = pictures.estimated_W;
  for (const Eigen::Vector2d& p :
       control_places(area.box_W(), options.georeference.control_points)) {
    const bool on_terrain = world.terrain && world.terrain->contains(p.x(), p.y());
    request.marks_W.emplace_back(p.x(), p.y(),
                                 on_terrain ? world.terrain->height_m(p.x(), p.y()) : 0.0);
  }
  request.seed = options.seed;
  return request;
}

void note_georeference(const Georeference& reference, const GeoreferenceOptions& options,
                       const Eigen::Vector3d& middle_W, CloudSampling& sampling) {
  const Eigen::Vector3d error = reference.error_m(middle_W);
  sampling.georeference = name_of(options.method);
  sampling.georeference_east_m = error.x();
  sampling.georeference_north_m = error.y();
  sampling.georeference_up_m = error.z();
  sampling.georeference_tilt_deg = deg_from_rad(reference.turn_rad.head<2>().norm());
  sampling.georeference_turn_deg = deg_from_rad(reference.turn_rad.z());
  sampling.georeference_scale = reference.scale;
}

}  // namespace

SurveyArea make_survey_area(const std::vector<double>& corners_m, double margin_m,
                            const WorldModel& world, const std::string& key) {
  Polygon polygon = world.rows->boundary_W;
  if (!corners_m.empty()) {
    if (corners_m.size() % 2 != 0) {
      throw ConfigError(
          fmt::format("{}: {} numbers, must be an even number: x and y of each corner in m", key,
                      corners_m.size()));
    }
    polygon.clear();
    for (std::size_t i = 0; i < corners_m.size(); i += 2) {
      polygon.emplace_back(corners_m[i], corners_m[i + 1]);
    }
  } else if (polygon.empty()) {
    throw ConfigError(
        fmt::format("cloud: world '{}' has no parcel: give the area by {}", world.name, key));
  }
  return SurveyArea(std::move(polygon), margin_m);
}

Result<WrittenCloud> write_photogrammetry(const SceneQuery& scene, const WorldModel& world,
                                          const PictureSet& pictures, const SurveyArea& area,
                                          const PhotogrammetryOptions& options,
                                          const CloudTarget& target) {
  const auto reference =
      georeference(request_of(world, pictures, area, options), options.georeference);
  if (!reference) return Failure{"georeferencing: " + reference.reason()};
  return write(
      scene, world, area, options.seed, target,
      [&](const CloudSink& sink, CloudSampling& sampling) {
        note_georeference(*reference, options.georeference, cloud_middle(area, world), sampling);
        const PhotogrammetryReport report = sample_photogrammetry(
            scene, world, pictures.camera, pictures.X_WS, area, options, sink, *reference);
        sampling.method = "photogrammetry";
        sampling.pictures = report.pictures;
        sampling.gsd_m = report.gsd_m;
        sampling.match_px = options.match_px;
        sampling.wanted_density_per_m2 = report.density_per_m2;
        return report.tally;
      },
      [](const CloudTally& tally) {
        return fmt::format(
            "no point: the world has no surface in the area, or too few pictures see it ({} of {} "
            "pixels seen too seldom, {} from too close together)",
            tally.unseen, tally.aims, tally.thin);
      });
}

Result<WrittenCloud> write_uniform_cloud(const SceneQuery& scene, const WorldModel& world,
                                         const SurveyArea& area, const UniformCloudOptions& options,
                                         const CloudTarget& target) {
  return write(
      scene, world, area, options.seed, target,
      [&](const CloudSink& sink, CloudSampling& sampling) {
        sampling.method = "uniform";
        sampling.noise_m = options.noise_m;
        sampling.weeds_m = options.weeds.height_m;
        sampling.outliers = options.outliers;
        sampling.wanted_density_per_m2 = options.density_per_m2;
        return sample_uniformly(world, area, options, sink);
      },
      [](const CloudTally&) {
        return std::string("no point: the world has no surface in the area");
      });
}

}  // namespace vinerow::mapping

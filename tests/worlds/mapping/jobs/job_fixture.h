#pragma once
/// A small vineyard with a survey's pictures of it, and jobs that run on them.

#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/world_model.h"
#include "tests/scenarios/command.h"
#include "tests/worlds/mapping/map_fixture.h"
#include "tools/parts/register_all.h"

namespace vinerow::test {

inline const Registry& all_parts() {
  static const Registry registry = [] {
    Registry r;
    register_all(r);
    return r;
  }();
  return registry;
}

inline ParameterSet job_parameters(const std::string& type) {
  return ParameterSet(all_parts().spec(PartKind::kJob, type).parameters, type);
}

/// Straight down from 40 m above the ground, 5 x 5 pictures 8 m apart.
/// @param aside_m  east of the parcel's middle
inline std::shared_ptr<const PictureSet> pictures_of(const WorldModel& world,
                                                     double aside_m = 0.0) {
  auto pictures = std::make_shared<PictureSet>();
  pictures->source = "plane/camera";
  pictures->camera.name = "square";
  pictures->camera.focal_length_mm = 8.0;
  pictures->camera.sensor_width_mm = pictures->camera.sensor_height_mm = 12.0;
  pictures->camera.columns = pictures->camera.rows = 4000;
  Eigen::Vector2d middle(0, 0);
  for (const Eigen::Vector2d& p : world.rows->boundary_W) middle += p;
  middle = middle / static_cast<double>(world.rows->boundary_W.size());
  for (int k = 0; k < 25; ++k) {
    const double x = middle.x() + aside_m + 8.0 * (k % 5 - 2), y = middle.y() + 8.0 * (k / 5 - 2);
    const double ground_m = world.terrain->height_m(x, y);
    pictures->X_WS.push_back(
        {quaternion_from_rpy({0.0, 0.5 * std::numbers::pi, 0.0}), {x, y, ground_m + 40.0}});
  }
  return pictures;
}

/// Two straight metres for every vehicle but the one that is called "lost".
inline Result<PlannedPath> plan_for(const std::string& vehicle, std::shared_ptr<const RowMap>) {
  if (vehicle == "lost") return Failure{"no way out of alley 3"};
  PlannedPath path;
  path.points.resize(3);
  for (int k = 0; k < 3; ++k) path.points[static_cast<std::size_t>(k)].p_W = {1.0 * k, 0.0, 0.0};
  path.length_m = 2.0;
  return path;
}

/// In the vineyard of surveyed_world(). @param folder  of the job, made here
inline JobContext job_context(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  JobContext context;
  context.part = "phases.under_test";
  context.seed = 1;
  context.world = surveyed_world("vineyard").model.get();
  context.scene = &surveyed_world("vineyard").physics->scene();
  context.folder = folder;
  context.plan = plan_for;
  return context;
}

inline Result<JobOutcome> run_job(const std::string& type, const ParameterSet& parameters,
                                  const std::filesystem::path& folder,
                                  const std::map<std::string, Product>& inputs) {
  return all_parts().make_job(type, parameters, job_context(folder))->run(inputs);
}

inline std::map<std::string, Product> pictures_input(std::shared_ptr<const PictureSet> pictures) {
  Product product;
  product.kind = ProductKind::kPictures;
  product.pictures = std::move(pictures);
  return {{"pictures", product}};
}

/// 150 points a square metre.
inline ParameterSet thin_photogrammetry() {
  ParameterSet parameters = job_parameters("photogrammetry");
  parameters.set("density_per_m2", 150.0);
  return parameters;
}

/// The cloud of the vineyard's pictures, made in a folder. @throws std::runtime_error: it failed
inline Product make_cloud(const std::filesystem::path& folder,
                          const ParameterSet& parameters = thin_photogrammetry()) {
  const auto made = run_job("photogrammetry", parameters, folder,
                            pictures_input(pictures_of(*surveyed_world("vineyard").model)));
  if (!made) throw std::runtime_error(made.reason());
  return made->product;
}

/// Bytes of every file below a folder, by its path from there.
inline std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[std::filesystem::relative(entry.path(), folder).string()] = read_text(entry.path());
  }
  return files;
}

}  // namespace vinerow::test

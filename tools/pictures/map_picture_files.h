#pragma once
/// The pictures of a map as files, of `vinerow map` and of the jobs of a run.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/run/run.h"
#include "engine/scenario/scenario.h"
#include "worlds/mapping/grid/occupancy.h"
#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::tools {

/// top.png, classes.png, mesh.png and, where the map has a grid, grid.png.
/// @param cloud  with classes  @param folder  made where it is not there
/// @returns the files, in this order. @throws ConfigError where they cannot be written
std::vector<std::filesystem::path> write_map_pictures(const mapping::CloudMap& map,
                                                      const mapping::ParcelCloud& cloud,
                                                      const mapping::OccupancyOptions& options,
                                                      const std::string& title,
                                                      const std::filesystem::path& folder);

/// The same of every map that a job made of a cloud in a run, into the folder of its product, from
/// what that folder keeps (map_points.h) and the cloud that the job took. A map without points has
/// no pictures. @throws ConfigError where files of a product are not as they were written
std::vector<std::filesystem::path> write_job_pictures(const scenario::Scenario& scenario,
                                                      const run::RunResult& result);

}  // namespace vinerow::tools

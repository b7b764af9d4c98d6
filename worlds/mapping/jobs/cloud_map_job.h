#pragma once
/// The job `cloud_map`: a point cloud into a low-complexity map, as `vinerow map` makes it, and its
/// distance from the truth where the cloud has that beside it.

#include <filesystem>

#include "engine/api/registry.h"
#include "worlds/mapping/cloud/cloud_map.h"
#include "worlds/mapping/cloud/make_cloud_map.h"
#include "worlds/mapping/cloud/parcel_cloud.h"

namespace vinerow::worlds {

/// A map with the points that it was made of, and their classes.
struct CloudMapWork {
  CloudMapOptions options;
  ParcelCloud cloud;
  CloudMap map;
};

/// What the job does, without files. @param parameters  of the job  @param cloud  LAS file
/// @throws ConfigError for parameters, files and clouds that give no map
CloudMapWork work_out_cloud_map(const ParameterSet& parameters, const WorldModel& world,
                                const std::filesystem::path& cloud, bool with_colours);

/// Takes `cloud`, gives a map: its folder (docs/mapping.md), and what a vehicle with
/// `map: {type: cloud_map, folder: ...}` would be told of it.
void register_cloud_map_job(Registry& registry);

}  // namespace vinerow::worlds

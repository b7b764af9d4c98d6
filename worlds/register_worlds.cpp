#include "worlds/register_worlds.h"

#include "worlds/mapping/from_truth/row_mesh_map.h"
#include "worlds/mapping/jobs/cloud_map_job.h"
#include "worlds/mapping/jobs/cloud_map_type.h"
#include "worlds/mapping/jobs/photogrammetry_job.h"
#include "worlds/mesh/mesh_world.h"
#include "worlds/orchard/orchard.h"
#include "worlds/surveyed/surveyed.h"
#include "worlds/vineyard/vineyard.h"

namespace vinerow::worlds {

void register_worlds(Registry& registry) {
  register_orchard(registry);
  register_vineyard(registry);
  register_surveyed(registry);
  register_mesh(registry);
  mapping::register_row_mesh_map(registry);
  mapping::register_cloud_map(registry);
  mapping::register_photogrammetry_job(registry);
  mapping::register_cloud_map_job(registry);
}

}  // namespace vinerow::worlds

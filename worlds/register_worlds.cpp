#include "worlds/register_worlds.h"

#include "worlds/mapping/jobs/cloud_map_type.h"
#include "worlds/mapping/from_truth/row_mesh_map.h"
#include "worlds/mapping/jobs/cloud_map_job.h"
#include "worlds/mapping/jobs/photogrammetry_job.h"
#include "worlds/mesh/mesh_world.h"
#include "worlds/orchard/orchard.h"
#include "worlds/surveyed/surveyed.h"
#include "worlds/vineyard/vineyard.h"

namespace vinerow {

void register_worlds(Registry& registry) {
  worlds::register_orchard(registry);
  worlds::register_vineyard(registry);
  worlds::register_surveyed(registry);
  worlds::register_mesh(registry);
  worlds::register_row_mesh_map(registry);
  worlds::register_cloud_map(registry);
  worlds::register_photogrammetry_job(registry);
  worlds::register_cloud_map_job(registry);
}

}  // namespace vinerow

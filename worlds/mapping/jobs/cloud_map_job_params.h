#pragma once
/// Parameters of the job `cloud_map`.

#include "engine/api/parameter_table_fwd.h"
#include "worlds/mapping/pipeline/make_cloud_map.h"
#include "worlds/mapping/reading/read_cloud.h"

namespace vinerow::mapping {

struct CloudMapJobParams {
  CloudMapOptions options;   ///< without the boundary
  bool with_parcel = true;   ///< the boundary is the world's parcel, else a box around the rows
  bool like_world = true;    ///< numbers rows and alleys like the world
  CloudReadOptions reading;  ///< crs and thin
};

/// check_options(CloudMapOptions) checks the consistency of the options after reading.
const ParameterTable<CloudMapJobParams>& cloud_map_job_table();

}  // namespace vinerow::mapping

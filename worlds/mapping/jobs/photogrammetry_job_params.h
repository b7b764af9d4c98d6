#pragma once
/// Parameters of the job `photogrammetry`.

#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "worlds/mapping/photogrammetry/cloud_file.h"
#include "worlds/mapping/photogrammetry/photogrammetry.h"

namespace vinerow::mapping {

struct PhotogrammetryJobParams {
  PhotogrammetryOptions options;  ///< without the seed
  std::vector<double> area_m;     ///< x and y of each corner; empty: the world's parcel
  double margin_m = 0.0;          ///< around the area
  CloudFileOptions file;
};

const ParameterTable<PhotogrammetryJobParams>& photogrammetry_job_table();

}  // namespace vinerow::mapping

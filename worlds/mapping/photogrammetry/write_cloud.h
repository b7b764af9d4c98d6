#pragma once
/// A sampled cloud of a world as a file, with the truth beside it: what `vinerow cloud` and the job
/// `photogrammetry` have in common.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/api/product.h"
#include "engine/core/result.h"
#include "worlds/mapping/photogrammetry/cloud_file.h"
#include "worlds/mapping/photogrammetry/cloud_truth.h"
#include "worlds/mapping/photogrammetry/photogrammetry.h"
#include "worlds/mapping/photogrammetry/uniform_cloud.h"

namespace vinerow::mapping {

struct CloudTarget {
  std::filesystem::path file;  ///< in a folder that is there
  CloudFileOptions options;
  std::string name;      ///< of the file, as the truth tells it
  std::string scenario;  ///< likewise
};

struct WrittenCloud {
  CloudTruth truth;
  CloudTally tally;
  std::uint64_t bytes = 0;  ///< of the cloud's file
};

/// @param corners_m  x and y of each, m in W; empty: the world's parcel
/// @param key        what names the corners in errors
/// @throws ConfigError: an odd count, neither corners nor a parcel, as SurveyArea
SurveyArea make_survey_area(const std::vector<double>& corners_m, double margin_m,
                            const WorldModel& world, const std::string& key);

/// The cloud that photogrammetry makes of pictures. Same arguments, same bytes.
/// @returns what was written, or why there is no point, and then no file
/// @throws ConfigError as sample_photogrammetry(), CloudFile and write_cloud_truth()
Result<WrittenCloud> write_photogrammetry(const SceneQuery& scene, const WorldModel& world,
                                          const PictureSet& pictures, const SurveyArea& area,
                                          const PhotogrammetryOptions& options,
                                          const CloudTarget& target);

/// Points spread evenly over all surfaces, likewise.
Result<WrittenCloud> write_uniform_cloud(const SceneQuery& scene, const WorldModel& world,
                                         const SurveyArea& area, const UniformCloudOptions& options,
                                         const CloudTarget& target);

}  // namespace vinerow::mapping

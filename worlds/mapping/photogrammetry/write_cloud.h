#pragma once
/// Writing of a world's sampled cloud with its truth file, for `vinerow cloud` and the job
/// `photogrammetry`.

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
  std::filesystem::path file;  ///< in an existing folder
  CloudFileOptions options;
  std::string name;      ///< of the file, for the truth file
  std::string scenario;  ///< likewise
};

struct WrittenCloud {
  CloudTruth truth;
  CloudTally tally;
  std::uint64_t bytes = 0;  ///< of the cloud's file
};

/// @param corners_m  x and y of each, m in W; empty: the world's parcel
/// @param key        name of the corners in errors
/// @throws ConfigError: an odd count, neither corners nor a parcel, as SurveyArea
SurveyArea make_survey_area(const std::vector<double>& corners_m, double margin_m,
                            const WorldModel& world, const std::string& key);

/// Writes the cloud that photogrammetry makes from pictures. The same arguments give the same
/// bytes.
/// @returns what was written, or the reason why there are no points, and then no file
/// @throws ConfigError as sample_photogrammetry(), CloudFile and write_cloud_truth()
Result<WrittenCloud> write_photogrammetry(const SceneQuery& scene, const WorldModel& world,
                                          const PictureSet& pictures, const SurveyArea& area,
                                          const PhotogrammetryOptions& options,
                                          const CloudTarget& target);

/// Writes a uniform cloud, likewise.
Result<WrittenCloud> write_uniform_cloud(const SceneQuery& scene, const WorldModel& world,
                                         const SurveyArea& area, const UniformCloudOptions& options,
                                         const CloudTarget& target);

}  // namespace vinerow::mapping

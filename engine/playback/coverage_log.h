#pragma once
/// Coverage of a survey from the log of its run: pictures, lanes, track and parcel.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/metrics/picture_coverage.h"

namespace vinerow {
class RunShelf;
}

namespace vinerow::playback {

/// Coverage by the pictures of one camera.
struct SurveyCoverage {
  std::string scenario;
  std::string vehicle;
  std::string camera;  ///< name of the sensor
  std::vector<metrics::LaneShot> shots;
  std::vector<Eigen::Vector2d> track_W;              ///< of the vehicle, in the plane
  std::vector<std::array<Eigen::Vector2d, 2>> rows;  ///< segments of the world's plant rows, in W
  metrics::CoverageOptions options;
  metrics::CoverageMap map;
};

/// Values that replace those of the scenario's metric `survey`. If neither has a parcel, it is that
/// of the world, else the hull of all footprints.
struct CoverageChoice {
  Polygon parcel_W;
  std::optional<double> cell_m;
  std::shared_ptr<RunShelf> shelf;  ///< has the world, if the run has just ended; may be null
};

/// Coverage of every camera with pictures in the log, in the scenario's order.
/// @throws ConfigError if the log cannot be read, names parts that the registry does not have, or
/// as check_coverage_options()
std::vector<SurveyCoverage> read_coverage(const std::filesystem::path& log,
                                          const Registry& registry, const CoverageChoice& choice);

/// Numbers, parcel, and each picture's position, lane, GSD and corners on the ground, as JSON.
std::string coverage_json(const SurveyCoverage& coverage);

}  // namespace vinerow::playback

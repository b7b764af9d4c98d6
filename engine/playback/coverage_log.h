#pragma once
/// The coverage of a survey from the log of its run: pictures, lanes, track and parcel.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/metrics/picture_coverage.h"

namespace vinerow::playback {

/// What the pictures of one camera showed.
struct SurveyCoverage {
  std::string scenario;
  std::string vehicle;
  std::string camera;  ///< name of the sensor
  std::vector<metrics::LaneShot> shots;
  std::vector<Eigen::Vector2d> track_W;              ///< of the vehicle, from above
  std::vector<std::array<Eigen::Vector2d, 2>> rows;  ///< straight pieces of the world's plant rows
  metrics::CoverageOptions options;
  metrics::CoverageMap map;
};

/// What to take instead of what the scenario's metric `survey` says; without either: the parcel of
/// the world, else the hull of all footprints.
struct CoverageChoice {
  Polygon parcel_W;
  std::optional<double> cell_m;
};

/// One for every camera whose pictures the log holds, in the scenario's order; none where it holds
/// none.
/// @throws ConfigError if the log cannot be read, names parts that the registry does not have, or
/// as check_coverage_options()
std::vector<SurveyCoverage> read_coverage(const std::filesystem::path& log,
                                          const Registry& registry, const CoverageChoice& choice);

/// Numbers, parcel, and of every picture its place, lane, GSD and corners on the ground, as JSON.
std::string coverage_json(const SurveyCoverage& coverage);

}  // namespace vinerow::playback

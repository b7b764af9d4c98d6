#pragma once
/// Reader of a point cloud file for the mapping stages.

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/geo_origin.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::mapping {

struct CloudReadOptions {
  /// CRS of the file's numbers, like "EPSG:25832". "": the one that the file names; if it names
  /// none, its numbers are metres in W. "none": they are metres in W, whatever the file names.
  std::string crs;
  std::optional<GeoOrigin> origin;  ///< of W; absent: found from the cloud
  std::uint64_t thin = 1;           ///< keeps every n-th point
  bool with_colours = true;         ///< false: 12 bytes per point instead of 15
  /// Limit of the points in memory, bytes: 66 million points with colours. The mapping needs about
  /// four times as much in total.
  std::uint64_t memory_limit = 1'000'000'000;
  double largest_extent_m = 5'000.0;  ///< of the cloud along east and along north
};

struct CloudReadReport {
  std::string file;    ///< as given
  std::string format;  ///< "LAS 1.4"
  std::string crs;     ///< used CRS, or ""
  /// One of the sentences: the given CRS puts the cloud elsewhere than the one that the file names.
  /// Empty if it does not.
  std::string crs_warning;
  std::uint64_t file_bytes = 0;  ///< of the file
  bool has_origin = false;       ///< false: W has no position on Earth, and origin is all zero
  GeoOrigin origin;              ///< of W
  std::uint64_t points = 0;      ///< kept: the size of the cloud
  std::uint64_t given = 0;       ///< by the reader: kept, far away, and thinned out
  std::uint64_t not_finite = 0;  ///< left out: a coordinate is NaN or infinite
  std::uint64_t withheld = 0;    ///< left out: LAS marks them as deleted
  std::uint64_t far_away = 0;    ///< left out: far from nearly all others
  /// Points (before thinning) whose three numbers in the file equal those of an earlier one. They
  /// are kept.
  std::uint64_t repeated = 0;
  bool repeated_is_exact = true;       ///< else estimated from a share of all places
  Eigen::AlignedBox3d bounds_W;        ///< of the points kept
  std::vector<std::string> sentences;  ///< for the user: points left out, assumptions, findings
};

/// Reads a file twice: first for the position and size of the cloud, from a sample of at most
/// 65,536 points, so that neither a wrong header nor a stray point matters; then for the points.
///
/// W: with a CRS (of the options, else of the file), coordinates are transformed to the local frame
/// at the origin: that of the options, else the middle of the cloud's bounds, rounded to 1e-5
/// degrees and whole metres of height. Heights stay in the cloud's height system
/// (point_cloud_crs.h). Without a CRS the file's numbers are coordinates of W.
///
/// A point is far away if it is outside the box of the middle 99 % of the points of each axis (90 %
/// if only that box can be a parcel) by more than the box's size and 100 m.
///
/// Points without a colour in a file with colours become black.
///
/// Memory: the points, 15 bytes each with colours, and 40 MB. Deterministic.
/// @throws ConfigError in one sentence that names the file, the numbers and the remedy: errors of
/// the readers; no points left; numbers in degrees without a geographic CRS; all points in one spot
/// or on one line; larger than largest_extent_m; farther than 20 km from the given origin; more
/// than memory_limit; thin = 0; an unknown CRS
ParcelCloud read_parcel_cloud(const std::filesystem::path& file, const CloudReadOptions& options,
                              CloudReadReport& report);

}  // namespace vinerow::mapping

#pragma once
/// A file of points into the memory of the mapping stages.

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
  /// Of the file's numbers, like "EPSG:25832". "": the one that the file names; where it names
  /// none, its numbers are metres in W. "none": they are, whatever it names.
  std::string crs;
  std::optional<GeoOrigin> origin;  ///< of W; absent: found from the cloud
  std::uint64_t thin = 1;           ///< keeps every n-th point
  bool with_colours = true;         ///< false: 12 bytes a point instead of 15
  /// Bytes of the points in memory: 66 million with colours. The mapping needs about four times as
  /// much in all.
  std::uint64_t memory_limit = 1'000'000'000;
  double largest_extent_m = 5'000.0;  ///< of the cloud along east and along north
};

struct CloudReadReport {
  std::string file;    ///< as it was given
  std::string format;  ///< "LAS 1.4"
  std::string crs;     ///< that was used, or ""
  /// One of the sentences: the CRS that was asked for puts the cloud elsewhere than the one that
  /// the file names. Empty: it does not.
  std::string crs_warning;
  std::uint64_t file_bytes = 0;  ///< of the file
  bool has_origin = false;       ///< false: W is nowhere on Earth, and origin is all zero
  GeoOrigin origin;              ///< of W
  std::uint64_t points = 0;      ///< kept: as many as the cloud has
  std::uint64_t given = 0;       ///< by the reader: kept, far away, and thinned out
  std::uint64_t not_finite = 0;  ///< left out: a coordinate is NaN or infinite
  std::uint64_t withheld = 0;    ///< left out: LAS marks them as deleted
  std::uint64_t far_away = 0;    ///< left out: far from nearly all others
  /// Points (before thinning) whose three numbers in the file equal those of an earlier one. They
  /// are kept.
  std::uint64_t repeated = 0;
  bool repeated_is_exact = true;       ///< else estimated from a share of all places
  Eigen::AlignedBox3d bounds_W;        ///< of the points kept
  std::vector<std::string> sentences;  ///< for the user: what was left out, assumed, found
};

/// Reads a file twice: a first time for the place and the size of the cloud, by a sample of 65,536
/// points at most, so that neither a wrong header nor a stray point counts; a second time for the
/// points.
///
/// W: where there is a CRS (of the options, else of the file), its coordinates are brought to the
/// local frame at the origin: that of the options, else the middle of the cloud's bounds, rounded
/// to 1e-5 degrees and whole metres of height. Heights stay in the cloud's height system
/// (point_cloud_crs.h). Without a CRS the file's numbers are W's.
///
/// Far away is what lies beyond the box of the middle 99 % of the points of each axis (90 %, where
/// that is what it takes to be a parcel) by more than the box's size and 100 m.
///
/// Points without a colour in a file with colours become black.
///
/// Memory: the points, 15 bytes each with colours, and 40 MB. Deterministic.
/// @throws ConfigError in one sentence that names the file, the numbers and the way out: what the
/// readers refuse; no points left; numbers in degrees without a CRS that says so; all points in one
/// spot or on one line; larger than largest_extent_m; farther than 20 km from the origin given;
/// more than memory_limit; thin = 0; an unknown CRS
ParcelCloud read_parcel_cloud(const std::filesystem::path& file, const CloudReadOptions& options,
                              CloudReadReport& report);

}  // namespace vinerow::mapping

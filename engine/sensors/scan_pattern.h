#pragma once
/// Directions of a 3D laser scanner's pulses over time, in its frame S: x forward, z up.
///
/// Spinning: lasers at fixed elevations turn clockwise, seen from above; the seam of a turn is
/// behind. In a column all lasers fire once, one after the other within `firing_s`. A turn has
/// `columns`, as where the encoder of the mirror fires the lasers. Or a column follows the last
/// after `column_s` at any rate of turns, as where a clock fires them: then turns begin between
/// columns, each a little elsewhere. Rings are counted from the lowest laser.
///
/// Rosette: one or more lasers that never repeat their path. Azimuth grows evenly, elevation goes
/// up and down evenly; the two rates have no common period. This covers what the scanners of this
/// kind cover, not their secret curve.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/api/parameter_table.h"

namespace vinerow::sensors {

struct LaserPulse {
  double time_s = 0.0;  ///< from the start of its frame
  Eigen::Vector3d dir_S = Eigen::Vector3d::UnitX();
  std::uint16_t ring = 0;
  /// In the picture of a turn, whose columns begin behind and have one azimuth, to half a column.
  /// Only of a spinning scanner with `columns`.
  std::uint32_t column = 0;
};

inline constexpr int kColumns = 1800;

struct ScanPatternParams {
  bool is_rosette = false;
  // Spinning.
  std::vector<double> elevations_deg = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                        -7,  9, -5,  11, -3,  13, -1, 15};
  std::vector<double> azimuth_offsets_deg;
  std::optional<int> columns;  ///< default: kColumns, unless there is column_s
  double column_s = 0.0;       ///< 0: none
  double firing_s = 0.0;
  double field_of_view_deg = 360.0;
  // Rosette.
  int lasers = 4;
  double pulses_per_s = 200'000.0;
  double lowest_deg = -7.0;
  double highest_deg = 52.0;
  double turns_per_s = 10.0;
  double waves_per_s = 61.8034;
};

const ParameterTable<ScanPatternParams>& scan_pattern_table();

class ScanPattern {
 public:
  virtual ~ScanPattern() = default;
  /// Pulses of a frame in the order of their times, valid until the next call.
  virtual std::span<const LaserPulse> pulses(std::uint64_t frame) = 0;
  /// Largest number of pulses of a frame.
  virtual std::size_t most_pulses() const = 0;
};

/// @param period_s  of a frame: a turn of a spinning scanner
/// @param who  prefix of errors
/// @throws ConfigError if a frame would have no pulses, or too many, or if a column takes longer
/// than the time to the next
std::unique_ptr<ScanPattern> make_scan_pattern(const ScanPatternParams& params, double period_s,
                                               const std::string& who);

}  // namespace vinerow::sensors

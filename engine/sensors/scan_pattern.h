#pragma once
/// Directions of a 3D laser scanner's pulses over time, in its frame S: x forward, z up.
///
/// Spinning: lasers at fixed elevations turn clockwise, seen from above; the seam of a turn is
/// behind. A turn has `columns` firings of all lasers, which fire one after the other within
/// `firing_s`. Rings are counted from the lowest laser.
///
/// Rosette: one or more lasers that never repeat their path. Azimuth grows evenly, elevation goes
/// up and down evenly; the two rates have no common period. This covers what the scanners of this
/// kind cover, not their secret curve.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/api/parameter_table.h"

namespace vinerow::sensors {

struct LaserPulse {
  double time_s = 0.0;  ///< from the start of its frame
  Eigen::Vector3d dir_S = Eigen::Vector3d::UnitX();
  std::uint16_t ring = 0;
};

struct ScanPatternParams {
  bool is_rosette = false;
  // Spinning.
  std::vector<double> elevations_deg = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                        -7,  9, -5,  11, -3,  13, -1, 15};
  std::vector<double> azimuth_offsets_deg;
  int columns = 1800;
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
};

/// @param period_s  of a frame: a turn of a spinning scanner
std::unique_ptr<ScanPattern> make_scan_pattern(const ScanPatternParams& params, double period_s);

}  // namespace vinerow::sensors

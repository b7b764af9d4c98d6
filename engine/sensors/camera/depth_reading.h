#pragma once
/// Depth as a camera reports it: distances along the optical axis in whole millimetres, 0 where
/// there is none (ROS 16UC1).
///
/// A stereo camera measures the disparity d = fx B / z between its pictures. An error of
/// `depth_disparity_std_px` in d makes one of z^2 / (fx B) times it in z. Nothing nearer than
/// depth_min_m or farther than depth_max_m is reported.

#include <cstdint>
#include <optional>

#include "engine/api/parameter_table_fwd.h"
#include "engine/sensors/camera/imager.h"

namespace vinerow::sensors {

struct DepthParams {
  double min_m = 0.0;
  double max_m = 65.0;
  double baseline_m = 0.0;
  double disparity_std_px = 0.0;
  double dropout_share = 0.0;
};

/// `depth_min_m` to `depth_dropout_share`.
const ParameterTable<DepthParams>& depth_table();

class DepthReading {
 public:
  DepthReading(const DepthParams& params, double fx_px);

  /// @param depth_m  true depth; 0: nothing
  std::uint16_t exact_mm(double depth_m) const;
  /// Draws two numbers, whatever the depth.
  std::uint16_t reading_mm(double depth_m, QuickNormals& noise) const;

 private:
  DepthParams params_;
  double std_per_m2_ = 0.0;  ///< 1/m
};

}  // namespace vinerow::sensors

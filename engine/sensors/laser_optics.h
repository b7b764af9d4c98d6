#pragma once
/// What a laser scanner's beam gets back from a surface.
///
/// Received power, 1 for a surface of 10 % reflectance at normal incidence at dark_range_m:
/// P = reflectance / 0.1 x cos(incidence) x (dark_range / r)^2. It is detected with probability
/// P^4 / (P^4 + 1/9): 0.9 at P = 1, one half at P = 0.58. Data sheets state the range on white and
/// on 10 % targets; the slope between them (power 4) is chosen.
///
/// Reading: + a constant error of the device, drawn once from +-accuracy_m, + white noise of
/// noise_std_m + noise_growth r.

#include <Eigen/Core>
#include <array>

#include "engine/api/parameter_table.h"
#include "engine/api/part.h"
#include "engine/api/scene_query.h"

namespace vinerow::sensors {

/// In the near infrared.
struct LaserReflectances {
  double canopy = 0.45;
  double ground = 0.25;
  double stem = 0.35;
  double obstacle = 0.4;
};

/// What scanners have in common.
struct LaserRanging {
  double min_range_m = 0.06;
  double max_range_m = 10.0;
  double accuracy_m = 0.0;
  double noise_std_m = 0.01;
  double noise_growth = 0.0;
  double dark_range_m = 1000.0;
  double beam_dropout_share = 0.0;
  LaserReflectances reflectances = {};
};

/// `min_range_m` to `beam_dropout_share`, and the reflectances.
const ParameterTable<LaserRanging>& laser_ranging_table();

/// Constant error of this device, within +-accuracy_m.
double draw_offset_m(const LaserRanging& ranging, const PartContext& context);

class LaserOptics {
 public:
  /// @param offset_m  draw_offset_m()
  LaserOptics(const LaserRanging& ranging, double offset_m);

  /// Power of a whole beam. Surfaces nearer than min_range_m reflect no more than there.
  /// @param dir_W  of the ray that met the surface, unit
  double power(const RayHit& hit, const Eigen::Vector3d& dir_W) const;
  /// Reflectance times cosine that would give this power at this distance.
  double apparent_reflectance(double power, double distance_m) const;
  /// @param noise  of unit variance @returns +infinity outside of the range
  double reading_m(double distance_m, double noise) const;
  static double detection_probability(double power);

 private:
  LaserRanging ranging_;
  double offset_m_;
  std::array<double, 8> reflectance_;  ///< by SurfaceClass
};

}  // namespace vinerow::sensors

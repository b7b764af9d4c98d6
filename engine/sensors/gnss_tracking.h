#pragma once
/// Satellite tracking of a receiver: which satellites it receives, with which C/N0, and for how
/// long.
///
/// A ray from the antenna through the true world checks every satellite above the mask. Ground,
/// posts, stems and other solid objects block it. Leaves attenuate it by a loss per metre of
/// canopy, in proportion to its leaf area density where the world knows it (their optical depth
/// grows with the water in them: Jackson, Schmugge, "Vegetation effects on the microwave emission
/// of soils", Remote Sens. Environ. 36, 1991), plus a fading share of that loss (a first-order
/// Gauss-Markov process for each satellite). Two successive canopy surfaces along a ray bound
/// leaves; an unpaired one, a sheet without a back, counts as `lone_leaves_m`.
///
///   C/N0 = horizon + (zenith - horizon) sin(elevation) - leaves - jamming
///
/// A satellite is used for a code position if its C/N0 has been sufficient for `reacquisition_s`,
/// or at once after a gap of at most `bridged_gap_s`. It is used for a carrier-phase position if
/// its C/N0 has been sufficient for that during `carrier_lock_s` without any gap: a gap is a cycle
/// slip. Its weight in the geometry, at most 1, depends on the share k of noise in a range's
/// variance at the usual C/N0:
///
///   w = 1 / (1 - k + k 10^((usual - C/N0) / 10))
///
/// For phases k = 1 (Hartinger, Brunner, "Variances of GPS phase observations: the SIGMA-epsilon
/// model", GPS Solutions 2(4), 1999); most of a code's error comes from elsewhere.

#include <vector>

#include "engine/api/foliage.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/scene_query.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "engine/sensors/gauss_markov.h"
#include "engine/sensors/gnss_geometry.h"
#include "engine/sensors/gnss_sky.h"

namespace vinerow::sensors {

struct GnssSignals {
  double mask_rad = rad_from_deg(10.0);
  double zenith_cn0_dBHz = 48.0;
  double horizon_cn0_dBHz = 38.0;
  double usual_cn0_dBHz = 45.0;
  double code_noise_share = 0.1;
  double carrier_noise_share = 1.0;
  double code_cn0_dBHz = 20.0;
  double carrier_cn0_dBHz = 32.0;
  double leaves_dB_per_m = 6.0;
  double fading_share = 0.4;
  double fading_time_s = 1.0;
  double reacquisition_s = 2.0;
  double bridged_gap_s = 1.0;
  double carrier_lock_s = 2.0;
};

/// Rejects signals if carrier phase needs less C/N0 than code, or C/N0 is smaller at the zenith
/// than at the horizon.
const ParameterTable<GnssSignals>& gnss_signal_table();

/// Geometry of the satellites of one tick.
struct GnssView {
  GnssGeometry code;
  GnssGeometry carrier;
};

class GnssTracking {
 public:
  /// @param scene  outlives this  @param leaves  of the scene's world  @param locked  begins as if
  /// it had tracked all sky for long
  GnssTracking(const GnssSignals& signals, GnssSky sky, const SceneQuery& scene,
               LeafAreaDensity leaves, double period_s, bool locked, RandomStream random);

  /// Advances by one tick. Draws one number per satellite, visible or not.
  /// @param in_outage  no satellite is received
  /// @param jamming_dB  loss of C/N0 of every satellite
  GnssView look(double time_s, const Eigen::Vector3d& p_W, bool in_outage, double jamming_dB);

 private:
  struct Satellite {
    double received_s = 0.0;  ///< C/N0 sufficient for code, gaps bridged
    double gap_s = 0.0;       ///< not sufficient
    double carrier_s = 0.0;   ///< sufficient for carrier phase
    GaussMarkov fading;       ///< unit variance
  };

  /// @returns metres of leaves of the usual density along the ray to the sky; negative if it is
  /// blocked
  double leaves_m(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W);
  void track(Satellite& satellite, double cn0_dBHz) const;
  double weight(double cn0_dBHz, double noise_share) const;

  GnssSignals signals_;
  GnssSky sky_;
  const SceneQuery* scene_;
  LeafAreaDensity leaves_;
  double period_s_;
  RandomStream random_;
  std::vector<Satellite> satellites_;
};

}  // namespace vinerow::sensors

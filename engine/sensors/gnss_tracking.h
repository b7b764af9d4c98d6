#pragma once
/// Which satellites a receiver hears, how well, and for how long already.
///
/// Every satellite above the mask is looked for by a ray from the antenna through the true world.
/// Ground, posts, stems and other solid things take it away. Leaves weaken it by so many dB per
/// metre of canopy, plus a share of that which fades in and out (a first-order Gauss-Markov process
/// of each satellite). Two neighbouring surfaces of canopy along a ray bound leaves; an odd one, a
/// sheet without a back, counts as `lone_leaves_m`.
///
///   C/N0 = horizon + (zenith - horizon) sin(elevation) - leaves - jamming
///
/// A satellite serves a position by code once its C/N0 has been enough for `reacquisition_s`, or at
/// once after a gap of at most `bridged_gap_s`. It serves one by carrier phase once its C/N0 has
/// been enough for that during `carrier_lock_s` without any gap: a gap is a cycle slip. Weight in
/// the geometry, at most 1, with the share k that noise has in a range's variance at the usual
/// C/N0:
///
///   w = 1 / (1 - k + k 10^((usual - C/N0) / 10))
///
/// For phases k = 1 (Hartinger, Brunner, "Variances of GPS phase observations: the SIGMA-epsilon
/// model", GPS Solutions 2(4), 1999); most of a code's error comes from elsewhere.

#include <vector>

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

/// Refuses signals of which carrier phase needs less than code, or of which there is less at the
/// zenith than at the horizon.
const ParameterTable<GnssSignals>& gnss_signal_table();

/// What one look at the sky gave.
struct GnssView {
  GnssGeometry code;
  GnssGeometry carrier;
};

class GnssTracking {
 public:
  /// @param scene  outlives this  @param locked  begins as if it had tracked all sky for long
  GnssTracking(const GnssSignals& signals, GnssSky sky, const SceneQuery& scene, double period_s,
               bool locked, RandomStream random);

  /// One tick. Draws one number per satellite, seen or not.
  /// @param deaf  hears nothing at all  @param jamming_dB  loss of C/N0 of every satellite
  GnssView look(double time_s, const Eigen::Vector3d& p_W, bool deaf, double jamming_dB);


 private:
  struct Satellite {
    double heard_s = 0.0;    ///< C/N0 enough for code, gaps bridged
    double gap_s = 0.0;      ///< not enough
    double carrier_s = 0.0;  ///< enough for carrier phase
    GaussMarkov fading;      ///< unit variance
  };

  /// @returns metres of leaves on the way to the sky; negative if something solid is in it
  double leaves_m(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W);
  void track(Satellite& satellite, double cn0_dBHz) const;
  double weight(double cn0_dBHz, double noise_share) const;

  GnssSignals signals_;
  GnssSky sky_;
  const SceneQuery* scene_;
  double period_s_;
  RandomStream random_;
  std::vector<Satellite> satellites_;
};

}  // namespace vinerow::sensors

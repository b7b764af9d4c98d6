#pragma once
/// Spray jet of an air-assisted nozzle: the droplets follow an air jet that slows down, drifts with
/// the wind and sinks; leaves catch a share of them.
///
/// **Jet.** Relative to the air around it the jet keeps its direction. Its speed falls with the
/// distance x along it as U d / (d + x) (round jets far from the outlet: u ~ 1/x; Rajaratnam,
/// "Turbulent jets", 1976, ch. 2; d about six outlet widths), and the wind carries all of it along:
///   p(x) = p_0 + x e + (w - s z) t(x),    t(x) = (x + x^2 / (2 d)) / U
///   U e = u_0 n + v - w
/// with the direction n of the nozzle, the speed u_0 at the outlet, the velocity v of the nozzle
/// over ground (driving bends the jet first forward, then backward), the wind w and the speed s at
/// which droplets of this size fall. Droplets move with the air of the jet. The path is traced in
/// straight pieces that double in length; their end points are exact.
///
/// **Leaves.** Of the liquid that enters a canopy's hull the share 1 - exp(-k l) stays on the
/// leaves along the chord l (Beer's law: Ross, "The radiation regime and architecture of plant
/// stands", 1981), with k = leaf area density of that hull times the mean projection of leaves (1/2
/// for leaves of all inclinations). The deposit of the first half of the chord is placed at the
/// entry, the rest at the exit. The remaining jet continues behind the canopy.
///
/// **Loss.** A share of the liquid leaves the jet per metre: fine droplets and evaporation. Liquid
/// that is in the air at the end of the reach is lost too, as is the last hundredth of a portion.

#include <Eigen/Core>

#include "engine/api/foliage.h"
#include "engine/api/scene_query.h"

namespace vinerow::vehicles {

struct SprayParams {
  double jet_speed_mps = 25.0;   ///< u_0
  double jet_decay_m = 0.6;      ///< d
  double reach_m = 4.0;          ///< longest x
  double settling_mps = 0.3;     ///< s
  double loss_length_m = 15.0;   ///< distance after which 1/e is left
  double leaf_projection = 0.5;  ///< k over the leaf area density
};

class SprayJet {
 public:
  /// @param p_W  of the nozzle, m  @param direction_W  unit  @param v_W,wind_W  m/s
  SprayJet(const SprayParams& params, const Eigen::Vector3d& p_W,
           const Eigen::Vector3d& direction_W, const Eigen::Vector3d& v_W,
           const Eigen::Vector3d& wind_W);

  /// Position of the droplets after the distance x along the jet, x >= 0.
  Eigen::Vector3d at(double x_m) const;
  /// Their time of flight to x, s.
  double time_s(double x_m) const;

 private:
  Eigen::Vector3d p_W_, axis_W_, carried_W_mps_;
  double speed_mps_;
  double decay_m_;
};

/// Destinations of a portion of liquid; their sum is the portion.
struct SprayFate {
  double canopy_ml = 0.0;
  double ground_ml = 0.0;  ///< ground and objects on it: posts, trunks, boxes
  double lost_ml = 0.0;    ///< evaporated, or in the air beyond the reach
};

/// Traces a portion of liquid along a jet. No heap if `deposit` uses none.
/// @param leaves  of the scene's world
/// @param deposit  void(const Eigen::Vector3d& p_W, double ml): called for liquid on leaves
template <class F>
SprayFate trace_spray(const SceneQuery& scene, const LeafAreaDensity& leaves,
                      const SprayParams& params, const SprayJet& jet, double portion_ml,
                      F&& deposit);

namespace internal {

/// First object on a straight piece of the path.
struct SprayMeeting {
  bool meets = false;
  bool is_canopy = false;
  int mesh = -1;  ///< as RayHit::mesh
  double distance_m = 0.0;
  double chord_m = 0.0;  ///< through the canopy; 0: it has no far side
};
SprayMeeting meet(const SceneQuery& scene, const Eigen::Vector3d& p_W,
                  const Eigen::Vector3d& direction_W, double length_m);

constexpr double kFirstPiece_m = 0.5;
constexpr double kMinShare = 0.01;

}  // namespace internal

template <class F>
SprayFate trace_spray(const SceneQuery& scene, const LeafAreaDensity& leaves,
                      const SprayParams& params, const SprayJet& jet, double portion_ml,
                      F&& deposit) {
  SprayFate fate;
  double left_ml = portion_ml;
  const auto lose_along = [&](double along_m) {
    const double lost_ml = left_ml * -std::expm1(-along_m / params.loss_length_m);
    fate.lost_ml += lost_ml;
    left_ml -= lost_ml;
  };
  double x_m = 0.0, next_m = internal::kFirstPiece_m;
  Eigen::Vector3d p_W = jet.at(0.0);
  while (x_m < params.reach_m && left_ml > internal::kMinShare * portion_ml) {
    while (next_m <= x_m) next_m *= 2.0;
    const double until_m = std::min(next_m, params.reach_m);
    // Canopy shifts the jet, which then continues parallel to its undisturbed path.
    const Eigen::Vector3d displacement = jet.at(until_m) - jet.at(x_m);
    const double length_m = displacement.norm();
    const Eigen::Vector3d direction = displacement / length_m;
    const internal::SprayMeeting met = internal::meet(scene, p_W, direction, length_m);
    if (!met.meets) {
      lose_along(until_m - x_m);
      p_W += displacement;
      x_m = until_m;
      continue;
    }
    const double before_m = (until_m - x_m) * met.distance_m / length_m;
    lose_along(before_m);
    if (!met.is_canopy) {
      fate.ground_ml += left_ml;
      return fate;
    }
    const Eigen::Vector3d entry_W = p_W + met.distance_m * direction;
    if (met.chord_m <= 0.0) {
      deposit(entry_W, left_ml);
      fate.canopy_ml += left_ml;
      return fate;
    }
    const double extinction_per_m = params.leaf_projection * leaves.of(met.mesh);
    const double half = std::exp(-0.5 * extinction_per_m * met.chord_m);
    const double first_ml = left_ml * (1.0 - half), second_ml = (left_ml - first_ml) * (1.0 - half);
    p_W = entry_W + met.chord_m * direction;
    deposit(entry_W, first_ml);
    deposit(p_W, second_ml);
    fate.canopy_ml += first_ml + second_ml;
    left_ml -= first_ml + second_ml;
    x_m += before_m + met.chord_m;
  }
  fate.lost_ml += left_ml;
  return fate;
}

}  // namespace vinerow::vehicles

#pragma once
/// Ground effect: more thrust at the same rotor speed close to the ground.
///
/// The ground acts as a mirror: the wake of the rotor's image opposes its own. With a source for
/// each rotor, at height z above the ground:
///   one rotor (Cheeseman, Bennett, ARC R&M 3021, 1955):  T / T_free = 1 / (1 - (R / 4z)^2)
///   four rotors on a square of side d, diagonal b, with the wake that turns up below the body
///   (Sanchez-Cuevas, Heredia, Ollero, Int. J. Aerospace Engineering 2017, 1823056):
///     T / T_free = 1 / (1 - (R/4z)^2 - R^2 z / (d^2 + 4z^2)^(3/2) - R^2 z / (2 (2d^2 +
///     4z^2)^(3/2))
///                       - 2 K_b R^2 z / (b^2 + 4z^2)^(3/2))
/// K_b = 2 is measured in that paper, for z from R/2 upwards. Lower heights count as R/2, and the
/// ratio is at most kMaxRatio.

namespace vinerow::vehicles {

enum class GroundEffectModel {
  kNone,
  kSingle,     ///< each rotor on its own
  kMultirotor  ///< four on a square
};

class GroundEffect {
 public:
  static constexpr double kMaxRatio = 1.5;
  /// Height over rotor radius at which the effect ends; it fades out over the last quarter.
  static constexpr double kReachRadii = 20.0;

  GroundEffect() = default;
  /// @param rotor_radius_m,arm_m  > 0; arm: from the middle to a hub
  GroundEffect(GroundEffectModel model, double rotor_radius_m, double arm_m, double body_lift);

  /// Height above which there is no effect; 0 for kNone.
  double reach_m() const { return reach_m_; }
  /// Thrust at this height over thrust in free air, at the same speed.
  /// @param height_m  of the hub, perpendicular to the ground
  /// @param facing  cosine between the rotor's axis and the ground's normal; <= 0: no effect
  double thrust_ratio(double height_m, double facing = 1.0) const;

 private:
  GroundEffectModel model_ = GroundEffectModel::kNone;
  double radius_m_ = 1.0, arm_m_ = 1.0, body_lift_ = 0.0, reach_m_ = 0.0;
};

}  // namespace vinerow::vehicles

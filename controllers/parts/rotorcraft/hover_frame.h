#pragma once
/// Frame H in which the quadrotor's model is linear: the origin is the wanted position now, z is
/// up, x is the wanted heading now. It does not turn during the prediction.
///
/// Roll, pitch, their rates and the torques are about the axes of H, not of the body. So the model
/// holds through a turn, in which the heading changes by a radian within the horizon: the tilt that
/// pushes to the centre of the turn stays constant while the body turns below it. Tilts computed
/// from the direction of thrust make this exact in the attitude:
///   z_B = (z_x, z_y, z_z) in H,  pitch = atan2(z_x, z_z),  roll = -atan2(z_y, z_z),
/// the horizontal acceleration is then thrust z_z / m times (tan pitch, -tan roll).

#include <Eigen/Core>

#include "controllers/parts/rotorcraft/rotor_mixer.h"
#include "engine/api/messages/flight.h"

namespace vinerow::controllers {

/// Index of a group of three in the states of HoverModel; wrench: four.
enum HoverIndex {
  kHoverPosition = 0,
  kHoverVelocity = 3,
  kHoverAngle = 6,
  kHoverRate = 9,
  kHoverWrench = 12
};

class HoverFrame {
 public:
  HoverFrame(const Eigen::Vector3d& p_WH, double yaw_rad);
  explicit HoverFrame(const TrajectoryPoint& at) : HoverFrame(at.p_W, at.yaw_rad) {}

  const Eigen::Vector3d& p_WH() const { return p_WH_; }
  double yaw_rad() const { return yaw_rad_; }
  /// A vector of W in H and back.
  Eigen::Vector3d from_W(const Eigen::Vector3d& v_W) const;
  Eigen::Vector3d to_W(const Eigen::Vector3d& v_H) const;

 private:
  Eigen::Vector3d p_WH_;
  double yaw_rad_;
  double cos_, sin_;
};

/// State of a vehicle in H.
struct HoverState {
  /// Position, velocity, roll, pitch, yaw error and their rates: the first 12 states of HoverModel.
  Eigen::Matrix<double, 12, 1> x;
  double upright = 1.0;  ///< z_z, cosine of the tilt

  double tilt_rad() const;
};

HoverState calc_hover_state(const Odometry& odometry, const HoverFrame& frame);

/// The wrench in B that acts in H like u = (thrust minus weight, torques), and the inverse. Thrust
/// is raised to compensate for the tilt, at most twofold; upside down the thrust is zero.
Wrench calc_body_wrench(const Eigen::Vector4d& u, const HoverState& state, double weight_N);
Eigen::Vector4d calc_hover_wrench(const Wrench& wrench, const HoverState& state, double weight_N);

}  // namespace vinerow::controllers

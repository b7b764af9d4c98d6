#include "engine/sensors/camera/camera_motion.h"

#include <Eigen/Geometry>

namespace vinerow::sensors {

const Eigen::Matrix3d& R_SC() {
  static const Eigen::Matrix3d matrix =
      (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished();
  return matrix;
}

CameraMotion CameraMotion::of_body(const Odometry& body, const Pose& X_BS) {
  return {body.X_WB * X_BS, body.X_WB.q * (body.v_WB_B + body.w_WB_B.cross(X_BS.p)),
          X_BS.q.conjugate() * body.w_WB_B};
}

OpticalPlace CameraMotion::place_at(double time_s) const {
  const Eigen::Matrix3d R_WS = X_WS.q.toRotationMatrix();
  OpticalPlace place{X_WS.p + time_s * v_W, R_WS * R_SC()};
  const Eigen::Vector3d turn_S = time_s * w_WS_S;
  const double angle = turn_S.norm();
  if (angle > 0.0) {
    place.R_WC = R_WS * Eigen::AngleAxisd(angle, turn_S / angle).toRotationMatrix() * R_SC();
  }
  return place;
}

double row_time_s(double row, int height, double readout_s) {
  return height > 1 ? (row / (height - 1.0) - 0.5) * readout_s : 0.0;
}

}  // namespace vinerow::sensors

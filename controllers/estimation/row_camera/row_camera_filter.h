#pragma once
/// Extended Kalman filter of a vehicle's place and heading in the plane, from wheels, a rate gyro
/// and marks of mapped rows.
///
/// State: x, y, heading, bias of the gyro. Prediction: the speed of the wheels along the heading,
/// which turns by the rate less the bias; for a distance d and an angle a the noise is
/// q^2 d + s^2 |a| along each axis, since turning skids. A mark at p_B on a row's line has the
/// residual
///   r = -n.(p + R p_B - q)
/// with the nearest point q of the line and the line's normal n. Its variance is
/// mark_std^2 + (n.R s_B)^2 with the range's error s_B along the line of sight, which matters
/// little for rows that the camera looks along. All marks of a picture have common errors
/// (mounting, tilt, the ground's shape): together they weigh no more than `marks_per_picture`
/// independent ones.

#include <Eigen/Core>
#include <vector>

#include "controllers/estimation/row_camera/row_marks.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/math/polyline_index.h"

namespace vinerow::controllers {

struct RowCameraFilterParams {
  double start_std_m = 0.05;
  double start_yaw_std_rad = 0.0175;
  double start_bias_std_radps = 0.002;
  double drift_m_per_sqrt_m = 0.02;
  double slip_m_per_sqrt_rad = 0.1;
  double turn_rad_per_sqrt_s = 0.002;
  double bias_radps_per_sqrt_s = 1e-5;
  double mark_std_m = 0.08;
  double mark_gate_m = 0.4;
  double marks_per_picture = 8.0;
};

/// `start_std_m` to `marks_per_picture`.
const ParameterTable<RowCameraFilterParams>& row_camera_filter_table();

class RowCameraFilter {
 public:
  using State = Eigen::Vector4d;  ///< x, y, heading, bias

  /// @param rows  lines of the map's rows
  RowCameraFilter(const RowCameraFilterParams& params, std::vector<Polyline> rows);

  /// @param start  x, y, heading; its error is drawn by the caller
  void start(const Eigen::Vector3d& start);
  bool ready() const { return ready_; }
  void predict(double speed_mps, double rate_radps, double period_s);
  /// @param past  state at the time of the picture  @returns number of marks that were used
  int correct(const std::vector<RowMark>& marks, const State& past);

  const PolylineIndex& rows() const { return rows_; }
  const State& state() const { return x_; }
  const Eigen::Matrix4d& covariance() const { return P_; }

 private:
  RowCameraFilterParams params_;
  PolylineIndex rows_;
  bool ready_ = false;
  State x_ = State::Zero();
  Eigen::Matrix4d P_ = Eigen::Matrix4d::Zero();
};

}  // namespace vinerow::controllers

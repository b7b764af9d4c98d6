#pragma once
/// Reference as states and inputs of the model: position, and the tilt, rates, thrust and torques
/// that it requires, drag and estimated disturbances included. This feed-forward avoids an offset
/// from accelerations, turns and wind.
///
/// The vehicle is accelerated by lift tan(tilt), lift = g plus the climb acceleration, the model by
/// g tilt. The wanted tilt is that of the vehicle, and the difference in the model now is passed on
/// as a known acceleration; otherwise every steady wind would leave an offset of the order tilt^3.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/rotorcraft/hover_frame.h"

namespace vinerow::controllers {

class FlightTargets {
 public:
  FlightTargets(const RotorcraftModel& craft, int horizon, double period_s);

  /// @param preview  horizon + 1 points, one per tick, the first one now
  /// @param acceleration_H  of unknown forces, m/s2  @param torque_H  unknown torques, N m
  void update(const HoverFrame& frame, const std::vector<TrajectoryPoint>& preview,
              const Eigen::Vector3d& acceleration_H, const Eigen::Vector3d& torque_H);

  /// Makes the correction of a large error along the path gradual: moves the positions along x by
  /// `excess_m` now, which decays within a second or two, and the speeds accordingly.
  void lead_back(double excess_m);

  /// Acceleration along x and y of H that the model lacks at the tilt wanted now, m/s2.
  const Eigen::Vector2d& missed_mps2() const { return missed_mps2_; }
  const Eigen::MatrixXd& states() const { return states_; }  ///< 16 x (horizon + 1)
  const Eigen::MatrixXd& inputs() const { return inputs_; }  ///< 4 x horizon

 private:
  RotorcraftModel craft_;
  double period_s_;
  Eigen::MatrixXd states_, inputs_;
  Eigen::Vector2d missed_mps2_ = Eigen::Vector2d::Zero();
};

}  // namespace vinerow::controllers

#pragma once
/// The reference as states and inputs of the model: where to be, and what tilt, rates, thrust and
/// torques that takes, drag and learnt disturbances included. Feeding these forward is what keeps
/// accelerations, turns and wind from leaving an offset.
///
/// The vehicle is pushed by lift tan(tilt), lift = g plus what climbs, the model by g tilt. The
/// tilt wanted is that of the vehicle, and what the model misses there now is handed over as a
/// known acceleration; else every steady wind would leave some of the third power of the tilt.

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

  /// Ahead or behind by more than the limit of speed should take a while to win back: moves the
  /// places along x by `excess_m` now, which dies out within a second or two, and the speeds along.
  void lead_back(double excess_m);

  /// Along x and y of H, what the model misses at the tilt wanted now, m/s2.
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

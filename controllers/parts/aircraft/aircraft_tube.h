#pragma once
/// Tube MPC of a fixed-wing vehicle about steady flight: one problem for the longitudinal axis, one
/// for the lateral axis. Paper A, section 2.2; tube_sets.h and tube_mpc.h.

#include <string>
#include <vector>

#include "controllers/parts/aircraft/aircraft_ports.h"
#include "controllers/parts/aircraft/aircraft_weights.h"
#include "controllers/parts/solvers/tube_mpc.h"

namespace vinerow::controllers {

struct AircraftTubeParams {
  int horizon = 20;
  /// Largest gust along each axis of the body; 0: no tube, z_0 = x, ordinary MPC.
  double gust_mps = 1.0;
  AircraftLimits limits;
  AircraftWeights weights;
  TubeLaw law = TubeLaw::kTube;
  TubeShape shape = TubeShape::kInvariant;
  /// u = K x, row by row; empty: the gain of the LQR. SI and rad.
  std::vector<double> longitudinal_gain;  ///< 10: throttle, then elevator
  std::vector<double> lateral_gain;       ///< 5
};

/// Model, sets and MPC of one axis.
struct AxisTube {
  TubeModel model;
  TubeSets sets;
  TubeMpc mpc;
  /// Largest feasible gust along each body axis, m/s; infinite without tube.
  double largest_gust_mps = 0.0;
  /// "12 % of the limit of altitude" @pre mpc.soft_violation() > 0
  std::string describe_violation() const;
};

class AircraftTube {
 public:
  /// Linear models about the trim, sampled, then sets and problems of both axes. Takes some tenths
  /// of a second.
  /// @throws ConfigError "<who>: gusts of 2.5 m/s alone take 140 % of the limit of aileron; the
  /// largest feasible gust is 1.79 m/s (lateral)", or if a gain does not stabilise its axis
  AircraftTube(const Aircraft& aircraft, const Trim& trim, double period_s,
               const AircraftTubeParams& params, const std::string& who);

  /// Deviations of the controls from their trims. No heap.
  AircraftControls step(const AircraftDeviation& deviation);
  /// Forgets all earlier steps.
  void reset();

  const AxisTube& lon() const { return lon_; }
  const AxisTube& lat() const { return lat_; }
  /// Of the last step.
  QpStatus lon_status() const { return lon_status_; }
  QpStatus lat_status() const { return lat_status_; }

 private:
  AircraftTube(const AircraftLaws& laws, const AircraftTubeParams& params, const std::string& who);

  AxisTube lon_, lat_;
  QpStatus lon_status_ = QpStatus::kSolved, lat_status_ = QpStatus::kSolved;
};

}  // namespace vinerow::controllers

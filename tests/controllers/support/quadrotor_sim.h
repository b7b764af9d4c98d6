#pragma once
/// A plain nonlinear quadrotor for tests: rigid body, rotor lag, thrust and drag torque, the
/// rotors' momentum, drag in the wind, Runge-Kutta 4. Written without the code under test and
/// without the product's vehicle.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "engine/api/vehicle.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/plant.h"

namespace vinerow::test {

struct SimRotor {
  double x_m = 0.0, y_m = 0.0;
  double torque_sign = 1.0;  ///< +1: its drag torque turns the body to the left
};

struct QuadrotorNumbers {
  double mass_kg = 2.0;
  Eigen::Vector3d inertia_kgm2 = {0.050, 0.050, 0.0977};
  std::vector<SimRotor> rotors;
  double thrust_coefficient = 5.98e-5;  ///< N s2
  double torque_coefficient = 1.32e-6;  ///< N m s2
  double min_radps = 0.0, max_radps = 640.0;
  double lag_s = 0.05;
  double rotor_inertia_kgm2 = 3.6e-4;  ///< of each rotor about its axis
  double rotor_drag_Ns_per_m = 0.30;
  double body_drag_area_m2 = 0.04;  ///< C_d A
  double air_density_kgm3 = 1.225;
  double max_tilt_rad = rad_from_deg(25.0);
  double gravity_mps2 = 9.80665;
};

/// Paper A's Q4T with the numbers that the paper leaves open chosen. X layout.
QuadrotorNumbers make_q4t();
/// The DJI Matrice 100 of paper C, table 1; thrust by its hover rate of 580 rad/s, twice the weight
/// at most. X layout.
QuadrotorNumbers make_m100();
/// The same vehicle, turned by 45 deg on its arms: a rotor ahead.
QuadrotorNumbers with_plus_layout(QuadrotorNumbers numbers);

/// Description of the vehicle `quadrotor` with these numbers.
VehicleDescription describe(const QuadrotorNumbers& numbers);

struct QuadrotorState {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d w_B = Eigen::Vector3d::Zero();
  Eigen::VectorXd rotors_radps;
};

/// Wind in W at a time and place, m/s.
using WindField = std::function<Eigen::Vector3d(double time_s, const Eigen::Vector3d& p_W)>;

class QuadrotorSim final : public Plant {
 public:
  /// Starts at rest with the rotors off.
  explicit QuadrotorSim(QuadrotorNumbers numbers);

  QuadrotorState& state() { return state_; }
  const QuadrotorState& state() const { return state_; }
  const QuadrotorNumbers& numbers() const { return numbers_; }
  double hover_radps() const;
  void set_wind(WindField wind) { wind_ = std::move(wind); }
  /// A floor at this height: it carries the vehicle, which stands level on it. Default: none.
  void set_floor(double height_m);

  /// A torque that the controller does not know of, N m in B.
  void set_torque_bias(const Eigen::Vector3d& torque_B) { bias_B_ = torque_B; }

  /// One step. Wanted speeds are cut to the rotors' limits.
  void step(const std::vector<double>& wanted_radps, double dt_s) override;
  double time_s() const { return time_s_; }
  /// Angle between B's z axis and the vertical.
  double tilt_rad() const;
  Odometry truth() const override;

 private:
  QuadrotorState derivative(const QuadrotorState& x, const Eigen::VectorXd& wanted,
                            double time_s) const;

  QuadrotorNumbers numbers_;
  QuadrotorState state_;
  WindField wind_;
  Eigen::Vector3d bias_B_ = Eigen::Vector3d::Zero();
  double floor_m_;
  double time_s_ = 0.0;
};

}  // namespace vinerow::test

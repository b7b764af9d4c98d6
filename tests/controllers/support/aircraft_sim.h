#pragma once
/// A plain nonlinear aircraft for tests: six degrees of freedom in the signs of aviation (x
/// forward, y right, z down), coefficients of the reference of paper A, section 1, lag of motor and
/// servos, wind, Runge-Kutta 4. Written without the code under test and without the product's
/// vehicle.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <vector>

#include "engine/api/vehicle.h"
#include "tests/controllers/support/quadrotor_sim.h"

namespace vinerow::test {

/// Per rad; rates as c/2V and b/2V. Defaults: the table of the reference.
struct AircraftNumbers {
  double mass_kg = 1.2, span_m = 0.90, area_m2 = 0.27, chord_m = 0.311;
  double aspect_ratio = 3.0, oswald = 0.85;
  double jx_kgm2 = 0.031, jy_kgm2 = 0.019, jz_kgm2 = 0.048, jxz_kgm2 = 0.0005;
  double CL0 = 0.05, CLa = 3.50, CLq = 4.2, CLde = 0.806;
  double CD0 = 0.025, CDd2 = 0.15;
  double Cm0 = 0.035, Cma = -0.309, Cmq = -1.145, Cmde = -0.32;
  double CYb = -0.327, CYp = -0.145, CYr = 0.244;
  double Clb = -0.188, Clp = -0.384, Clr = 0.152, Clda = 0.194;
  double Cnb = 0.029, Cnp = -0.047, Cnr = -0.036, Cnda = -0.0095;
  /// Stall: lift goes over to a flat plate's about this angle of attack (Beard, McLain, eq. 4.9).
  double stall_rad = 0.36, stall_sharpness = 50.0;
  double propeller_area_m2 = 0.0314, motor_mps = 25.0;
  double max_elevon_rad = 25.0 * M_PI / 180.0;
  double throttle_lag_s = 0.10, elevon_lag_s = 0.04;
  double air_density_kgm3 = 1.225, gravity_mps2 = 9.80665;
  double cruise_speed_mps = 12.0, max_bank_rad = 45.0 * M_PI / 180.0;
};

AircraftNumbers make_mh900_like();
/// The same as the reference's figures come out: g = 9.81 m/s2, stall far away (Beard, McLain:
/// 0.4712 rad).
AircraftNumbers make_reference_wing();
/// The Zagi of Beard and McLain, table E.1, scaled to a span of 0.9 m: 1.2 kg on 0.104 m2.
AircraftNumbers make_scaled_zagi();

/// Velocity over ground (u, v, w) m/s and rates (p, q, r) in body axes, angles rad, position north,
/// east, down m, where the controls stand.
struct AircraftState {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d rates = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_NB = Eigen::Quaterniond::Identity();  ///< body to north, east, down
  Eigen::Vector3d p_N = Eigen::Vector3d::Zero();
  Eigen::Vector3d controls = Eigen::Vector3d::Zero();  ///< throttle, right elevon, left elevon
};

/// Force N and torque N m in body axes of aviation. @param air  (u, v, w) through the air
/// @param controls  throttle, elevator rad, aileron rad
std::pair<Eigen::Vector3d, Eigen::Vector3d> calc_aero(const AircraftNumbers& numbers,
                                                      const Eigen::Vector3d& air,
                                                      const Eigen::Vector3d& rates,
                                                      const Eigen::Vector3d& controls);

/// Description of a winged vehicle with these numbers, with a FlightModel.
VehicleDescription describe(const AircraftNumbers& numbers);

class AircraftSim final : public Plant {
 public:
  explicit AircraftSim(AircraftNumbers numbers) : numbers_(numbers) {}

  AircraftState& state() { return state_; }
  const AircraftState& state() const { return state_; }
  const AircraftNumbers& numbers() const { return numbers_; }
  /// The field returns the wind in W at a place in W.
  void set_wind(WindField wind) { wind_ = std::move(wind); }
  /// A wind in body axes of aviation beside it, as the linear models know it.
  void set_body_gust(const Eigen::Vector3d& gust) { body_gust_ = gust; }

  /// Where attitude, velocity and controls make of it: all angles of aviation.
  void start(const Eigen::Vector3d& p_W, double phi, double theta, double psi,
             const Eigen::Vector3d& velocity, const Eigen::Vector3d& rates,
             const Eigen::Vector3d& controls);
  /// One step. @param actuators  throttle, left elevon, right elevon; cut to their ranges
  void step(const std::vector<double>& actuators, double dt_s) override;
  double time_s() const { return time_s_; }
  /// (u, v, w) through the air.
  Eigen::Vector3d air_velocity() const;
  Odometry truth() const override;
  /// phi, theta, psi, rad; psi clockwise from north.
  Eigen::Vector3d angles() const;
  /// Accelerations (u, v, w, p, q, r) with the controls where they are.
  Eigen::Matrix<double, 6, 1> accelerations() const;

 private:
  struct Rate;
  Rate derivative(const AircraftState& x, const Eigen::Vector3d& wanted, double time_s) const;
  Eigen::Vector3d air_velocity(const AircraftState& x, double time_s) const;

  AircraftNumbers numbers_;
  AircraftState state_;
  WindField wind_;
  Eigen::Vector3d body_gust_ = Eigen::Vector3d::Zero();
  double time_s_ = 0.0;
};

}  // namespace vinerow::test

#pragma once
/// Rotor of fixed pitch on a motor that follows a commanded speed with a first-order lag.
///
///   dw/dt = (w_wanted - w) / lag        thrust = k_F w^2        drag torque = k_M w^2
///
/// The means of w, w^2 and w^3 over a step have closed forms, so that thrust impulse, angular
/// momentum and energy of a step are exact for any length of the step.
///
/// Signs: w >= 0 for both directions of rotation. `torque_sign` is +1 if the drag torque turns the
/// body to the left (+z of B), that is, if the rotor turns clockwise seen from above.

#include <Eigen/Core>
#include <string>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow::vehicles {

struct RotorParams {
  double thrust_coefficient_Ns2 = 5.98e-5;   ///< k_F at 1.225 kg/m3
  double torque_coefficient_Nms2 = 1.32e-6;  ///< k_M at 1.225 kg/m3
  double max_radps = 640.0;
  double rise_lag_s = 0.05;      ///< 0: no lag
  double fall_lag_s = 0.05;      ///< while the commanded speed is below the present one
  double inertia_kgm2 = 3.6e-4;  ///< about its axis: blades, hub and the motor's bell

  /// @throws ConfigError
  void validate(const std::string& who) const;
};

/// thrust_coefficient_Ns2, torque_coefficient_Nms2, max_rotor_radps, rotor_rise_lag_s,
/// rotor_fall_lag_s, rotor_inertia_kgm2
const ParameterTable<RotorParams>& rotor_table();

/// Speed of a rotor over one step.
struct SpeedCourse {
  double end_radps = 0.0;
  double mean_radps = 0.0;
  double mean_square = 0.0;  ///< mean of w^2, rad2/s2
  double mean_cube = 0.0;    ///< mean of w^3, rad3/s3
};

/// Closed form of the lag for steps of one length.
class SpeedLag {
 public:
  SpeedLag() = default;
  /// @param lag_s  >= 0  @param dt_s  > 0
  SpeedLag(double lag_s, double dt_s);

  /// @param from_radps  present speed  @param wanted_radps  commanded speed, held over the step
  SpeedCourse run(double from_radps, double wanted_radps) const;

 private:
  // Of exp(-k t / lag), k = 1, 2, 3: the value at the end, then the means over the step.
  double decay_ = 0.0, mean1_ = 0.0, mean2_ = 0.0, mean3_ = 0.0;
};

/// Lags for rising and falling speed, made once per length of the step.
struct RotorLags {
  SpeedLag rise, fall;
  RotorLags() = default;
  RotorLags(const RotorParams& rotor, double dt_s)
      : rise(rotor.rise_lag_s, dt_s), fall(rotor.fall_lag_s, dt_s) {}
  SpeedCourse run(double from_radps, double wanted_radps) const {
    return (wanted_radps >= from_radps ? rise : fall).run(from_radps, wanted_radps);
  }
};

/// Air forces at a hub, proportional to the velocity of the air and to the rotor's speed.
///
/// Across the axis ("rotor drag", H force): advancing blades meet faster air than retreating ones
/// and flap back. Along it ("inflow"): climbing lowers the blades' angle of attack; since the hubs
/// move up and down in a roll, it also damps roll and pitch. Both are linear in w times the
/// velocity of the air. Source: Martin, Salaun, "The true role of accelerometer feedback in
/// quadrotor control", ICRA 2010, eq. 1; Faessler, Franchi, Scaramuzza, IEEE RA-L 3(2), 2018.
struct RotorAir {
  double across_Ns2_per_m = 0.0;  ///< force across the axis / (air velocity * w)
  double along_Ns2_per_m = 0.0;   ///< force along the axis / (air velocity * w)

  /// @param air_B  velocity of the air relative to the hub, m/s; z along the axis
  Eigen::Vector3d force_B(double speed_radps, const Eigen::Vector3d& air_B) const {
    return {across_Ns2_per_m * speed_radps * air_B.x(), across_Ns2_per_m * speed_radps * air_B.y(),
            along_Ns2_per_m * speed_radps * air_B.z()};
  }
};

}  // namespace vinerow::vehicles

#pragma once
/// A rotor of fixed pitch on a motor that follows a wanted speed with a first-order lag.
///
///   dw/dt = (w_wanted - w) / lag        thrust = k_F w^2        drag torque = k_M w^2
///
/// The course of w over a step is known in closed form, and with it the means of w, w^2 and w^3:
/// thrust impulse, angular momentum and energy of a step are exact for any length of the step.
///
/// Signs: w >= 0 whatever way the rotor turns; `torque_sign` +1 where its drag torque turns the
/// body to the left (+z of B), so the rotor itself turns clockwise seen from above.

#include <Eigen/Core>
#include <string>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow::vehicles {

struct RotorParams {
  double thrust_coefficient_Ns2 = 5.98e-5;   ///< k_F at 1.225 kg/m3
  double torque_coefficient_Nms2 = 1.32e-6;  ///< k_M at 1.225 kg/m3
  double max_radps = 640.0;
  double rise_lag_s = 0.05;      ///< 0: at once
  double fall_lag_s = 0.05;      ///< while the wanted speed is below the present one
  double inertia_kgm2 = 3.6e-4;  ///< about its axis: blades, hub and the motor's bell

  /// @throws ConfigError
  void validate(const std::string& who) const;
};

/// thrust_coefficient_Ns2, torque_coefficient_Nms2, max_rotor_radps, rotor_rise_lag_s,
/// rotor_fall_lag_s, rotor_inertia_kgm2
const ParameterTable<RotorParams>& rotor_table();

/// What a rotor's speed does in one step.
struct SpeedCourse {
  double end_radps = 0.0;
  double mean_radps = 0.0;
  double mean_square = 0.0;  ///< of w^2, rad2/s2
  double mean_cube = 0.0;    ///< of w^3, rad3/s3
};

/// The lag's closed form for steps of one length.
class SpeedLag {
 public:
  SpeedLag() = default;
  /// @param lag_s  >= 0  @param dt_s  > 0
  SpeedLag(double lag_s, double dt_s);

  /// @param from_radps  speed now  @param wanted_radps  held over the step
  SpeedCourse run(double from_radps, double wanted_radps) const;

 private:
  // Of exp(-k t / lag), k = 1, 2, 3: the value at the end, then the means over the step.
  double decay_ = 0.0, mean1_ = 0.0, mean2_ = 0.0, mean3_ = 0.0;
};

/// A pair of lags; made once per length of the step.
struct RotorLags {
  SpeedLag rise, fall;
  RotorLags() = default;
  RotorLags(const RotorParams& rotor, double dt_s)
      : rise(rotor.rise_lag_s, dt_s), fall(rotor.fall_lag_s, dt_s) {}
  SpeedCourse run(double from_radps, double wanted_radps) const {
    return (wanted_radps >= from_radps ? rise : fall).run(from_radps, wanted_radps);
  }
};

/// Air forces at a hub that grow with speed through the air, in proportion to the rotor's speed.
///
/// Across the axis ("rotor drag", H force): blades that advance meet faster air than those that
/// retreat, and flap back. Along it ("inflow"): climbing lowers the blades' angle of attack; as the
/// hubs move up and down in a roll, it also damps roll and pitch. Both are linear in w times the
/// air's velocity. Source: Martin, Salaun, "The true role of accelerometer feedback in quadrotor
/// control", ICRA 2010, eq. 1; Faessler, Franchi, Scaramuzza, IEEE RA-L 3(2), 2018.
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

#include "controllers/quadrotor_pid/quadrotor_pid.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/rotorcraft/flight_limits.h"
#include "controllers/parts/rotorcraft/flight_ports.h"
#include "controllers/quadrotor_pid/attitude_law.h"
#include "controllers/quadrotor_pid/position_law.h"
#include "controllers/quadrotor_pid/rate_law.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

/// Parameters as in files; the loops share the limits.
struct QuadrotorPidParams {
  PositionParams position;
  AttitudeParams attitude;
  RateParams rate;
  FlightLimitParams limits;
};

const ParameterTable<QuadrotorPidParams>& quadrotor_pid_table() {
  using P = QuadrotorPidParams;
  const auto position = [](auto member) { return inside(&P::position, member); };
  const auto attitude = [](auto member) { return inside(&P::attitude, member); };
  const auto rate = [](auto member) { return inside(&P::rate, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .numbers("position_p", "1/s", position(&PositionParams::position_p_per_s), kNotNegative,
                   "wanted speed per position error: horizontal, vertical")
          .numbers("velocity_p", "1/s", position(&PositionParams::velocity_p_per_s), kNotNegative,
                   "acceleration per speed error: horizontal, vertical")
          .numbers("velocity_i", "1/s2", position(&PositionParams::velocity_i_per_s2), kNotNegative,
                   "acceleration per integrated speed error: horizontal, vertical")
          .numbers("velocity_d", "", position(&PositionParams::velocity_d), kNotNegative,
                   "acceleration per measured acceleration: horizontal, vertical")
          .number("velocity_filter_s", "s", position(&PositionParams::velocity_filter_s), kPositive,
                  "low pass of the measured acceleration")
          .number("tilt_p", "1/s", attitude(&AttitudeParams::tilt_p_per_s), kPositive,
                  "tilt rate per tilt error")
          .number("yaw_p", "1/s", attitude(&AttitudeParams::yaw_p_per_s), kPositive,
                  "yaw rate per yaw error")
          .number("tilt_rate_limit_degps", "deg/s",
                  attitude(&AttitudeParams::tilt_rate_limit_radps), kPositive,
                  "largest wanted tilt rate", kDegrees)
          .numbers("rate_p", "1/s", rate(&RateParams::p_per_s), kNotNegative,
                   "angular acceleration per rate error: roll and pitch, yaw")
          .numbers("rate_i", "1/s2", rate(&RateParams::i_per_s2), kNotNegative,
                   "angular acceleration per integrated rate error: roll and pitch, yaw")
          .numbers("rate_d", "", rate(&RateParams::d), kNotNegative,
                   "angular acceleration per measured angular acceleration: roll and pitch, yaw")
          .number("rate_filter_s", "s", rate(&RateParams::filter_s), kPositive,
                  "low pass of the measured angular acceleration")
          .include(&P::limits, flight_limit_table());
  return table;
}

PositionParams limit(PositionParams params, const FlightLimits& limits, Duration period) {
  params.correction_speed_mps = {limits.correction_mps, limits.climb_correction_mps};
  params.tilt_limit_rad = limits.tilt_rad;
  params.min_thrust_N = limits.min_thrust_N;
  params.max_thrust_N = limits.max_thrust_N;
  params.period_s = period.s();
  return params;
}

AttitudeParams limit(AttitudeParams params, const FlightLimits& limits) {
  params.yaw_rate_limit_radps = limits.yaw_rate_radps;
  return params;
}

RateParams limit(RateParams params, const FlightLimits& limits, Duration period) {
  params.torque_limits_Nm = limits.torque_Nm;
  params.period_s = period.s();
  return params;
}

class QuadrotorPid final : public Controller {
 public:
  QuadrotorPid(const QuadrotorPidParams& params, const ControllerContext& context)
      : ports_(context, "quadrotor_pid"),
        limits_(make_flight_limits(params.limits, ports_.craft(), ports_.mixer())),
        position_(ports_.craft(), limit(params.position, limits_, context.period)),
        attitude_(limit(params.attitude, limits_)),
        rate_(ports_.craft(), limit(params.rate, limits_, context.period)) {}

  void connect(Ports& ports) override { ports_.connect(ports); }

  void step(Time now) override {
    if (!ports_.is_flying()) {
      reset();
      ports_.write_off(now);
      return;
    }
    const TrajectoryPoint at = ports_.reference_at(now);
    const Odometry& odometry = ports_.estimate();
    const Eigen::Quaterniond& q_WB = odometry.X_WB.q;
    const bool integrate = ports_.has_lifted_off();

    const Eigen::Vector3d F_W =
        position_.step(at, odometry.X_WB.p, q_WB * odometry.v_WB_B, lost_.thrust_N, integrate);
    const Eigen::Quaterniond wanted_q = calc_wanted_attitude(F_W, at.yaw_rad);
    const Eigen::Vector3d rates = calc_wanted_rates(q_WB, wanted_q, at.yaw_rate_radps, attitude_);
    Wrench wanted;
    wanted.thrust_N = thrust_for(F_W, (q_WB * Eigen::Vector3d::UnitZ()).z());
    wanted.torque_B = rate_.step(rates, odometry.w_WB_B, lost_.torque_B, integrate);
    const Wrench reached = ports_.write(now, wanted);
    lost_ = {wanted.thrust_N - reached.thrust_N, wanted.torque_B - reached.torque_B};
  }

  bool finished() const override { return ports_.has_ended(); }

 private:
  /// Thrust that keeps the vertical part of the force at the present tilt.
  double thrust_for(const Eigen::Vector3d& F_W, double upright) const {
    const double min_upright = std::cos(limits_.tilt_rad);
    return std::clamp(F_W.z() / std::max(upright, min_upright), limits_.min_thrust_N,
                      limits_.max_thrust_N);
  }

  void reset() {
    position_.reset();
    rate_.reset();
    lost_ = {};
  }

  FlightPorts ports_;
  FlightLimits limits_;
  PositionLaw position_;
  AttitudeParams attitude_;
  RateLaw rate_;
  Wrench lost_;  ///< wanted minus reached, last cycle
};

}  // namespace

PartSpec quadrotor_pid_spec() {
  PartSpec spec;
  spec.name = "quadrotor_pid";
  spec.description =
      "Cascade of position P, velocity PID, attitude (tilt before yaw, Brescianini, Hehn, D'Andrea "
      "2013) and rate PID for rotorcraft, with feed-forward of the reference's velocity, "
      "acceleration and yaw rate.";
  quadrotor_pid_table().add_to(spec);
  spec.default_rate_Hz = 250.0;
  spec.reads = {"estimate", "reference"};
  spec.writes = {"actuators", "wrench", "follower"};
  return spec;
}

std::unique_ptr<Controller> make_quadrotor_pid(const ParameterSet& parameters,
                                               const ControllerContext& context) {
  return std::make_unique<QuadrotorPid>(
      quadrotor_pid_table().read(parameters, context.part + " (quadrotor_pid)"), context);
}

}  // namespace vinerow::controllers

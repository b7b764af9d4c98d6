#include "controllers/quadrotor_pid/quadrotor_pid.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/flight_limits.h"
#include "controllers/parts/flight_ports.h"
#include "controllers/quadrotor_pid/attitude_law.h"
#include "controllers/quadrotor_pid/position_law.h"
#include "controllers/quadrotor_pid/rate_law.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

Eigen::Vector2d read_pair(const ParameterSet& parameters, const char* name) {
  const std::vector<double>& values = parameters.numbers(name);
  return {values[0], values[1]};
}

PositionParams read_position(const ParameterSet& parameters, const FlightLimits& limits,
                             Duration period) {
  PositionParams params;
  params.position_p_per_s = read_pair(parameters, "position_p");
  params.velocity_p_per_s = read_pair(parameters, "velocity_p");
  params.velocity_i_per_s2 = read_pair(parameters, "velocity_i");
  params.velocity_d = read_pair(parameters, "velocity_d");
  params.velocity_filter_s = parameters.number("velocity_filter_s");
  params.correction_speed_mps = {limits.correction_mps, limits.climb_correction_mps};
  params.tilt_limit_rad = limits.tilt_rad;
  params.min_thrust_N = limits.min_thrust_N;
  params.max_thrust_N = limits.max_thrust_N;
  params.period_s = period.s();
  return params;
}

AttitudeParams read_attitude(const ParameterSet& parameters, const FlightLimits& limits) {
  AttitudeParams params;
  params.tilt_p_per_s = parameters.number("tilt_p");
  params.yaw_p_per_s = parameters.number("yaw_p");
  params.tilt_rate_limit_radps = rad_from_deg(parameters.number("tilt_rate_limit_degps"));
  params.yaw_rate_limit_radps = limits.yaw_rate_radps;
  return params;
}

RateParams read_rate(const ParameterSet& parameters, const FlightLimits& limits, Duration period) {
  RateParams params;
  params.p_per_s = read_pair(parameters, "rate_p");
  params.i_per_s2 = read_pair(parameters, "rate_i");
  params.d = read_pair(parameters, "rate_d");
  params.filter_s = parameters.number("rate_filter_s");
  params.torque_limits_Nm = limits.torque_Nm;
  params.period_s = period.s();
  return params;
}

class QuadrotorPid final : public Controller {
 public:
  QuadrotorPid(const ParameterSet& parameters, const ControllerContext& context)
      : ports_(context, "quadrotor_pid"),
        limits_(read_flight_limits(parameters, ports_.craft(), ports_.mixer())),
        position_(ports_.craft(), read_position(parameters, limits_, context.period)),
        attitude_(read_attitude(parameters, limits_)),
        rate_(ports_.craft(), read_rate(parameters, limits_, context.period)) {}

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
  /// Keeps the vertical part of the force at the tilt that there is.
  double thrust_for(const Eigen::Vector3d& F_W, double upright) const {
    const double least = std::cos(limits_.tilt_rad);
    return std::clamp(F_W.z() / std::max(upright, least), limits_.min_thrust_N,
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
  Wrench lost_;  ///< wanted less reached, last cycle
};

}  // namespace

PartSpec quadrotor_pid_spec() {
  const PositionParams position;
  const AttitudeParams attitude;
  const RateParams rate;
  const auto pair = [](const char* name, const char* unit, const Eigen::Vector2d& values,
                       const char* description) {
    ParameterSpec spec =
        number_list_parameter(name, unit, {values.x(), values.y()}, description, 2);
    spec.min = 0.0;
    return spec;
  };
  PartSpec spec;
  spec.name = "quadrotor_pid";
  spec.description =
      "Cascade of position P, velocity PID, attitude (tilt before yaw, Brescianini, Hehn, D'Andrea "
      "2013) and rate PID for rotorcraft, with the reference's velocity, acceleration and yaw rate "
      "fed forward.";
  spec.parameters = {
      pair("position_p", "1/s", position.position_p_per_s,
           "wanted speed per position error: horizontal, vertical"),
      pair("velocity_p", "1/s", position.velocity_p_per_s,
           "acceleration per speed error: horizontal, vertical"),
      pair("velocity_i", "1/s2", position.velocity_i_per_s2,
           "acceleration per integrated speed error: horizontal, vertical"),
      pair("velocity_d", "", position.velocity_d,
           "acceleration per measured acceleration: horizontal, vertical"),
      positive_parameter("velocity_filter_s", "s", position.velocity_filter_s,
                         "low pass of the measured acceleration"),
      positive_parameter("tilt_p", "1/s", attitude.tilt_p_per_s, "tilt rate per tilt error"),
      positive_parameter("yaw_p", "1/s", attitude.yaw_p_per_s, "yaw rate per yaw error"),
      positive_parameter("tilt_rate_limit_degps", "deg/s", 220.0, "largest wanted tilt rate"),
      pair("rate_p", "1/s", rate.p_per_s,
           "angular acceleration per rate error: roll and pitch, yaw"),
      pair("rate_i", "1/s2", rate.i_per_s2,
           "angular acceleration per integrated rate error: roll and pitch, yaw"),
      pair("rate_d", "", rate.d,
           "angular acceleration per measured angular acceleration: roll and pitch, yaw"),
      positive_parameter("rate_filter_s", "s", rate.filter_s,
                         "low pass of the measured angular acceleration"),
  };
  for (ParameterSpec& limit : flight_limit_parameters()) spec.parameters.push_back(limit);
  spec.default_rate_Hz = 250.0;
  spec.reads = {"estimate", "reference"};
  spec.writes = {"actuators", "wrench", "follower"};
  return spec;
}

std::unique_ptr<Controller> make_quadrotor_pid(const ParameterSet& parameters,
                                               const ControllerContext& context) {
  return std::make_unique<QuadrotorPid>(parameters, context);
}

}  // namespace vinerow

#include "engine/sensors/wheel_odometry.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "engine/api/messages/motion.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/math/pose.h"
#include "engine/sensors/encoder_errors.h"
#include "engine/sensors/reading_sensor.h"
#include "engine/sensors/wheel_motion.h"

namespace vinerow::sensors {
namespace {

/// Defaults chosen: radii equal to 0.2 %, track known to 1 %.
struct WheelOdometryParams {
  EncoderErrors encoders;
  double radius_error_std = 0.002;
  double track_error_std = 0.01;
};

const ParameterTable<WheelOdometryParams>& wheel_odometry_table() {
  using P = WheelOdometryParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .include(&P::encoders, encoder_errors_table())
          .number("radius_error_std", "", &P::radius_error_std, between(0.0, 0.2),
                  "relative error of each wheel's assumed radius, drawn once per run")
          .number("track_error_std", "", &P::track_error_std, between(0.0, 0.2),
                  "relative error of the assumed track of a skid-steered vehicle, drawn once per "
                  "run");
  return table;
}

Eigen::Quaterniond turned_by(double yaw_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
}

class WheelOdometry final : public ReadingSensor<DeadReckoning> {
 public:
  WheelOdometry(const ParameterSet& parameters, const SensorContext& context)
      : WheelOdometry(wheel_odometry_table().read(parameters, context.part), parameters, context) {}
  WheelOdometry(const WheelOdometryParams& params, const ParameterSet& parameters,
                const SensorContext& context)
      : ReadingSensor(parameters, context),
        vehicle_(context.vehicle_truth),
        motion_(vehicle_->description(), context.part),
        period_s_(context.period.s()),
        random_(context.random()) {
    const VehicleDescription& about = vehicle_->description();
    if (vehicle_->actuator_states().size() != about.actuators.size()) {
      throw ConfigError(
          fmt::format("{}: wheel odometry needs the states of the actuators, which vehicle type "
                      "'{}' does not have",
                      context.part, about.type));
    }
    for (const ActuatorSpec& actuator : about.actuators) {
      const EncoderErrors& errors = params.encoders;
      channels_.push_back(actuator.unit == "rad" ? errors.angle : errors.speed);
      stds_.push_back(channels_.back().std());
    }
    read_.assign(channels_.size(), 0.0);
    for (std::size_t i = 0; i < motion_.wheels().size(); ++i) {
      radii_m_.push_back(motion_.radius_m() * (1.0 + params.radius_error_std * random_.normal()));
    }
    track_scale_ = 1.0 + params.track_error_std * random_.normal();
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    ReadingSensor::connect(ports);
  }

  void step(Time now) override {
    const std::span<const double> states = vehicle_->actuator_states();
    for (std::size_t i = 0; i < read_.size(); ++i) {
      read_[i] = channels_[i].read(states[i], random_);
    }
    const PlanarTwist twist = motion_.solve(read_, radii_m_, track_scale_);
    if (has_started_) {
      advance(twist);
    } else {
      start();
    }
    last_ = twist;
    readings_.push_or_silence(now, reading_of(twist), true_motion());
  }

 private:
  void start() {
    const Pose& X_WB = truth_.value().X_WB;
    X_OW_ = Pose{turned_by(yaw_from_quaternion(X_WB.q)), X_WB.p}.inverse();
    has_started_ = true;
  }

  /// Along the arc of the mean twist since the last tick: by its chord, in the direction of the
  /// heading half way.
  void advance(const PlanarTwist& twist) {
    const double half_rad = 0.25 * period_s_ * (last_.yaw_rate_radps + twist.yaw_rate_radps);
    const Eigen::Vector2d arc_m = 0.5 * period_s_ * (last_.v_mps + twist.v_mps);
    const Eigen::Rotation2Dd R_OB(yaw_rad_ + half_rad);
    p_O_ += chord_per_arc(half_rad) * (R_OB.toRotationMatrix() * arc_m);
    yaw_rad_ += 2.0 * half_rad;
  }

  DeadReckoning reading_of(const PlanarTwist& twist) {
    DeadReckoning reading;
    reading.X_OB = {turned_by(yaw_rad_), {p_O_.x(), p_O_.y(), 0.0}};
    reading.v_OB_B = {twist.v_mps.x(), twist.v_mps.y(), 0.0};
    reading.w_OB_B = {0.0, 0.0, twist.yaw_rate_radps};
    const Eigen::Vector2d std = motion_.calc_std(read_, stds_, scratch_);
    // Sideways and upwards it reads nothing, so it cannot be better there than forwards.
    reading.velocity_std_mps.setConstant(std[0]);
    reading.yaw_rate_std_radps = std[1];
    return reading;
  }

  DeadReckoning true_motion() const {
    const Odometry& body = truth_.value();
    DeadReckoning truth;
    truth.X_OB = X_OW_ * body.X_WB;
    truth.v_OB_B = body.v_WB_B;
    truth.w_OB_B = body.w_WB_B;
    return truth;
  }

  const Vehicle* vehicle_;
  WheelMotion motion_;
  double period_s_;
  RandomStream random_;
  std::vector<EncoderChannel> channels_;  ///< per actuator
  std::vector<double> stds_;              ///< of each actuator's reading
  std::vector<double> read_;              ///< of each actuator, now
  std::vector<double> scratch_;
  std::vector<double> radii_m_;  ///< as assumed, per wheel
  double track_scale_ = 1.0;
  SignalReader<Odometry> truth_;
  bool has_started_ = false;
  Pose X_OW_;
  Eigen::Vector2d p_O_ = {0, 0};
  double yaw_rad_ = 0.0;
  PlanarTwist last_;
};

}  // namespace

PartSpec wheel_odometry_spec() {
  PartSpec spec = reading_sensor_spec<DeadReckoning>(
      "wheel_odometry",
      "Pose since the start and motion by dead reckoning from wheel speeds and steering angles",
      50.0, wheel_odometry_table());
  spec.reads = {"truth"};
  return spec;
}

std::unique_ptr<Sensor> make_wheel_odometry(const ParameterSet& parameters,
                                            const SensorContext& context) {
  return std::make_unique<WheelOdometry>(parameters, context);
}

}  // namespace vinerow::sensors

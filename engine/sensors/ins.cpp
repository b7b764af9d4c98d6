#include "engine/sensors/ins.h"

#include <cmath>

#include "engine/math/angles.h"
#include "engine/sensors/gauss_markov.h"
#include "engine/sensors/reading_sensor.h"

namespace vinerow {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Three independent errors, partly white and partly Gauss-Markov.
class MixedError {
 public:
  /// @param std  of the whole, each component
  /// @param quantity  "position" for position_white_share and position_time_s
  MixedError(const Vector3d& std, const std::string& quantity, const ParameterSet& parameters,
             const SensorContext& context)
      : random_(context.random(quantity)) {
    const double white_share = parameters.number(quantity + "_white_share");
    const double time_s = parameters.number(quantity + "_time_s");
    white_std_ = std::sqrt(white_share) * std;
    for (int i = 0; i < 3; ++i) {
      slow_[i] = GaussMarkov(std::sqrt(1.0 - white_share) * std[i], time_s, context.period.s());
      slow_[i].start(random_);
    }
  }

  Vector3d draw() {
    Vector3d error;
    for (int i = 0; i < 3; ++i) {
      error[i] = slow_[i].step(random_) + white_std_[i] * random_.normal();
    }
    return error;
  }

 private:
  RandomStream random_;
  Vector3d white_std_;
  std::array<GaussMarkov, 3> slow_;
};

Quaterniond turn_by(const Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle == 0.0) return Quaterniond::Identity();
  return Quaterniond(Eigen::AngleAxisd(angle, rotation / angle));
}

class Ins final : public ReadingSensor<Odometry> {
 public:
  Ins(const ParameterSet& parameters, const SensorContext& context)
      : ReadingSensor(parameters, context),
        position_std_m_(parameters.number("horizontal_std_m"),
                        parameters.number("horizontal_std_m"), parameters.number("vertical_std_m")),
        attitude_std_rad_(rad_from_deg(parameters.number("roll_pitch_std_deg")),
                          rad_from_deg(parameters.number("roll_pitch_std_deg")),
                          rad_from_deg(parameters.number("yaw_std_deg"))),
        rate_std_radps_(rad_from_deg(parameters.number("rate_noise_dps_rtHz")) /
                        std::sqrt(context.period.s())),
        position_(position_std_m_, "position", parameters, context),
        velocity_(Vector3d::Constant(parameters.number("velocity_std_mps")), "velocity", parameters,
                  context),
        attitude_(attitude_std_rad_, "attitude", parameters, context),
        rate_random_(context.random("rate")) {}

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    ReadingSensor::connect(ports);
  }

  void step(Time now) override {
    const Odometry& truth = truth_.value();
    Odometry reading;
    reading.X_WB.p = truth.X_WB.p + position_.draw();
    reading.X_WB.q = (turn_by(attitude_.draw()) * truth.X_WB.q).normalized();
    const Vector3d v_W = truth.X_WB.q * truth.v_WB_B + velocity_.draw();
    reading.v_WB_B = reading.X_WB.q.conjugate() * v_W;
    for (int i = 0; i < 3; ++i) {
      reading.w_WB_B[i] = truth.w_WB_B[i] + rate_std_radps_ * rate_random_.normal();
    }
    reading.position_variance_m2 = position_std_m_.cwiseAbs2();
    reading.yaw_std_rad = attitude_std_rad_.z();
    readings_.push_or_silence(now, reading, truth);
  }

 private:
  Vector3d position_std_m_;
  Vector3d attitude_std_rad_;
  double rate_std_radps_;
  MixedError position_, velocity_, attitude_;
  RandomStream rate_random_;
  SignalReader<Odometry> truth_;
};

void add_error(const std::string& quantity, double white_share, double time_s,
               std::vector<ParameterSpec>& parameters) {
  parameters.push_back(number_parameter(quantity + "_white_share", "", white_share, 0.0, 1.0,
                                        "share of its variance that is fresh at every reading"));
  parameters.push_back(number_parameter(quantity + "_time_s", "s", time_s, 0.0, 1e5,
                                        "correlation time of the rest; 0: white as well"));
}

}  // namespace

PartSpec ins_spec() {
  // Defaults: paper C, table 2 (VectorNav VN-200); see assets/sensors/vn200_ins.yaml.
  std::vector<ParameterSpec> list;
  const auto add = [&](const char* name, const char* unit, double value, const char* text) {
    list.push_back(number_parameter(name, unit, value, 0.0, 1e3, text));
  };
  add("horizontal_std_m", "m", 1.0, "1 sigma of the position to the east and to the north, each");
  add("vertical_std_m", "m", 1.5, "1 sigma of the height");
  add_error("position", 0.0, 60.0, list);
  add("velocity_std_mps", "m/s", 0.05, "1 sigma of each component of the velocity in W");
  add_error("velocity", 0.0, 5.0, list);
  add("roll_pitch_std_deg", "deg", 0.03, "1 sigma of roll and of pitch");
  add("yaw_std_deg", "deg", 0.2, "1 sigma of yaw");
  add_error("attitude", 0.0, 60.0, list);
  add("rate_noise_dps_rtHz", "deg/s/sqrt(Hz)", 0.0035, "white noise density of the angular rate");
  PartSpec spec = reading_sensor_spec<Odometry>(
      "ins",
      "Aided inertial unit as a black box: pose and velocity with the errors of its data sheet",
      100.0, std::move(list));
  spec.reads = {"truth"};
  return spec;
}

std::unique_ptr<Sensor> make_ins(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Ins>(parameters, context);
}

}  // namespace vinerow

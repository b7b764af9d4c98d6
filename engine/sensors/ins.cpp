#include "engine/sensors/ins.h"

#include <cmath>

#include "engine/math/angles.h"
#include "engine/sensors/gauss_markov.h"
#include "engine/sensors/reading_sensor.h"

namespace vinerow::sensors {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

struct MixedErrorParams {
  double white_share = 0.0;  ///< share of the variance
  double time_s = 60.0;      ///< correlation time of the rest, 0: white as well
};

const ParameterTable<MixedErrorParams>& mixed_error_table() {
  using P = MixedErrorParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("white_share", "", &P::white_share, between(0.0, 1.0),
                  "share of the variance that is new at every reading")
          .number("time_s", "s", &P::time_s, between(0.0, 1e5),
                  "correlation time of the rest; 0: white as well");
  return table;
}

/// Defaults: paper C, table 2 (VectorNav VN-200); see assets/sensors/vn200_ins.yaml.
struct InsParams {
  double horizontal_std_m = 1.0;
  double vertical_std_m = 1.5;
  MixedErrorParams position{0.0, 60.0};
  double velocity_std_mps = 0.05;
  MixedErrorParams velocity{0.0, 5.0};
  double roll_pitch_std_rad = rad_from_deg(0.03);
  double yaw_std_rad = rad_from_deg(0.2);
  MixedErrorParams attitude{0.0, 60.0};
  double rate_noise_radps_rtHz = rad_from_deg(0.0035);
};

const ParameterTable<InsParams>& ins_table() {
  using P = InsParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("horizontal_std_m", "m", &P::horizontal_std_m, between(0.0, 1e3),
                  "1 sigma of the position, east and north each")
          .number("vertical_std_m", "m", &P::vertical_std_m, between(0.0, 1e3),
                  "1 sigma of the height")
          .include(&P::position, mixed_error_table(), {.prefix = "position_"})
          .number("velocity_std_mps", "m/s", &P::velocity_std_mps, between(0.0, 1e3),
                  "1 sigma of each component of the velocity in W")
          .include(&P::velocity, mixed_error_table(), {.prefix = "velocity_"})
          .degrees("roll_pitch_std_deg", &P::roll_pitch_std_rad, between(0.0, 1e3),
                   "1 sigma of roll and of pitch")
          .degrees("yaw_std_deg", &P::yaw_std_rad, between(0.0, 1e3), "1 sigma of yaw")
          .include(&P::attitude, mixed_error_table(), {.prefix = "attitude_"})
          .number("rate_noise_dps_rtHz", "deg/s/sqrt(Hz)", &P::rate_noise_radps_rtHz,
                  between(0.0, 1e3), "white noise density of the angular rate", kDegrees);
  return table;
}

/// Error vector with three independent components, partly white and partly Gauss-Markov.
class MixedError {
 public:
  /// @param std  of each component, both parts together
  /// @param quantity  name of its random stream
  MixedError(const Vector3d& std, const MixedErrorParams& params, const std::string& quantity,
             const SensorContext& context)
      : random_(context.random(quantity)) {
    white_std_ = std::sqrt(params.white_share) * std;
    for (int i = 0; i < 3; ++i) {
      slow_[i] = GaussMarkov(std::sqrt(1.0 - params.white_share) * std[i], params.time_s,
                             context.period.s());
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
      : Ins(ins_table().read(parameters, context.part), parameters, context) {}
  Ins(const InsParams& params, const ParameterSet& parameters, const SensorContext& context)
      : ReadingSensor(parameters, context),
        position_std_m_(params.horizontal_std_m, params.horizontal_std_m, params.vertical_std_m),
        attitude_std_rad_(params.roll_pitch_std_rad, params.roll_pitch_std_rad, params.yaw_std_rad),
        rate_std_radps_(params.rate_noise_radps_rtHz / std::sqrt(context.period.s())),
        position_(position_std_m_, params.position, "position", context),
        velocity_(Vector3d::Constant(params.velocity_std_mps), params.velocity, "velocity",
                  context),
        attitude_(attitude_std_rad_, params.attitude, "attitude", context),
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

}  // namespace

PartSpec ins_spec() {
  PartSpec spec = reading_sensor_spec<Odometry>(
      "ins",
      "Aided inertial unit as a black box: pose and velocity with the errors of its data sheet",
      100.0, ins_table());
  spec.reads = {"truth"};
  return spec;
}

std::unique_ptr<Sensor> make_ins(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Ins>(parameters, context);
}

}  // namespace vinerow::sensors

#include "engine/sensors/imu.h"

#include <cmath>

#include "engine/math/angles.h"
#include "engine/sensors/delay_line.h"
#include "engine/sensors/mounting.h"

namespace vinerow {
namespace {

/// Noise of one triad.
struct TriadNoise {
  double white_std = 0.0;  // per sample
  double walk_std = 0.0;   // bias change per sample
  double range = 0.0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();

  Eigen::Vector3d corrupt(const Eigen::Vector3d& truth, RandomStream& random) {
    Eigen::Vector3d reading;
    for (int axis = 0; axis < 3; ++axis) {
      bias[axis] += walk_std * random.normal();
      reading[axis] =
          std::clamp(truth[axis] + bias[axis] + white_std * random.normal(), -range, range);
    }
    return reading;
  }
};

class Imu final : public Sensor {
 public:
  Imu(const ParameterSet& parameters, const SensorContext& context)
      : name_(context.name),
        vehicle_(context.vehicle_truth),
        X_BS_(mounting_pose(parameters)),
        line_(delay_of(parameters), context.period),
        random_(context.random()),
        period_s_(context.period.s()) {
    const double root_period = std::sqrt(period_s_);
    gyro_.white_std = rad_from_deg(parameters.number("gyro_noise_dps_rtHz")) / root_period;
    gyro_.walk_std = rad_from_deg(parameters.number("gyro_walk_dps2_rtHz")) * root_period;
    gyro_.range = rad_from_deg(parameters.number("gyro_range_dps"));
    accelerometer_.white_std = parameters.number("accel_noise_mps2_rtHz") / root_period;
    accelerometer_.walk_std = parameters.number("accel_walk_mps3_rtHz") * root_period;
    accelerometer_.range = parameters.number("accel_range_mps2");
    for (int axis = 0; axis < 3; ++axis) {
      gyro_.bias[axis] = rad_from_deg(parameters.number("gyro_bias_std_dps")) * random_.normal();
      accelerometer_.bias[axis] = parameters.number("accel_bias_std_mps2") * random_.normal();
    }
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    out_ = ports.write<ImuSample>(name_);
  }
  Duration delay() const override { return line_.delay(); }
  std::optional<Pose> mounting_X_BS() const override { return X_BS_; }
  void deliver(Time) override { line_.deliver(out_); }

  void step(Time now) override {
    const Eigen::Vector3d& w_B = truth_.value().w_WB_B;
    // Lever arm: the angular acceleration is the mean over the sensor's own period.
    const Eigen::Vector3d alpha_B =
        has_last_ ? Eigen::Vector3d((w_B - last_w_B_) / period_s_) : Eigen::Vector3d::Zero();
    last_w_B_ = w_B;
    has_last_ = true;
    const Eigen::Vector3d f_S_B =
        vehicle_->specific_force_B() + alpha_B.cross(X_BS_.p) + w_B.cross(w_B.cross(X_BS_.p));
    const Eigen::Quaterniond q_SB = X_BS_.q.conjugate();
    ImuSample sample;
    sample.w_WS_S = gyro_.corrupt(q_SB * w_B, random_);
    sample.f_WS_S = accelerometer_.corrupt(q_SB * f_S_B, random_);
    line_.push(now, sample, out_);
  }

 private:
  std::string name_;
  const Vehicle* vehicle_;
  Pose X_BS_;
  DelayLine<ImuSample> line_;
  RandomStream random_;
  double period_s_;
  TriadNoise gyro_;
  TriadNoise accelerometer_;
  Eigen::Vector3d last_w_B_ = Eigen::Vector3d::Zero();
  bool has_last_ = false;
  SignalReader<Odometry> truth_;
  SignalWriter<ImuSample> out_;
};

}  // namespace

PartSpec imu_spec() {
  PartSpec spec;
  spec.name = "imu";
  spec.description =
      "Rate gyro and accelerometer with white noise, bias, bias random walk and saturation";
  spec.default_rate_Hz = 100.0;
  // Defaults: VectorNav VN-100/VN-200 data sheet (gyro 0.0035 deg/s/rtHz, accelerometer 0.14
  // mg/rtHz).
  spec.parameters = mounting_parameters({0.0, 0.0, 0.0});
  spec.parameters.push_back(number_parameter("gyro_noise_dps_rtHz", "deg/s/sqrt(Hz)", 0.0035, 0.0,
                                             10.0, "white noise density of the rate gyro"));
  spec.parameters.push_back(number_parameter("gyro_bias_std_dps", "deg/s", 0.0, 0.0, 100.0,
                                             "constant bias, drawn once per run and axis"));
  spec.parameters.push_back(number_parameter("gyro_walk_dps2_rtHz", "deg/s2/sqrt(Hz)", 0.0, 0.0,
                                             10.0, "random walk of the gyro bias"));
  spec.parameters.push_back(
      positive_parameter("gyro_range_dps", "deg/s", 2000.0, "saturation of the rate gyro"));
  spec.parameters.push_back(number_parameter("accel_noise_mps2_rtHz", "m/s2/sqrt(Hz)", 0.00137, 0.0,
                                             10.0, "white noise density of the accelerometer"));
  spec.parameters.push_back(number_parameter("accel_bias_std_mps2", "m/s2", 0.0, 0.0, 10.0,
                                             "constant bias, drawn once per run and axis"));
  spec.parameters.push_back(number_parameter("accel_walk_mps3_rtHz", "m/s3/sqrt(Hz)", 0.0, 0.0,
                                             10.0, "random walk of the accelerometer bias"));
  spec.parameters.push_back(positive_parameter("accel_range_mps2", "m/s2", 156.9,
                                               "saturation of the accelerometer (16 g)"));
  spec.parameters.push_back(delay_parameter());
  spec.reads = {"truth"};
  spec.writes = {"<name>: ImuSample"};
  return spec;
}

std::unique_ptr<Sensor> make_imu(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Imu>(parameters, context);
}

}  // namespace vinerow

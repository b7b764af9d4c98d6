#include "engine/sensors/imu.h"

#include "engine/api/messages/sensors.h"
#include "engine/core/constants.h"
#include "engine/math/angles.h"
#include "engine/sensors/mounted_sensor.h"
#include "engine/sensors/triad.h"

namespace vinerow::sensors {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kRadps_per_dph = rad_from_deg(1.0) / 3600.0;
constexpr ParameterConversion kDegreesPerHour = {
    [](double value) { return kRadps_per_dph * value; },
    [](double member) { return member / kRadps_per_dph; }};

TriadNames gyro_names() {
  return {"gyro", "deg/s", "dps", "deg/s2", "dps2", "deg/h", "dph", kDegrees, kDegreesPerHour};
}
TriadNames accelerometer_names() {
  return {"accel", "m/s2", "mps2", "m/s3", "mps3", "m/s2", "mps2", {}, {}};
}

/// Defaults: white noise and ranges of the VectorNav VN-100/VN-200 (gyro 0.0035 deg/s/rtHz,
/// accelerometer 0.14 mg/rtHz, 2000 deg/s, 16 g); other errors are zero.
struct ImuParams {
  TriadFigures gyro{.allan = {.white_u_rtHz = rad_from_deg(0.0035)},
                    .range_u = rad_from_deg(2000.0)};
  double gyro_g_sensitivity_std_radps = 0.0;  ///< per g
  TriadFigures accelerometer{.allan = {.white_u_rtHz = 0.00137}, .range_u = 156.9};
};

const ParameterTable<ImuParams>& imu_table() {
  using P = ImuParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .include(&P::gyro, make_triad_table(gyro_names()))
          .number("gyro_g_sensitivity_std_dps_per_g", "deg/s/g", &P::gyro_g_sensitivity_std_radps,
                  between(0.0, 10.0),
                  "rate read per specific force, drawn once per run for each gyro and "
                  "each direction",
                  kDegrees)
          .include(&P::accelerometer, make_triad_table(accelerometer_names()));
  return table;
}

/// Rotation vector of a unit quaternion, by the shorter rotation.
Vector3d rotation_vector(const Quaterniond& q) {
  const double sine = q.vec().norm();
  if (sine < 1e-12) return q.w() < 0.0 ? Vector3d(-2.0 * q.vec()) : Vector3d(2.0 * q.vec());
  const double angle = 2.0 * std::atan2(q.w() < 0.0 ? -sine : sine, std::abs(q.w()));
  return q.vec() * (angle / sine);
}

class Imu final : public MountedSensor<ImuSample> {
 public:
  Imu(const ParameterSet& parameters, const SensorContext& context)
      : Imu(imu_table().read(parameters, context.part), parameters, context) {}
  Imu(const ImuParams& params, const ParameterSet& parameters, const SensorContext& context)
      : MountedSensor(parameters, context),
        vehicle_(context.vehicle_truth),
        gravity_W_(0.0, 0.0, context.gravity_mps2),
        period_s_(context.period.s()),
        gyro_(gyro_names(), params.gyro, context),
        accelerometer_(accelerometer_names(), params.accelerometer, context) {
    RandomStream device = context.random("g_sensitivity");
    const double std_radps_per_mps2 = params.gyro_g_sensitivity_std_radps / kStandardGravity_mps2;
    for (int i = 0; i < 9; ++i) g_sensitivity_(i) = std_radps_per_mps2 * device.normal();
  }

  void step(Time now) override {
    const ImuSample truth = measure();
    ImuSample sample;
    sample.w_WS_S = gyro_.read(truth.w_WS_S + g_sensitivity_ * truth.f_WS_S);
    sample.f_WS_S = accelerometer_.read(truth.f_WS_S);
    readings_.push_or_silence(now, sample, truth);
  }

 private:
  /// Reading without errors.
  ImuSample measure() {
    const Quaterniond q_WS = X_WS().q;
    const Vector3d v_WS_W = v_WS();
    const Quaterniond q_SB = X_BS_.q.conjugate();
    ImuSample truth;
    if (has_last_) {
      const Vector3d turn_S = rotation_vector(last_q_WS_.conjugate() * q_WS);
      const Quaterniond q_W_middle = last_q_WS_.slerp(0.5, q_WS);
      truth.w_WS_S = turn_S / period_s_;
      truth.f_WS_S = q_W_middle.conjugate() * ((v_WS_W - last_v_WS_W_) / period_s_ + gravity_W_);
    } else {
      const Vector3d& w_B = body().w_WB_B;
      truth.w_WS_S = q_SB * w_B;
      truth.f_WS_S = q_SB * (vehicle_->specific_force_B() + w_B.cross(w_B.cross(X_BS_.p)));
    }
    last_q_WS_ = q_WS;
    last_v_WS_W_ = v_WS_W;
    has_last_ = true;
    return truth;
  }

  const Vehicle* vehicle_;
  Vector3d gravity_W_;  ///< reading of an accelerometer at rest
  double period_s_;
  Triad gyro_;
  Triad accelerometer_;
  Eigen::Matrix3d g_sensitivity_;  ///< rad/s per m/s2
  Quaterniond last_q_WS_ = Quaterniond::Identity();
  Vector3d last_v_WS_W_ = Vector3d::Zero();
  bool has_last_ = false;
};

}  // namespace

PartSpec imu_spec() {
  return mounted_sensor_spec<ImuSample>(
      "imu",
      "Rate gyro and accelerometer: white noise, bias instability and random walk by their Allan "
      "deviation, turn-on bias, scale, misalignment, saturation",
      100.0, imu_table());
}

std::unique_ptr<Sensor> make_imu(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Imu>(parameters, context);
}

}  // namespace vinerow::sensors

#include "engine/sensors/gps.h"

#include <cmath>

#include "engine/sensors/satellite_receiver.h"

namespace vinerow::sensors {
namespace {

enum class ErrorModel { kIdeal, kUniform, kGaussian };

struct GpsParams {
  ErrorModel error = ErrorModel::kGaussian;
  double accuracy_m = 0.02;
  double horizontal_std_m = 0.01;
  double vertical_std_m = 0.02;
  double velocity_std_mps = 0.03;
  double walk_std_m = 0.0;
  double walk_time_s = 60.0;
};

const ParameterTable<GpsParams>& gps_table() {
  using P = GpsParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("error", &P::error,
                  {{"ideal", ErrorModel::kIdeal},
                   {"uniform", ErrorModel::kUniform},
                   {"gaussian", ErrorModel::kGaussian}},
                  "error model; uniform is paper B's location error")
          .number("accuracy_m", "m", &P::accuracy_m, between(0.0, 100.0),
                  "uniform: largest error on east and on north")
          .number("horizontal_std_m", "m", &P::horizontal_std_m, between(0.0, 100.0),
                  "gaussian: white error, east and north")
          .number("vertical_std_m", "m", &P::vertical_std_m, between(0.0, 100.0),
                  "gaussian: white error, up")
          .number("velocity_std_mps", "m/s", &P::velocity_std_mps, between(0.0, 100.0),
                  "gaussian: white error of the velocity")
          .number("walk_std_m", "m", &P::walk_std_m, between(0.0, 100.0),
                  "gaussian: slowly varying part of the error")
          .number("walk_time_s", "s", &P::walk_time_s, kPositive,
                  "gaussian: correlation time of that part");
  return table;
}

class Gps final : public SatelliteReceiver {
 public:
  Gps(const ParameterSet& parameters, const SensorContext& context)
      : SatelliteReceiver(parameters, context), random_(context.random()) {
    const GpsParams params = gps_table().read(parameters, context.part);
    model_ = params.error;
    accuracy_m_ = params.accuracy_m;
    white_std_m_ = {params.horizontal_std_m, params.horizontal_std_m, params.vertical_std_m};
    velocity_std_mps_ = params.velocity_std_mps;
    walk_std_m_ = params.walk_std_m;
    // Exact discretisation of the Gauss-Markov process: its variance does not depend on the rate.
    walk_decay_ = std::exp(-context.period.s() / params.walk_time_s);
    for (int axis = 0; axis < 3; ++axis) walk_m_[axis] = walk_std_m_ * random_.normal();
  }

  void step(Time now) override {
    const GnssFix exact = exact_fix();
    GnssFix fix = exact;
    fix.p_W += draw_position_error();
    fix.v_W += draw_velocity_error();
    fix.std_m = stated_std();
    locate(fix);
    readings_.push(now, readings_.is_in_outage(now) ? GnssFix{} : fix, exact);
  }

 private:
  Eigen::Vector3d draw_position_error() {
    if (model_ == ErrorModel::kUniform) {
      const double east = random_.uniform(-accuracy_m_, accuracy_m_);
      const double north = random_.uniform(-accuracy_m_, accuracy_m_);
      return {east, north, 0.0};
    }
    if (model_ == ErrorModel::kIdeal) return Eigen::Vector3d::Zero();
    Eigen::Vector3d error;
    const double kick = walk_std_m_ * std::sqrt(1.0 - walk_decay_ * walk_decay_);
    for (int axis = 0; axis < 3; ++axis) {
      walk_m_[axis] = walk_decay_ * walk_m_[axis] + kick * random_.normal();
      error[axis] = white_std_m_[axis] * random_.normal() + walk_m_[axis];
    }
    return error;
  }

  Eigen::Vector3d draw_velocity_error() {
    if (model_ != ErrorModel::kGaussian) return Eigen::Vector3d::Zero();
    Eigen::Vector3d error;
    for (int axis = 0; axis < 3; ++axis) error[axis] = velocity_std_mps_ * random_.normal();
    return error;
  }

  Eigen::Vector3d stated_std() const {
    switch (model_) {
      case ErrorModel::kIdeal:
        return Eigen::Vector3d::Zero();
      case ErrorModel::kUniform:  // standard deviation of a uniform variable on [-a, a]
        return Eigen::Vector3d(1.0, 1.0, 0.0) * (accuracy_m_ / std::sqrt(3.0));
      case ErrorModel::kGaussian:
        break;
    }
    return (white_std_m_.array().square() + walk_std_m_ * walk_std_m_).sqrt();
  }

  RandomStream random_;
  ErrorModel model_ = ErrorModel::kIdeal;
  double accuracy_m_ = 0.0;
  Eigen::Vector3d white_std_m_ = Eigen::Vector3d::Zero();
  double velocity_std_mps_ = 0.0;
  double walk_std_m_ = 0.0;
  double walk_decay_ = 0.0;
  Eigen::Vector3d walk_m_ = Eigen::Vector3d::Zero();
};

}  // namespace

PartSpec gps_spec() {
  return mounted_sensor_spec<GnssFix>(
      "gps", "Satellite positioning with paper B's uniform error or a white + Gauss-Markov one",
      5.0, gps_table());
}

std::unique_ptr<Sensor> make_gps(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Gps>(parameters, context);
}

}  // namespace vinerow::sensors

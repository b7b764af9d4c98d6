#include "engine/sensors/gps.h"

#include <cmath>

#include "engine/io/geo.h"
#include "engine/sensors/mounting.h"
#include "engine/sensors/readings.h"

namespace vinerow {
namespace {

enum class ErrorModel { kIdeal, kUniform, kGaussian };

class Gps final : public Sensor {
 public:
  Gps(const ParameterSet& parameters, const SensorContext& context)
      : frame_(context.world->origin),
        X_BS_(mounting_pose(parameters)),
        readings_(parameters, context),
        random_(context.random()) {
    const std::string& error = parameters.text("error");
    model_ = error == "uniform"    ? ErrorModel::kUniform
             : error == "gaussian" ? ErrorModel::kGaussian
                                   : ErrorModel::kIdeal;
    accuracy_m_ = parameters.number("accuracy_m");
    const double horizontal = parameters.number("horizontal_std_m");
    white_std_m_ = {horizontal, horizontal, parameters.number("vertical_std_m")};
    velocity_std_mps_ = parameters.number("velocity_std_mps");
    walk_std_m_ = parameters.number("walk_std_m");
    // Exact discretisation of the Gauss-Markov process keeps its variance whatever the rate.
    walk_decay_ = std::exp(-context.period.s() / parameters.number("walk_time_s"));
    for (int axis = 0; axis < 3; ++axis) walk_m_[axis] = walk_std_m_ * random_.normal();
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    readings_.connect(ports);
  }
  Duration delay() const override { return readings_.delay(); }
  std::optional<Pose> mounting_X_BS() const override { return X_BS_; }
  void deliver(Time) override { readings_.deliver(); }

  void step(Time now) override {
    const Odometry& truth = truth_.value();
    const Eigen::Vector3d p_BS_W = truth.X_WB.q * X_BS_.p;
    GnssFix exact;
    exact.valid = true;
    exact.p_W = truth.X_WB.p + p_BS_W;
    exact.v_W = truth.X_WB.q * (truth.v_WB_B + truth.w_WB_B.cross(X_BS_.p));
    GnssFix fix = exact;
    fix.p_W += draw_position_error();
    fix.v_W += draw_velocity_error();
    fix.std_m = stated_std();
    locate(exact);
    locate(fix);
    readings_.push(now, readings_.is_in_outage(now) ? GnssFix{} : fix, exact);
  }

 private:
  /// Latitude, longitude and altitude of p_W.
  void locate(GnssFix& fix) const {
    const io::Geodetic g = frame_.to_geodetic(fix.p_W);
    fix.latitude_rad = g.latitude_rad;
    fix.longitude_rad = g.longitude_rad;
    fix.altitude_m = g.altitude_m;
  }

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

  io::LocalFrame frame_;
  Pose X_BS_;
  Readings<GnssFix> readings_;
  RandomStream random_;
  ErrorModel model_ = ErrorModel::kIdeal;
  double accuracy_m_ = 0.0;
  Eigen::Vector3d white_std_m_ = Eigen::Vector3d::Zero();
  double velocity_std_mps_ = 0.0;
  double walk_std_m_ = 0.0;
  double walk_decay_ = 0.0;
  Eigen::Vector3d walk_m_ = Eigen::Vector3d::Zero();
  SignalReader<Odometry> truth_;
};

}  // namespace

PartSpec gps_spec() {
  PartSpec spec;
  spec.name = "gps";
  spec.description =
      "Satellite positioning with paper B's uniform error or a white + Gauss-Markov one";
  spec.default_rate_Hz = 5.0;
  spec.parameters = mounting_parameters({0.0, 0.0, 0.0});
  spec.parameters.push_back(choice_parameter("error", "gaussian", {"ideal", "uniform", "gaussian"},
                                             "error model; uniform is paper B's location error"));
  spec.parameters.push_back(number_parameter("accuracy_m", "m", 0.02, 0.0, 100.0,
                                             "uniform: largest error on east and on north"));
  spec.parameters.push_back(number_parameter("horizontal_std_m", "m", 0.01, 0.0, 100.0,
                                             "gaussian: white error, east and north"));
  spec.parameters.push_back(
      number_parameter("vertical_std_m", "m", 0.02, 0.0, 100.0, "gaussian: white error, up"));
  spec.parameters.push_back(number_parameter("velocity_std_mps", "m/s", 0.03, 0.0, 100.0,
                                             "gaussian: white error of the velocity"));
  spec.parameters.push_back(number_parameter("walk_std_m", "m", 0.0, 0.0, 100.0,
                                             "gaussian: slowly moving part of the error"));
  spec.parameters.push_back(
      positive_parameter("walk_time_s", "s", 60.0, "gaussian: correlation time of that part"));
  add_reading_parameters(spec.parameters);
  spec.reads = {"truth"};
  spec.writes = {"<name>: GnssFix", "<name>_truth: GnssFix"};
  return spec;
}

std::unique_ptr<Sensor> make_gps(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Gps>(parameters, context);
}

}  // namespace vinerow

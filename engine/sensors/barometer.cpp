#include "engine/sensors/barometer.h"

#include <cmath>

#include "engine/math/standard_atmosphere.h"
#include "engine/sensors/gauss_markov.h"
#include "engine/sensors/mounting.h"
#include "engine/sensors/readings.h"

namespace vinerow {
namespace {

class Barometer final : public Sensor {
 public:
  Barometer(const ParameterSet& parameters, const SensorContext& context)
      : vehicle_(context.vehicle_truth),
        X_BS_(mounting_pose(parameters)),
        origin_altitude_m_(context.world->origin.altitude_m),
        weather_(parameters.number("sea_level_pressure_Pa") / kSeaLevelPressure_Pa),
        noise_std_Pa_(parameters.number("noise_std_Pa")),
        dynamic_share_(parameters.number("dynamic_pressure_share")),
        resolution_Pa_(parameters.number("resolution_Pa")),
        drift_Pa_(parameters.number("drift_std_Pa"), parameters.number("drift_time_s"),
                  context.period.s()),
        random_(context.random()),
        readings_(parameters, context) {
    const double bias_std_Pa = parameters.number("bias_std_Pa");
    bias_Pa_ = bias_std_Pa * random_.normal();
    drift_Pa_.start(random_);
    stated_std_Pa_ = std::sqrt(noise_std_Pa_ * noise_std_Pa_ + bias_std_Pa * bias_std_Pa +
                               std::pow(parameters.number("drift_std_Pa"), 2));
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    readings_.connect(ports);
  }
  Duration delay() const override { return readings_.delay(); }
  std::optional<Pose> mounting_X_BS() const override { return X_BS_; }
  void deliver(Time) override { readings_.deliver(); }

  void step(Time now) override {
    const Eigen::Vector3d p_WS = truth_.value().X_WB * X_BS_.p;
    const AirState air = calc_standard_air(origin_altitude_m_ + p_WS.z());
    PressureSample truth;
    truth.pressure_Pa = weather_ * air.pressure_Pa;
    PressureSample sample = truth;
    const double speed_mps = vehicle_->air_velocity_B().norm();
    sample.pressure_Pa +=
        dynamic_share_ * 0.5 * weather_ * air.density_kgm3 * speed_mps * speed_mps + bias_Pa_ +
        drift_Pa_.step(random_) + noise_std_Pa_ * random_.normal();
    if (resolution_Pa_ > 0.0) {
      sample.pressure_Pa = resolution_Pa_ * std::round(sample.pressure_Pa / resolution_Pa_);
    }
    sample.std_Pa = stated_std_Pa_;
    if (readings_.is_in_outage(now)) {
      readings_.push_silence(now, truth);
    } else {
      readings_.push(now, sample, truth);
    }
  }

 private:
  const Vehicle* vehicle_;
  Pose X_BS_;
  double origin_altitude_m_;
  double weather_;  ///< the day's pressure over the standard's
  double noise_std_Pa_;
  double dynamic_share_;
  double resolution_Pa_;
  GaussMarkov drift_Pa_;
  RandomStream random_;
  Readings<PressureSample> readings_;
  double bias_Pa_ = 0.0;
  double stated_std_Pa_ = 0.0;
  SignalReader<Odometry> truth_;
};

}  // namespace

PartSpec barometer_spec() {
  PartSpec spec;
  spec.name = "barometer";
  spec.description =
      "Static pressure by the US Standard Atmosphere 1976 with noise, drift, bias and wind error";
  spec.default_rate_Hz = 50.0;
  spec.parameters = mounting_parameters({0.0, 0.0, 0.0});
  const auto add = [&](ParameterSpec parameter) {
    spec.parameters.push_back(std::move(parameter));
  };
  // Defaults: Bosch BMP388, see assets/sensors/bmp388.yaml.
  add(number_parameter("sea_level_pressure_Pa", "Pa", kSeaLevelPressure_Pa, 80'000.0, 120'000.0,
                       "the day's pressure at mean sea level; scales the standard atmosphere"));
  add(number_parameter("noise_std_Pa", "Pa", 1.3, 0.0, 1e4, "white noise of a reading"));
  add(number_parameter("drift_std_Pa", "Pa", 4.0, 0.0, 1e4, "1 sigma of the drift"));
  add(positive_parameter("drift_time_s", "s", 600.0, "correlation time of the drift"));
  add(number_parameter("bias_std_Pa", "Pa", 25.0, 0.0, 1e4, "bias, drawn once per run"));
  add(number_parameter("resolution_Pa", "Pa", 0.0, 0.0, 1e4, "step of the reading; 0: none"));
  add(number_parameter("dynamic_pressure_share", "", 0.0, -2.0, 2.0,
                       "share of the dynamic pressure that the housing lets in"));
  add_reading_parameters(spec.parameters);
  spec.reads = {"truth", "the vehicle's true velocity through the air"};
  spec.writes = {"<name>: PressureSample", "<name>_truth: PressureSample"};
  return spec;
}

std::unique_ptr<Sensor> make_barometer(const ParameterSet& parameters,
                                       const SensorContext& context) {
  return std::make_unique<Barometer>(parameters, context);
}

}  // namespace vinerow

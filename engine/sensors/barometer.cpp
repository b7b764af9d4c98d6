#include "engine/sensors/barometer.h"

#include <cmath>

#include "engine/api/messages/sensors.h"
#include "engine/api/world_model.h"
#include "engine/math/standard_atmosphere.h"
#include "engine/sensors/gauss_markov.h"
#include "engine/sensors/mounted_sensor.h"
#include "engine/sensors/resolution.h"

namespace vinerow::sensors {
namespace {

/// Defaults: Bosch BMP388, see assets/sensors/bmp388.yaml.
struct BarometerParams {
  double sea_level_pressure_Pa = kSeaLevelPressure_Pa;
  double noise_std_Pa = 1.3;
  double drift_std_Pa = 4.0;
  double drift_time_s = 600.0;
  double bias_std_Pa = 25.0;
  double resolution_Pa = 0.0;
  double dynamic_pressure_share = 0.0;
};

const ParameterTable<BarometerParams>& barometer_table() {
  using P = BarometerParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("sea_level_pressure_Pa", "Pa", &P::sea_level_pressure_Pa,
                  between(80'000.0, 120'000.0),
                  "the day's pressure at mean sea level; scales the standard atmosphere")
          .number("noise_std_Pa", "Pa", &P::noise_std_Pa, between(0.0, 1e4),
                  "white noise of a reading")
          .number("drift_std_Pa", "Pa", &P::drift_std_Pa, between(0.0, 1e4), "1 sigma of the drift")
          .number("drift_time_s", "s", &P::drift_time_s, kPositive, "correlation time of the drift")
          .number("bias_std_Pa", "Pa", &P::bias_std_Pa, between(0.0, 1e4),
                  "bias, drawn once per run")
          .number("resolution_Pa", "Pa", &P::resolution_Pa, between(0.0, 1e4),
                  "step of the reading; 0: none")
          .number("dynamic_pressure_share", "", &P::dynamic_pressure_share, between(-2.0, 2.0),
                  "share of the dynamic pressure that enters the housing");
  return table;
}

class Barometer final : public MountedSensor<PressureSample> {
 public:
  Barometer(const ParameterSet& parameters, const SensorContext& context)
      : Barometer(barometer_table().read(parameters, context.part), parameters, context) {}
  Barometer(const BarometerParams& params, const ParameterSet& parameters,
            const SensorContext& context)
      : MountedSensor(parameters, context),
        vehicle_(context.vehicle_truth),
        origin_altitude_m_(context.world->origin.altitude_m),
        weather_(params.sea_level_pressure_Pa / kSeaLevelPressure_Pa),
        noise_std_Pa_(params.noise_std_Pa),
        dynamic_share_(params.dynamic_pressure_share),
        resolution_Pa_(params.resolution_Pa),
        drift_Pa_(params.drift_std_Pa, params.drift_time_s, context.period.s()),
        random_(context.random()) {
    bias_Pa_ = params.bias_std_Pa * random_.normal();
    drift_Pa_.start(random_);
    stated_std_Pa_ =
        std::sqrt(noise_std_Pa_ * noise_std_Pa_ + params.bias_std_Pa * params.bias_std_Pa +
                  std::pow(params.drift_std_Pa, 2));
  }

  void step(Time now) override {
    const AirState air = calc_standard_air(origin_altitude_m_ + X_WS().p.z());
    PressureSample truth;
    truth.pressure_Pa = weather_ * air.pressure_Pa;
    PressureSample sample = truth;
    const double speed_mps = vehicle_->air_velocity_B().norm();
    sample.pressure_Pa +=
        dynamic_share_ * 0.5 * weather_ * air.density_kgm3 * speed_mps * speed_mps + bias_Pa_ +
        drift_Pa_.step(random_) + noise_std_Pa_ * random_.normal();
    sample.pressure_Pa = round_to_step(sample.pressure_Pa, resolution_Pa_);
    sample.std_Pa = stated_std_Pa_;
    readings_.push_or_silence(now, sample, truth);
  }

 private:
  const Vehicle* vehicle_;
  double origin_altitude_m_;
  double weather_;  ///< ratio of the day's pressure to the standard's
  double noise_std_Pa_;
  double dynamic_share_;
  double resolution_Pa_;
  GaussMarkov drift_Pa_;
  RandomStream random_;
  double bias_Pa_ = 0.0;
  double stated_std_Pa_ = 0.0;
};

}  // namespace

PartSpec barometer_spec() {
  PartSpec spec = mounted_sensor_spec<PressureSample>(
      "barometer",
      "Static pressure by the US Standard Atmosphere 1976 with noise, drift, bias and wind error",
      50.0, barometer_table());
  spec.reads.push_back("the vehicle's true velocity through the air");
  return spec;
}

std::unique_ptr<Sensor> make_barometer(const ParameterSet& parameters,
                                       const SensorContext& context) {
  return std::make_unique<Barometer>(parameters, context);
}

}  // namespace vinerow::sensors

#include "engine/sensors/air_data.h"

#include <cmath>

#include "engine/api/messages/sensors.h"
#include "engine/sensors/reading_sensor.h"

namespace vinerow::sensors {
namespace {

/// The defaults are chosen, not from a data sheet: noise of one degree of the vanes at 12 m/s, a
/// lag of one tick, no scale error, and a speed below which vanes do not turn.
struct AirDataParams {
  double noise_std_mps = 0.2;
  double lag_s = 0.05;
  double scale_error = 0.0;
  double min_airspeed_mps = 2.0;
};

const ParameterTable<AirDataParams>& air_data_table() {
  using P = AirDataParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("noise_std_mps", "m/s", &P::noise_std_mps, between(0.0, 50.0),
                  "white noise of each axis")
          .number("lag_s", "s", &P::lag_s, between(0.0, 60.0),
                  "time constant of the tube and the vanes")
          .number("scale_error", "", &P::scale_error, between(-0.5, 0.5),
                  "relative scale error; > 0 reads too high")
          .number("min_airspeed_mps", "m/s", &P::min_airspeed_mps, between(0.0, 100.0),
                  "below this airspeed the reading is zero");
  return table;
}

class AirDataProbe final : public ReadingSensor<AirData> {
 public:
  AirDataProbe(const ParameterSet& parameters, const SensorContext& context)
      : ReadingSensor(parameters, context),
        vehicle_(context.vehicle_truth),
        random_(context.random()) {
    const AirDataParams params = air_data_table().read(parameters, context.part);
    noise_std_mps_ = params.noise_std_mps;
    scale_ = 1.0 + params.scale_error;
    min_airspeed_mps_ = params.min_airspeed_mps;
    kept_share_ = params.lag_s > 0.0 ? std::exp(-context.period.s() / params.lag_s) : 0.0;
  }

  void step(Time now) override {
    const Eigen::Vector3d truth_B = vehicle_->air_velocity_B();
    lagged_B_ =
        has_last_ ? Eigen::Vector3d(truth_B + kept_share_ * (lagged_B_ - truth_B)) : truth_B;
    has_last_ = true;
    AirData reading;
    for (int axis = 0; axis < 3; ++axis) {
      reading.v_air_B[axis] = scale_ * lagged_B_[axis] + noise_std_mps_ * random_.normal();
    }
    if (readings_.is_in_outage(now) || reading.v_air_B.norm() < min_airspeed_mps_) {
      reading.v_air_B.setZero();
    }
    readings_.push(now, reading, AirData{truth_B});
  }

 private:
  const Vehicle* vehicle_;
  RandomStream random_;
  double noise_std_mps_ = 0.0;
  double scale_ = 1.0;
  double min_airspeed_mps_ = 0.0;
  double kept_share_ = 0.0;  ///< share of the last reading's deviation from the truth that remains
  Eigen::Vector3d lagged_B_ = Eigen::Vector3d::Zero();
  bool has_last_ = false;
};

}  // namespace

PartSpec air_data_spec() {
  PartSpec spec = reading_sensor_spec<AirData>(
      "air_data",
      "Pitot tube and vanes: velocity through the air with white noise, lag, delay and scale error",
      20.0, air_data_table());
  spec.reads = {"the vehicle's true velocity through the air"};
  return spec;
}

std::unique_ptr<Sensor> make_air_data(const ParameterSet& parameters,
                                      const SensorContext& context) {
  return std::make_unique<AirDataProbe>(parameters, context);
}

}  // namespace vinerow::sensors

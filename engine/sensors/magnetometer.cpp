#include "engine/sensors/magnetometer.h"

#include <algorithm>
#include <cmath>

#include "engine/api/messages/sensors.h"
#include "engine/api/world_model.h"
#include "engine/math/geomagnetic_field.h"
#include "engine/sensors/mounted_sensor.h"
#include "engine/sensors/resolution.h"

namespace vinerow {
namespace {

/// East, north, up, T.
Eigen::Vector3d field_W_T(const ParameterSet& parameters, const GeoOrigin& origin) {
  if (parameters.has("field_uT")) {
    const auto& field_uT = parameters.numbers("field_uT");
    return Eigen::Vector3d(field_uT[0], field_uT[1], field_uT[2]) * 1e-6;
  }
  return calc_geomagnetic_field_T(origin.latitude_rad, origin.longitude_rad, origin.altitude_m,
                                  parameters.number("year"));
}

class Magnetometer final : public MountedSensor<MagneticSample> {
 public:
  Magnetometer(const ParameterSet& parameters, const SensorContext& context)
      : MountedSensor(parameters, context),
        field_W_T_(field_W_T(parameters, context.world->origin)),
        noise_std_T_(1e-9 * parameters.number("noise_std_nT")),
        resolution_T_(1e-9 * parameters.number("resolution_nT")),
        range_T_(1e-6 * parameters.number("range_uT")),
        random_(context.random()) {
    RandomStream device = context.random("device");
    const auto& hard_uT = parameters.numbers("hard_iron_uT");
    const double hard_std_T = 1e-6 * parameters.number("hard_iron_std_uT");
    const auto& soft = parameters.numbers("soft_iron");
    const double soft_std = parameters.number("soft_iron_std");
    for (int i = 0; i < 3; ++i) {
      hard_iron_T_[i] = 1e-6 * hard_uT[i] + hard_std_T * device.normal();
    }
    Eigen::Vector3d diagonal, beside;
    for (int i = 0; i < 3; ++i) {
      diagonal[i] = 1.0 + soft[i] + soft_std * device.normal();
      beside[i] = soft[3 + i] + soft_std * device.normal();
    }
    soft_iron_ = symmetric_matrix(diagonal, beside);
  }

  void step(Time now) override {
    MagneticSample truth;
    truth.field_S_T = X_WS().q.conjugate() * field_W_T_;
    MagneticSample sample;
    sample.field_S_T = soft_iron_ * truth.field_S_T + hard_iron_T_;
    for (int i = 0; i < 3; ++i) {
      double& u_T = sample.field_S_T[i];
      u_T = round_to_step(u_T + noise_std_T_ * random_.normal(), resolution_T_);
      u_T = std::clamp(u_T, -range_T_, range_T_);
    }
    sample.std_T = noise_std_T_;
    readings_.push_or_silence(now, sample, truth);
  }

 private:
  Eigen::Vector3d field_W_T_;
  double noise_std_T_;
  double resolution_T_;
  double range_T_;
  RandomStream random_;
  Eigen::Vector3d hard_iron_T_;
  Eigen::Matrix3d soft_iron_;
};

}  // namespace

PartSpec magnetometer_spec() {
  return mounted_sensor_spec<MagneticSample>(
      "magnetometer",
      "Earth's magnetic field (World Magnetic Model 2025) with hard and soft iron and noise", 50.0,
      {number_parameter("year", "", kFirstGeomagneticYear, kFirstGeomagneticYear,
                        kLastGeomagneticYear, "decimal year for which the field is worked out"),
       optional(number_list_parameter("field_uT", "uT", {},
                                      "field to the east, north and up instead of the Earth's", 3)),
       // Defaults: PNI RM3100, see assets/sensors/rm3100.yaml.
       number_parameter("noise_std_nT", "nT", 15.0, 0.0, 1e6,
                        "white noise of a reading, each axis"),
       number_parameter("resolution_nT", "nT", 0.0, 0.0, 1e6, "step of the reading; 0: none"),
       positive_parameter("range_uT", "uT", 800.0, "saturation"),
       number_list_parameter("hard_iron_uT", "uT", {0.0, 0.0, 0.0},
                             "constant field of the vehicle in S, x, y, z", 3),
       number_parameter("hard_iron_std_uT", "uT", 0.0, 0.0, 1e3,
                        "1 sigma of what is added to it, drawn once per run and axis"),
       number_list_parameter("soft_iron", "", {0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                             "what soft iron adds to the identity: xx, yy, zz, xy, xz, yz", 6),
       number_parameter("soft_iron_std", "", 0.0, 0.0, 1.0,
                        "1 sigma of what is added to each of these, drawn once per run")});
}

std::unique_ptr<Sensor> make_magnetometer(const ParameterSet& parameters,
                                          const SensorContext& context) {
  return std::make_unique<Magnetometer>(parameters, context);
}

}  // namespace vinerow

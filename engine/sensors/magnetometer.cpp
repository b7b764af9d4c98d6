#include "engine/sensors/magnetometer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/api/messages/sensors.h"
#include "engine/api/world_model.h"
#include "engine/math/geomagnetic_field.h"
#include "engine/sensors/mounted_sensor.h"
#include "engine/sensors/resolution.h"

namespace vinerow::sensors {
namespace {

/// Parameters in the units of files. Defaults: PNI RM3100, see assets/sensors/rm3100.yaml.
struct MagnetometerParams {
  double year = kFirstGeomagneticYear;
  std::optional<Eigen::Vector3d> field_uT;
  double noise_std_nT = 15.0;
  double resolution_nT = 0.0;
  double range_uT = 800.0;
  Eigen::Vector3d hard_iron_uT = Eigen::Vector3d::Zero();
  double hard_iron_std_uT = 0.0;
  std::array<double, 6> soft_iron{};
  double soft_iron_std = 0.0;
};

const ParameterTable<MagnetometerParams>& magnetometer_table() {
  using P = MagnetometerParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("year", "", &P::year, between(kFirstGeomagneticYear, kLastGeomagneticYear),
                  "decimal year for which the field is computed")
          .numbers("field_uT", "uT", &P::field_uT, kAnyNumber,
                   "east, north and up components of a field that replaces the Earth's")
          .number("noise_std_nT", "nT", &P::noise_std_nT, between(0.0, 1e6),
                  "white noise of a reading, each axis")
          .number("resolution_nT", "nT", &P::resolution_nT, between(0.0, 1e6),
                  "step of the reading; 0: none")
          .number("range_uT", "uT", &P::range_uT, kPositive, "limit at which readings saturate")
          .numbers("hard_iron_uT", "uT", &P::hard_iron_uT, kAnyNumber,
                   "constant field of the vehicle in S, x, y, z")
          .number("hard_iron_std_uT", "uT", &P::hard_iron_std_uT, between(0.0, 1e3),
                  "1 sigma of a random addition to it, drawn once per run and axis")
          .numbers("soft_iron", "", &P::soft_iron, kAnyNumber,
                   "soft iron matrix minus the identity: xx, yy, zz, xy, xz, yz")
          .number("soft_iron_std", "", &P::soft_iron_std, between(0.0, 1.0),
                  "1 sigma of a random addition to each of these, drawn once per run");
  return table;
}

/// Field in W: east, north, up, T.
Eigen::Vector3d field_W_T(const MagnetometerParams& params, const GeoOrigin& origin) {
  if (params.field_uT) return *params.field_uT * 1e-6;
  return calc_geomagnetic_field_T(origin.latitude_rad, origin.longitude_rad, origin.altitude_m,
                                  params.year);
}

class Magnetometer final : public MountedSensor<MagneticSample> {
 public:
  Magnetometer(const ParameterSet& parameters, const SensorContext& context)
      : Magnetometer(magnetometer_table().read(parameters, context.part), parameters, context) {}
  Magnetometer(const MagnetometerParams& params, const ParameterSet& parameters,
               const SensorContext& context)
      : MountedSensor(parameters, context),
        field_W_T_(field_W_T(params, context.world->origin)),
        noise_std_T_(1e-9 * params.noise_std_nT),
        resolution_T_(1e-9 * params.resolution_nT),
        range_T_(1e-6 * params.range_uT),
        random_(context.random()) {
    RandomStream device = context.random("device");
    const double hard_std_T = 1e-6 * params.hard_iron_std_uT;
    const auto& soft = params.soft_iron;
    const double soft_std = params.soft_iron_std;
    for (int i = 0; i < 3; ++i) {
      hard_iron_T_[i] = 1e-6 * params.hard_iron_uT[i] + hard_std_T * device.normal();
    }
    Eigen::Vector3d diagonal, off_diagonal;
    for (int i = 0; i < 3; ++i) {
      diagonal[i] = 1.0 + soft[i] + soft_std * device.normal();
      off_diagonal[i] = soft[3 + i] + soft_std * device.normal();
    }
    soft_iron_ = symmetric_matrix(diagonal, off_diagonal);
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
      magnetometer_table());
}

std::unique_ptr<Sensor> make_magnetometer(const ParameterSet& parameters,
                                          const SensorContext& context) {
  return std::make_unique<Magnetometer>(parameters, context);
}

}  // namespace vinerow::sensors

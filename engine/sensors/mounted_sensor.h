#pragma once
/// Base class of sensors with a mounting on the vehicle that measure from the body's true motion.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/sensors/mounting.h"
#include "engine/sensors/reading_sensor.h"

namespace vinerow::sensors {

template <class T>
class MountedSensor : public ReadingSensor<T> {
 public:
  MountedSensor(const ParameterSet& parameters, const SensorContext& context)
      : ReadingSensor<T>(parameters, context),
        X_BS_(mounting_table().read(parameters, context.part).X_BS()) {}

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    ReadingSensor<T>::connect(ports);
  }
  std::optional<Pose> mounting_X_BS() const override { return X_BS_; }

 protected:
  const Odometry& body() const { return truth_.value(); }
  Pose X_WS() const { return body().X_WB * X_BS_; }
  /// Velocity of the sensor's position, in W.
  Eigen::Vector3d v_WS() const {
    return body().X_WB.q * (body().v_WB_B + body().w_WB_B.cross(X_BS_.p));
  }

  const Pose X_BS_;

 private:
  SignalReader<Odometry> truth_;
};

/// @param table  of the sensor's own parameters; the spec has the mounting's before them and the
/// readings' after them
/// @param mounting  for a sensor with other defaults
template <class T, class Params, class Mounting = MountingParams>
PartSpec mounted_sensor_spec(std::string name, std::string description, double default_rate_Hz,
                             const ParameterTable<Params>& table,
                             const ParameterTable<Mounting>& mounting = mounting_table()) {
  PartSpec spec = reading_sensor_spec<T>(std::move(name), std::move(description), default_rate_Hz,
                                         mounting, table);
  spec.reads = {"truth"};
  return spec;
}

}  // namespace vinerow::sensors

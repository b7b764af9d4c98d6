#pragma once
/// Base class of all sensors. Readings of type T are delayed, lost or faulty according to Readings,
/// and are written as the signal of the sensor's name, together with the truth.

#include <string>
#include <utility>
#include <vector>

#include "engine/api/stepped_parts.h"
#include "engine/sensors/readings.h"

namespace vinerow::sensors {

/// A derived sensor implements step(): it pushes one reading per tick to `readings_`.
template <class T>
class ReadingSensor : public Sensor {
 public:
  ReadingSensor(const ParameterSet& parameters, const SensorContext& context)
      : readings_(parameters, context) {}

  void connect(Ports& ports) override { readings_.connect(ports); }
  Duration delay() const override { return readings_.delay(); }
  void deliver(Time) override { readings_.deliver(); }

 protected:
  Readings<T> readings_;
};

/// @param parameters  the sensor's own; the spec has the readings' after them
template <class T>
PartSpec reading_sensor_spec(std::string name, std::string description, double default_rate_Hz,
                             std::vector<ParameterSpec> parameters) {
  PartSpec spec;
  spec.name = std::move(name);
  spec.description = std::move(description);
  spec.default_rate_Hz = default_rate_Hz;
  spec.parameters = join_parameters({std::move(parameters), reading_table().specs()});
  for (const char* signal : {"<name>: ", "<name>_truth: "}) {
    spec.writes.push_back(std::string(signal) + T::kType);
  }
  return spec;
}

}  // namespace vinerow::sensors

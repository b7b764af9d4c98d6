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

/// @param tables  of the sensor's own parameters; the spec has the readings' after them
template <class T, class... Params>
PartSpec reading_sensor_spec(std::string name, std::string description, double default_rate_Hz,
                             const ParameterTable<Params>&... tables) {
  PartSpec spec;
  spec.name = std::move(name);
  spec.description = std::move(description);
  spec.default_rate_Hz = default_rate_Hz;
  (tables.add_to(spec), ...);
  reading_table().add_to(spec);
  for (const char* signal : {"<name>: ", "<name>_truth: "}) {
    spec.writes.push_back(std::string(signal) + T::kType);
  }
  return spec;
}

}  // namespace vinerow::sensors

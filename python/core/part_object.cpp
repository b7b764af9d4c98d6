#include "python/core/part_object.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <type_traits>
#include <variant>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "python/core/fields_to_python.h"
#include "python/core/part_ports.h"
#include "python/core/usage_error.h"
#include "python/core/world.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

py::dict values_of(const ParameterSet& parameters) {
  py::dict values;
  for (const ParameterSpec& spec : parameters.specs()) {
    py::object value = py::none();
    if (const ParameterSet::Value* given = parameters.find(spec.name)) {
      std::visit(
          [&value]<class T>(const T& v) {
            if constexpr (!std::is_same_v<T, std::vector<ParameterSet>>) value = py::cast(v);
          },
          *given);
    }
    values[py::str(spec.name)] = value;
  }
  return values;
}

py::list mountings_of(const std::vector<SensorMounting>& sensors) {
  py::list list;
  const py::object type = py::module_::import("vinerow.parts").attr("Mounting");
  for (const SensorMounting& sensor : sensors) {
    py::array_t<double> position(3, sensor.X_BS.p.data());
    py::array_t<double> orientation(4, sensor.X_BS.q.coeffs().data());
    list.append(type(sensor.name, sensor.type, make_pose(position, orientation)));
  }
  return list;
}

py::object map_of_part(const Life& life) {
  life.demand(life.stage != Life::Stage::kOutside, "context.map", "in methods of the part");
  if (!life.map) throw UsageError(life.part + " has no map");
  return map_to_python(*life.map);
}

}  // namespace

PartObject::PartObject(std::shared_ptr<const PartClass> type, const ParameterSet& parameters,
                       const PartContext& context, const VehicleContext& around)
    : type_(std::move(type)), life_(std::make_shared<Life>()) {
  life_->part = context.part;
  life_->vehicle = around.vehicle;
  life_->map = around.map;
  py::gil_scoped_acquire lock;
  const InCall mark(*life_, Life::Stage::kMaking, Time{});
  try {
    const py::object python_context =
        py::module_::import("vinerow.parts")
            .attr("Context")(
                py::cpp_function([life = life_] { return map_of_part(*life); }),
                py::cpp_function([common = context](const std::string& component) {
                  RandomStream stream = common.random(component);
                  return std::vector<std::uint64_t>{stream.next_u64(), stream.next_u64(),
                                                    stream.next_u64(), stream.next_u64()};
                }),
                py::arg("vehicle") = vehicle_to_python(context.vehicle, *around.vehicle),
                py::arg("part") = context.part, py::arg("period_s") = context.period.s(),
                py::arg("physics_step_s") = context.physics_step.s(),
                py::arg("gravity_mps2") = context.gravity_mps2, py::arg("seed") = context.seed,
                py::arg("sensors") = mountings_of(around.sensors));
    object_ = std::make_unique<Held>(
        py::module_::import("vinerow._part_files")
            .attr("make")(type_->type.get(), python_context, values_of(parameters)));
  } catch (const py::error_already_set& error) {
    refuse(error);
  }
}

void PartObject::connect(Ports& ports) {
  const py::gil_scoped_acquire lock;
  const InCall mark(*life_, Life::Stage::kConnecting, Time{});
  try {
    object_->get().attr("connect")(PartPorts(life_, ports));
  } catch (const py::error_already_set& error) {
    refuse(error);
  }
}

void PartObject::step(const py::handle& object, Time now) {
  const py::object result = object.attr("step")(now.s());
  if (result.is_none()) return;
  fault("step() must return None, not {}; values go to a writer", type_of_value(result));
}

bool PartObject::finished(const py::handle& object) {
  const py::object result = object.attr("finished")();
  if (py::isinstance<py::bool_>(result)) return result.cast<bool>();
  if (type_of_value(result) == "bool_") return PyObject_IsTrue(result.ptr()) == 1;
  fault("finished() must return a bool, not {}", type_of_value(result));
}

std::string PartObject::failure(const py::handle& object) {
  const py::object result = object.attr("failure")();
  if (!py::isinstance<py::str>(result)) {
    fault("failure() must return a str, not {}", type_of_value(result));
  }
  return result.cast<std::string>();
}

void PartObject::refuse(const py::error_already_set& error) const {
  throw ConfigError(
      fmt::format("{} ({}): {}", life_->part, type_->name, sentence_of(error, type_->file)));
}

}  // namespace vinerow::python

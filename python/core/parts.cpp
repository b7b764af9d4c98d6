#include "python/core/parts.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/may_fail.h"
#include "engine/api/registry.h"
#include "engine/api/stepped_parts.h"
#include "engine/core/error.h"
#include "engine/io/files/placed_error.h"
#include "engine/sim/python_parts.h"
#include "python/core/fields_to_python.h"
#include "python/core/part_declaration.h"
#include "python/core/part_object.h"
#include "python/core/part_ports.h"
#include "python/core/world.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

class PythonEstimator final : public Estimator {
 public:
  explicit PythonEstimator(PartObject object) : object_(std::move(object)) {}
  void connect(Ports& ports) override { object_.connect(ports); }
  void step(Time now) override {
    object_.call(now, [&](const py::handle& object) { object_.step(object, now); });
  }

 private:
  PartObject object_;
};

/// The kernel asks for failure() after each physics step and for finished() in each instant. The
/// answers can change only in a step, so they are taken there.
class PythonGuidance final : public Guidance, public MayFail {
 public:
  explicit PythonGuidance(PartObject object) : object_(std::move(object)) {}
  void connect(Ports& ports) override { object_.connect(ports); }
  void step(Time now) override {
    object_.call(now, [&](const py::handle& object) {
      object_.step(object, now);
      failure_ = object_.failure(object);
    });
  }
  std::string_view failure() const override { return failure_; }

 private:
  PartObject object_;
  std::string failure_;
};

class PythonController final : public Controller, public MayFail {
 public:
  explicit PythonController(PartObject object) : object_(std::move(object)) {}
  void connect(Ports& ports) override { object_.connect(ports); }
  void step(Time now) override {
    object_.call(now, [&](const py::handle& object) {
      object_.step(object, now);
      finished_ = object_.finished(object);
      failure_ = object_.failure(object);
    });
  }
  bool finished() const override { return finished_; }
  std::string_view failure() const override { return failure_; }

 private:
  PartObject object_;
  bool finished_ = false;
  std::string failure_;
};

class PythonPlanner final : public Planner {
 public:
  explicit PythonPlanner(PartObject object) : object_(std::move(object)) {}

  Result<PlannedPath> plan(const Pose& start) override {
    return object_.call(Time{}, [&](const py::handle& object) -> Result<PlannedPath> {
      py::object result;
      try {
        py::array_t<double> position(3, start.p.data());
        py::array_t<double> orientation(4, start.q.coeffs().data());
        result = object.attr("plan")(make_pose(position, orientation));
        report_.numbers = object.attr("numbers").cast<std::map<std::string, double>>();
      } catch (const py::cast_error&) {
        object_.fault("numbers must be a dict of texts and numbers");
      } catch (py::error_already_set& error) {
        if (!error.matches(py::module_::import("vinerow.parts").attr("NoPath"))) throw;
        return Failure{py::str(error.value())};
      }
      return checked(result);
    });
  }
  const PlanReport* report() const override { return report_.numbers.empty() ? nullptr : &report_; }

 private:
  PlannedPath checked(const py::object& result) const {
    PlannedPath path;
    try {
      path = path_from_python(result, "the result of plan()");
    } catch (const ConfigError& error) {
      object_.fault("{}", error.what());
    }
    if (path.points.size() < 2) {
      object_.fault("the result of plan() must have at least 2 points, not {}", path.points.size());
    }
    double length_m = 0.0;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      const PathPoint& point = path.points[i];
      if (!point.p_W.allFinite() || !std::isfinite(point.yaw_rad) ||
          !std::isfinite(point.curvature_per_m) || !std::isfinite(point.speed_mps)) {
        object_.fault("the result of plan(): points[{}] is not finite", i);
      }
      if (i > 0) length_m += (point.p_W - path.points[i - 1].p_W).norm();
    }
    if (!std::isfinite(path.length_m)) object_.fault("the result of plan(): length is not finite");
    if (!result.contains("length")) path.length_m = length_m;
    return path;
  }

  PartObject object_;
  PlanReport report_;
};

/// Factory of a C++ class around a Python object.
template <class Part, class Context>
auto factory_of(std::shared_ptr<const PartClass> type) {
  return [type](const ParameterSet& parameters, const Context& context) {
    VehicleContext around{context.vehicle_description, context.map, {}};
    if constexpr (requires { context.sensors; }) around.sensors = context.sensors;
    return std::make_unique<Part>(PartObject(type, parameters, context, around));
  };
}

void register_class(const std::string& file, const py::handle& type, const py::handle& declaration,
                    Registry& registry) {
  const auto kind = declaration.attr("kind").cast<std::string>();
  PartSpec spec = part_spec_of(declaration);
  auto held = std::shared_ptr<const PartClass>(
      new PartClass{file, spec.name, Held(py::reinterpret_borrow<py::object>(type))});
  if (kind == "controller") {
    registry.add_controller(std::move(spec), factory_of<PythonController, ControllerContext>(held));
  } else if (kind == "guidance") {
    registry.add_guidance(std::move(spec), factory_of<PythonGuidance, ControllerContext>(held));
  } else if (kind == "estimator") {
    registry.add_estimator(std::move(spec), factory_of<PythonEstimator, EstimatorContext>(held));
  } else {
    registry.add_planner(std::move(spec), factory_of<PythonPlanner, PlannerContext>(held));
  }
}

py::object loaded_classes(const std::string& file) {
  try {
    return py::module_::import("vinerow._part_files").attr("load")(file);
  } catch (const py::error_already_set& error) {
    if (!error.matches(py::module_::import("vinerow.errors").attr("ConfigError"))) throw;
    const py::object line = error.value().attr("line");
    throw io::PlacedError({file, line.is_none() ? 0 : line.cast<int>()}, "",
                          py::str(error.value()));
  }
}

void load_parts(const std::filesystem::path& path, Registry& registry) {
  const py::gil_scoped_acquire lock;
  const std::string file = std::filesystem::absolute(path).lexically_normal().string();
  for (const py::handle entry : loaded_classes(file)) {
    const auto pair = py::reinterpret_borrow<py::tuple>(entry);
    const io::SourceMark where{file, pair[1].attr("line").cast<int>()};
    try {
      register_class(file, pair[0], pair[1], registry);
    } catch (const ConfigError& error) {
      throw io::PlacedError(where, "", fmt::format("{}: {}", where.text(), error.what()));
    }
  }
}

void interrupt_part() {
  if (is_part_called()) PyErr_SetInterruptEx(SIGINT);
}

constexpr PythonParts kPythonParts{&load_parts, &interrupt_part};

}  // namespace

void bind_parts(py::module_& module) {
  bind_part_ports(module);
  set_python_parts(&kPythonParts);
}

}  // namespace vinerow::python

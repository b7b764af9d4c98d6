#include "python/core/parts.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "engine/api/map.h"
#include "engine/api/may_fail.h"
#include "engine/api/messages.h"
#include "engine/api/registry.h"
#include "engine/api/vehicle.h"
#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/core/suggest.h"
#include "engine/io/files/placed_error.h"
#include "engine/sim/python_parts.h"
#include "python/core/fields_to_python.h"
#include "python/core/message_codec.h"
#include "python/core/usage_error.h"
#include "python/core/world.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

thread_local bool was_interrupted = false;
std::atomic<int> running_calls = 0;

/// A Python object owned by C++, released in any thread. After the interpreter's end nobody can
/// release it; the process then ends.
class Held {
 public:
  explicit Held(py::object object) : object_(object.release().ptr()) {}
  ~Held() {
    if (!Py_IsInitialized() || (_Py_IsFinalizing() && !PyGILState_Check())) return;
    const py::gil_scoped_acquire lock;
    Py_DECREF(object_);
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  py::handle get() const { return object_; }

 private:
  PyObject* object_;
};

/// What a part may see of its run, and when. Only used with the interpreter's lock.
struct Life {
  enum class Stage { kOutside, kMaking, kConnecting, kWorking };
  std::string part;
  Stage stage = Stage::kOutside;
  std::thread::id caller;
  Time now;
  const VehicleDescription* vehicle = nullptr;
  const RowMap* map = nullptr;

  /// @throws UsageError
  void demand(bool is_allowed, const std::string& what, const char* where) const {
    if (is_allowed && caller == std::this_thread::get_id()) return;
    throw UsageError(
        fmt::format("{} may be used only {}, in the thread that runs the part", what, where));
  }
};

/// Marks a call into a part.
class InCall {
 public:
  InCall(Life& life, Life::Stage stage, Time now) : life_(life) {
    life_.stage = stage;
    life_.caller = std::this_thread::get_id();
    life_.now = now;
    ++running_calls;
  }
  ~InCall() {
    life_.stage = Life::Stage::kOutside;
    --running_calls;
  }
  InCall(const InCall&) = delete;
  InCall& operator=(const InCall&) = delete;

 private:
  Life& life_;
};

/// "ZeroDivisionError: division by zero (my_parts.py:42)". Notes an interruption.
std::string sentence_of(const py::error_already_set& error, const std::string& file) {
  if (error.matches(PyExc_KeyboardInterrupt)) {
    was_interrupted = true;
    return "interrupted by Ctrl-C";
  }
  if (error.trace()) PyException_SetTraceback(error.value().ptr(), error.trace().ptr());
  const auto [text, line] = py::module_::import("vinerow._part_files")
                                .attr("describe")(error.value(), file)
                                .cast<std::pair<std::string, std::optional<int>>>();
  const std::string name = std::filesystem::path(file).filename().string();
  return line ? fmt::format("{} ({}:{})", text, name, *line) : fmt::format("{} ({})", text, name);
}

std::string type_of_value(const py::handle& value) {
  return py::str(py::type::handle_of(value).attr("__name__"));
}

class PartReader {
 public:
  PartReader(std::shared_ptr<Life> life, std::string name, const char* type,
             std::unique_ptr<AnyReader> reader)
      : life_(std::move(life)), name_(std::move(name)), type_(type), reader_(std::move(reader)) {}

  std::uint64_t count() const { return checked().count(); }
  double stamp_s() const { return written().stamp().s(); }
  py::object value() const { return message_to_python(type_, describe()); }
  py::object field(const std::string& name) const {
    if (py::object found = field_to_python(describe(), name)) return found;
    const auto known = field_names(describe());
    throw py::key_error(fmt::format("signal '{}' has no field '{}'{} (known: {})", name_, name,
                                    did_you_mean(name, known), join(known)));
  }

 private:
  const AnyReader& checked() const {
    life_->demand(life_->stage == Life::Stage::kWorking, fmt::format("reader '{}'", name_),
                  "in step()");
    return *reader_;
  }
  const AnyReader& written() const {
    const AnyReader& reader = checked();
    if (reader.count() == 0) {
      throw UsageError(fmt::format("signal '{}' has no value yet; ask has_value first", name_));
    }
    return reader;
  }
  Describe describe() const {
    return [&reader = written()](FieldVisitor& visitor) { reader.describe(visitor); };
  }

  std::shared_ptr<Life> life_;
  std::string name_;
  const char* type_;
  std::unique_ptr<AnyReader> reader_;
};

class PartWriter {
 public:
  PartWriter(std::shared_ptr<Life> life, std::string name, std::unique_ptr<AnyWriter> writer)
      : life_(std::move(life)), name_(std::move(name)), writer_(std::move(writer)) {}

  void write(const py::handle& value) {
    life_->demand(life_->stage == Life::Stage::kWorking, fmt::format("writer '{}'", name_),
                  "in step()");
    const std::vector<std::string> names = writer_->write(life_->now, value);
    if (name_ != "actuators" || names == known_names_) return;
    for (const std::string& actuator : names) {
      static_cast<void>(life_->vehicle->actuator_index(actuator, life_->part));
    }
    known_names_ = names;
  }

 private:
  std::shared_ptr<Life> life_;
  std::string name_;
  std::unique_ptr<AnyWriter> writer_;
  std::vector<std::string> known_names_;  ///< that the vehicle has
};

class PartPorts {
 public:
  PartPorts(std::shared_ptr<Life> life, Ports& ports) : life_(std::move(life)), ports_(&ports) {}

  PartReader read(const std::string& name, const std::string& type, bool optional) {
    const MessageCodec& codec = codec_for(name, type);
    return PartReader(life_, name, codec.name, codec.read(*ports_, name, optional));
  }
  PartWriter write(const std::string& name, const std::string& type) {
    return PartWriter(life_, name, codec_for(name, type).write(*ports_, name));
  }

 private:
  const MessageCodec& codec_for(const std::string& name, const std::string& type) const {
    life_->demand(life_->stage == Life::Stage::kConnecting, "ports", "in connect()");
    const std::string wanted = type.empty() ? std::string(usual_type(name)) : type;
    if (wanted.empty()) {
      throw ConfigError(
          fmt::format("the name '{0}' does not determine a message type; give it: '{0}', "
                      "'RangeSample'",
                      name));
    }
    if (const MessageCodec* codec = find_codec(wanted)) return *codec;
    const auto known = message_types();
    throw ConfigError(fmt::format("no message type '{}'{} (known: {})", wanted,
                                  did_you_mean(wanted, known), join(known)));
  }
  static std::string_view usual_type(std::string_view signal) {
    const std::string_view what = signal.substr(signal.rfind('/') + 1);
    if (what == "truth" || what == "estimate") return Odometry::kType;
    if (what == "command") return VelocityCommand::kType;
    if (what == "local_command") return LocalCommand::kType;
    if (what == "follower") return FollowerState::kType;
    return outside_type(signal);
  }

  std::shared_ptr<Life> life_;
  Ports* ports_;
};

/// A class of a file.
struct PartClass {
  std::string file;
  std::string name;
  Held type;
};

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

/// An object of a part's class, and the calls into it.
class PartObject {
 public:
  template <class Context>
  PartObject(std::shared_ptr<const PartClass> type, const ParameterSet& parameters,
             const Context& context)
      : type_(std::move(type)), life_(std::make_shared<Life>()) {
    life_->part = context.part;
    life_->vehicle = context.vehicle_description;
    life_->map = context.map;
    py::gil_scoped_acquire lock;
    const InCall mark(*life_, Life::Stage::kMaking, Time{});
    try {
      py::list sensors;
      if constexpr (requires { context.sensors; }) sensors = mountings_of(context.sensors);
      const PartContext common = context;
      const py::object python_context =
          py::module_::import("vinerow.parts")
              .attr("Context")(
                  py::cpp_function([life = life_] { return map_of_part(*life); }),
                  py::cpp_function([common](const std::string& component) {
                    RandomStream stream = common.random(component);
                    return std::vector<std::uint64_t>{stream.next_u64(), stream.next_u64(),
                                                      stream.next_u64(), stream.next_u64()};
                  }),
                  py::arg("vehicle") =
                      vehicle_to_python(context.vehicle, *context.vehicle_description),
                  py::arg("part") = context.part, py::arg("period_s") = context.period.s(),
                  py::arg("physics_step_s") = context.physics_step.s(),
                  py::arg("gravity_mps2") = context.gravity_mps2, py::arg("seed") = context.seed,
                  py::arg("sensors") = sensors);
      object_ = std::make_unique<Held>(
          py::module_::import("vinerow._part_files")
              .attr("make")(type_->type.get(), python_context, values_of(parameters)));
    } catch (const py::error_already_set& error) {
      refuse(error);
    }
  }

  void connect(Ports& ports) {
    const py::gil_scoped_acquire lock;
    const InCall mark(*life_, Life::Stage::kConnecting, Time{});
    try {
      object_->get().attr("connect")(PartPorts(life_, ports));
    } catch (const py::error_already_set& error) {
      refuse(error);
    }
  }

  /// Calls methods of the object. @param work  gets the object; its result is no Python object
  template <class Work>
  auto call(Time now, Work&& work) {
    const py::gil_scoped_acquire lock;
    const InCall mark(*life_, Life::Stage::kWorking, now);
    try {
      return work(object_->get());
    } catch (const py::error_already_set& error) {
      throw std::runtime_error(sentence_of(error, type_->file));
    }
  }

  void step(const py::handle& object, Time now) {
    const py::object result = object.attr("step")(now.s());
    if (result.is_none()) return;
    fault("step() must return None, not {}; values go to a writer", type_of_value(result));
  }
  bool finished(const py::handle& object) {
    const py::object result = object.attr("finished")();
    if (py::isinstance<py::bool_>(result)) return result.cast<bool>();
    if (type_of_value(result) == "bool_") return PyObject_IsTrue(result.ptr()) == 1;
    fault("finished() must return a bool, not {}", type_of_value(result));
  }
  std::string failure(const py::handle& object) {
    const py::object result = object.attr("failure")();
    if (!py::isinstance<py::str>(result)) {
      fault("failure() must return a str, not {}", type_of_value(result));
    }
    return result.cast<std::string>();
  }

  /// @throws std::runtime_error with the part's file
  template <class... Words>
  [[noreturn]] void fault(fmt::format_string<Words...> text, Words&&... words) const {
    throw std::runtime_error(fmt::format("{} ({})",
                                         fmt::format(text, std::forward<Words>(words)...),
                                         std::filesystem::path(type_->file).filename().string()));
  }

 private:
  static py::object map_of_part(const Life& life) {
    life.demand(life.stage != Life::Stage::kOutside, "context.map", "in methods of the part");
    if (!life.map) throw UsageError(life.part + " has no map");
    return map_to_python(*life.map);
  }
  [[noreturn]] void refuse(const py::error_already_set& error) const {
    throw ConfigError(
        fmt::format("{} ({}): {}", life_->part, type_->name, sentence_of(error, type_->file)));
  }

  std::shared_ptr<const PartClass> type_;
  std::shared_ptr<Life> life_;
  std::unique_ptr<Held> object_;
};

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

/// Default of a parameter as a value of its kind.
/// @throws ConfigError "must be a number, not str"
ParameterSet::Value value_from(const py::handle& value, ParameterKind kind) {
  const auto cast = [&value]<class T>(T*, const char* wanted) {
    const bool is_bool = py::isinstance<py::bool_>(value);
    try {
      if (is_bool == std::is_same_v<T, bool>) return value.cast<T>();
    } catch (const py::cast_error&) {
    }
    throw ConfigError(fmt::format("must be {}, not {}", wanted, type_of_value(value)));
  };
  switch (kind) {
    case ParameterKind::kNumber:
      return cast(static_cast<double*>(nullptr), "a number");
    case ParameterKind::kInteger:
      return cast(static_cast<std::int64_t*>(nullptr), "a whole number");
    case ParameterKind::kBoolean:
      return cast(static_cast<bool*>(nullptr), "True or False");
    case ParameterKind::kNumberList:
      return cast(static_cast<std::vector<double>*>(nullptr), "a list of numbers");
    case ParameterKind::kTextList:
      return cast(static_cast<std::vector<std::string>*>(nullptr), "a list of texts");
    default:
      return cast(static_cast<std::string*>(nullptr), "a text");
  }
}

ParameterKind kind_named(const std::string& name) {
  if (name == "number") return ParameterKind::kNumber;
  if (name == "integer") return ParameterKind::kInteger;
  if (name == "boolean") return ParameterKind::kBoolean;
  if (name == "numbers") return ParameterKind::kNumberList;
  if (name == "texts") return ParameterKind::kTextList;
  return name == "path" ? ParameterKind::kPath : ParameterKind::kText;
}

ParameterSpec spec_of(const std::string& name, const py::handle& parameter) {
  ParameterSpec spec;
  spec.name = name;
  try {
    spec.kind = kind_named(parameter.attr("kind").cast<std::string>());
    spec.unit = parameter.attr("unit").cast<std::string>();
    spec.description = parameter.attr("words").cast<std::string>();
    spec.size = parameter.attr("size").cast<int>();
    spec.choices = parameter.attr("choices").cast<std::vector<std::string>>();
    const py::object low = parameter.attr("low"), high = parameter.attr("high");
    if (!low.is_none()) spec.min = low.cast<double>();
    if (!high.is_none()) spec.max = high.cast<double>();
    spec.min_exclusive = parameter.attr("low_excluded").cast<bool>();
  } catch (const py::cast_error&) {
    throw ConfigError(fmt::format(
        "parameter '{}': unit and words must be texts, limits numbers, size a whole number", name));
  }
  const py::object given = parameter.attr("default");
  spec.required = given.is(py::module_::import("vinerow.parts").attr("REQUIRED"));
  if (spec.required || given.is_none()) return spec;
  try {
    const ParameterSet::Value value = value_from(given, spec.kind);
    check_parameter(spec, value);
    std::visit(
        [&spec]<class T>(const T& v) {
          if constexpr (!std::is_same_v<T, std::vector<ParameterSet>>) spec.default_value = v;
        },
        value);
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    throw ConfigError(text.starts_with("must") ? fmt::format("the default of '{}' {}", name, text)
                                               : "the default " + text);
  }
  return spec;
}

std::vector<std::string> texts_of(const py::handle& list, const char* what) {
  try {
    return list.cast<std::vector<std::string>>();
  } catch (const py::cast_error&) {
    throw ConfigError(fmt::format("{} must be a list of names of signals", what));
  }
}

PartSpec part_spec_of(const py::handle& declaration) {
  PartSpec spec;
  spec.name = declaration.attr("name").cast<std::string>();
  spec.description = py::str(declaration.attr("words"));
  spec.default_rate_Hz = declaration.attr("rate_Hz").cast<double>();
  spec.reads = texts_of(declaration.attr("reads"), "reads");
  spec.writes = texts_of(declaration.attr("writes"), "writes");
  for (const py::handle entry : declaration.attr("parameters")) {
    const auto pair = py::reinterpret_borrow<py::tuple>(entry);
    spec.parameters.push_back(spec_of(pair[0].cast<std::string>(), pair[1]));
  }
  return spec;
}

/// Factory of a C++ class around a Python object.
template <class Part, class Context>
auto factory_of(std::shared_ptr<const PartClass> type) {
  return [type](const ParameterSet& parameters, const Context& context) {
    return std::make_unique<Part>(PartObject(type, parameters, context));
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
  if (running_calls > 0) PyErr_SetInterruptEx(SIGINT);
}

constexpr PythonParts kPythonParts{&load_parts, &interrupt_part};

}  // namespace

bool take_interruption() {
  return std::exchange(was_interrupted, false);
}

void bind_parts(py::module_& module) {
  py::class_<PartReader>(module, "PartReader", "A signal as a part reads it; only in its step().")
      .def_property_readonly("has_value",
                             [](const PartReader& reader) { return reader.count() > 0; })
      .def_property_readonly("count", &PartReader::count, "Number of writes so far.")
      .def_property_readonly("stamp_s", &PartReader::stamp_s, "Time of the value, s.")
      .def_property_readonly("value", &PartReader::value, "A vinerow.Message of copies.")
      .def(
          "__getitem__", &PartReader::field, py::arg("field"),
          "A copy of one field. Raises KeyError without such a field, UsageError without a value.");
  py::class_<PartWriter>(module, "PartWriter", "A signal as a part writes it; only in its step().")
      .def("write", &PartWriter::write, py::arg("value"),
           "{name: number} for actuators, else {field: value}; fields that are absent keep their "
           "default. Raises ConfigError.");
  py::class_<PartPorts>(module, "PartPorts", "Where a part connects its signals.")
      .def("read", &PartPorts::read, py::arg("name"), py::arg("type") = "",
           py::arg("optional") = false)
      .def("write", &PartPorts::write, py::arg("name"), py::arg("type") = "");
  set_python_parts(&kPythonParts);
}

}  // namespace vinerow::python

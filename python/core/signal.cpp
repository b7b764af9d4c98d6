#include "python/core/signal.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "engine/core/suggest.h"
#include "python/core/arguments.h"
#include "python/core/fields_to_python.h"
#include "python/core/usage_error.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

/// A Python object that keeps memory alive, as the base of arrays.
py::capsule owner_of(std::shared_ptr<const void> memory) {
  return py::capsule(new std::shared_ptr<const void>(std::move(memory)), [](void* pointer) {
    delete static_cast<std::shared_ptr<const void>*>(pointer);
  });
}

}  // namespace

PythonSignal::PythonSignal(std::shared_ptr<PythonSession> session, std::string name)
    : session_(std::move(session)), name_(std::move(name)) {
  PythonSession::Use use(*session_);
  present(use);
}

std::string PythonSignal::type() {
  PythonSession::Use use(*session_);
  return present(use).type();
}

std::string PythonSignal::writer() {
  PythonSession::Use use(*session_);
  return present(use).writer();
}

std::uint64_t PythonSignal::count() {
  PythonSession::Use use(*session_);
  const SignalBase& signal = present(use);
  return signal.sequence() - signal.forgotten();
}

Time PythonSignal::stamp() {
  PythonSession::Use use(*session_);
  return written(use).stamp();
}

py::dict PythonSignal::fields() {
  PythonSession::Use use(*session_);
  return field_infos(present(use));
}

py::object PythonSignal::field(const std::string& name) {
  PythonSession::Use use(*session_);
  const SignalBase& signal = written(use);
  if (!owner_) owner_ = owner_of(use->run_memory());
  if (py::object value = field_to_python(signal, name, owner_, Memory::kView)) return value;
  const auto known = field_names(signal);
  throw py::key_error(fmt::format("signal '{}' has no field '{}'{} (known: {})", name_, name,
                                  did_you_mean(name, known), join(known)));
}

py::object PythonSignal::value() {
  PythonSession::Use use(*session_);
  return message_to_python(written(use));
}

const SignalBase& PythonSignal::present(PythonSession::Use& use) {
  if (!signal_ || run_ != session_->run_number()) {
    owner_ = py::object();
    signal_ = &use->any_signal(name_);
    run_ = session_->run_number();
  }
  return *signal_;
}

const SignalBase& PythonSignal::written(PythonSession::Use& use) {
  const SignalBase& signal = present(use);
  if (signal.sequence() == signal.forgotten()) {
    throw UsageError(fmt::format("signal '{}' has no value yet", name_));
  }
  return signal;
}

void bind_signal(py::module_& module) {
  py::class_<PythonSignal>(module, "Signal", R"(A signal of a session; remains valid after reset().

signal["pose"] is one field of the last value, signal.value a copy of all fields. Vectors (3,), quaternions
(4,) x, y, z, w and poses are read-only views of the simulator's memory, which change with each step; after
reset() or close() they keep the last values of their run. Numbers, texts and lists are copies.)")
      .def_property_readonly("name", &PythonSignal::name)
      .def_property_readonly("type", &PythonSignal::type, "Name of the message, \"Odometry\".")
      .def_property_readonly("writer", &PythonSignal::writer,
                             "Part that writes it; \"outside\" for command().")
      .def_property_readonly("count", &PythonSignal::count, "Number of writes so far.")
      .def_property_readonly(
          "stamp_s", [](PythonSignal& signal) { return signal.stamp().nearest_s(); },
          "Time of the value, s; for a sensor with a delay, of the measurement.")
      .def_property_readonly(
          "fields", [](PythonSignal & signal) -> Typed<"dict[str, tuple[str, str, str]]"> {
            return signal.fields();
          },
          "{name: (type, unit, description)}")
      .def_property_readonly(
          "value",
          [](PythonSignal & signal) -> Typed<"vinerow.messages.Message"> { return signal.value(); },
          "A vinerow.Message of copies.")
      .def(
          "__getitem__",
          [](PythonSignal & signal, const TextArgument& field) -> Typed<"typing.Any"> {
            return signal.field(field.value("field"));
          },
          py::arg("field"),
          "One field of the last value.\n\nRaises KeyError without such a field, UsageError "
          "without a value or session.");
}

}  // namespace vinerow::python

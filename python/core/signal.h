#pragma once
/// vinerow.Signal: reads a signal of a session by the names of its fields.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "python/core/session.h"

namespace vinerow::python {

class PythonSignal {
 public:
  /// @throws ConfigError if the session has no such signal
  PythonSignal(std::shared_ptr<PythonSession> session, std::string name);

  const std::string& name() const { return name_; }
  std::string type();
  std::string writer();
  /// Writes so far by the present writer.
  std::uint64_t count();
  Time stamp();
  pybind11::dict fields();
  /// A view, if the address of the field's values cannot change, else a copy.
  pybind11::object field(const std::string& name);
  /// A copy of all fields.
  pybind11::object value();

 private:
  /// The signal of the session's present run.
  const SignalBase& present(PythonSession::Use& use);
  /// The same. @throws UsageError if it has no value yet
  const SignalBase& written(PythonSession::Use& use);

  std::shared_ptr<PythonSession> session_;
  std::string name_;
  const SignalBase* signal_ = nullptr;  ///< of the run with number run_
  std::uint64_t run_ = 0;
  pybind11::object owner_;  ///< keeps the memory of that run; null until the first view
};

void bind_signal(pybind11::module_& module);

}  // namespace vinerow::python

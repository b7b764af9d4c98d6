#include "python/core/part_life.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <atomic>
#include <filesystem>
#include <optional>
#include <utility>

#include "python/core/parts.h"
#include "python/core/usage_error.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

thread_local bool was_interrupted = false;
std::atomic<int> running_calls = 0;

}  // namespace

Held::~Held() {
  if (!Py_IsInitialized() || (_Py_IsFinalizing() && !PyGILState_Check())) return;
  const py::gil_scoped_acquire lock;
  Py_DECREF(object_);
}

void Life::demand(bool is_allowed, const std::string& what, const char* where) const {
  if (is_allowed && caller == std::this_thread::get_id()) return;
  throw UsageError(
      fmt::format("{} may be used only {}, in the thread that runs the part", what, where));
}

InCall::InCall(Life& life, Life::Stage stage, Time now) : life_(life) {
  life_.stage = stage;
  life_.caller = std::this_thread::get_id();
  life_.now = now;
  ++running_calls;
}

InCall::~InCall() {
  life_.stage = Life::Stage::kOutside;
  --running_calls;
}

bool is_part_called() {
  return running_calls > 0;
}

bool take_interruption() {
  return std::exchange(was_interrupted, false);
}

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

}  // namespace vinerow::python

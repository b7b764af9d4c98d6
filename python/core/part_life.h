#pragma once
/// When a part written in Python may use what belongs to its run, and the Python object that C++
/// owns.

#include <pybind11/pybind11.h>

#include <string>
#include <thread>

#include "engine/api/map.h"
#include "engine/api/vehicle.h"
#include "engine/core/time.h"

namespace vinerow::python {

/// A Python object owned by C++, released in any thread. After the interpreter's end nobody can
/// release it; the process then ends.
class Held {
 public:
  explicit Held(pybind11::object object) : object_(object.release().ptr()) {}
  ~Held();
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  pybind11::handle get() const { return object_; }

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

  /// @param what  and `where` are for the message
  /// @throws UsageError  unless `is_allowed` and in the thread of the call
  void demand(bool is_allowed, const std::string& what, const char* where) const;
};

/// Marks a call into a part.
class InCall {
 public:
  InCall(Life& life, Life::Stage stage, Time now);
  ~InCall();
  InCall(const InCall&) = delete;
  InCall& operator=(const InCall&) = delete;

 private:
  Life& life_;
};

/// A method of a part runs, in any thread.
bool is_part_called();

/// Text of an exception of a part, with the line of its file, e.g. "ZeroDivisionError: division by
/// zero (my_parts.py:42)". An interruption is noted.
std::string sentence_of(const pybind11::error_already_set& error, const std::string& file);

std::string type_of_value(const pybind11::handle& value);

}  // namespace vinerow::python

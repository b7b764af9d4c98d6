#pragma once
/// Values of messages as Python objects, from their field lists (engine/api/message.h).

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <functional>
#include <string>
#include <vector>

#include "engine/api/message.h"
#include "engine/api/signal.h"

namespace vinerow::python {

/// How arrays refer to the memory of a message.
enum class Memory {
  kView,  ///< read-only view of the message if the address of its values cannot change, else a copy
  kCopy   ///< own memory
};

/// vinerow.Pose of two arrays.
pybind11::object make_pose(pybind11::object position, pybind11::object orientation);

/// dtype of a kind that is one number.
pybind11::dtype number_dtype(FieldKind kind);

/// bool, int, float and str for single values; the name for an enumeration; arrays (3,) for vectors
/// and (4,) for quaternions (x, y, z, w); vinerow.Pose for poses; vinerow.Message for records.
/// Lists of these: arrays with one more axis, lists of str, and one Message whose fields are
/// columns.
/// @param owner  keeps the memory of views alive
pybind11::object to_python(const FieldView& view, const pybind11::object& owner, Memory memory);

/// The field of that name. @returns a null object if there is none
pybind11::object field_to_python(const SignalBase& signal, std::string_view name,
                                 const pybind11::object& owner, Memory memory);

/// Shows the fields of a message to a visitor, as SignalBase::describe does.
using Describe = std::function<void(FieldVisitor& visitor)>;
/// The same two of any message, with their own memory.
pybind11::object field_to_python(const Describe& describe, std::string_view name);
pybind11::object message_to_python(const char* type, const Describe& describe);
std::vector<std::string> field_names(const Describe& describe);

/// Names of the fields, in the order of the message.
std::vector<std::string> field_names(const SignalBase& signal);

/// {name: (type, unit, description)} of the fields.
pybind11::dict field_infos(const SignalBase& signal);

/// vinerow.Message of copies of all fields.
pybind11::object message_to_python(const SignalBase& signal);

}  // namespace vinerow::python

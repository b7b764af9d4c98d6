#include "python/core/fields_to_python.h"

namespace vinerow::python {
namespace py = pybind11;

py::object make_pose(py::object position, py::object orientation) {
  return py::module_::import("vinerow.messages")
      .attr("Pose")(std::move(position), std::move(orientation));
}

py::dtype number_dtype(FieldKind kind) {
  switch (kind) {
    case FieldKind::kBool:
      return py::dtype::of<bool>();
    case FieldKind::kInt8:
      return py::dtype::of<std::int8_t>();
    case FieldKind::kInt16:
      return py::dtype::of<std::int16_t>();
    case FieldKind::kInt32:
      return py::dtype::of<std::int32_t>();
    case FieldKind::kInt64:
      return py::dtype::of<std::int64_t>();
    case FieldKind::kUint8:
      return py::dtype::of<std::uint8_t>();
    case FieldKind::kUint16:
      return py::dtype::of<std::uint16_t>();
    case FieldKind::kUint32:
      return py::dtype::of<std::uint32_t>();
    case FieldKind::kUint64:
      return py::dtype::of<std::uint64_t>();
    case FieldKind::kFloat32:
      return py::dtype::of<float>();
    default:
      return py::dtype::of<double>();
  }
}

namespace {

/// Calls a function for each field of a message.
template <class F>
class EachField final : public FieldVisitor {
 public:
  explicit EachField(F& function) : function_(function) {}
  void field(const FieldView& view) override { function_(view); }

 private:
  F& function_;
};

template <class F>
void for_each_field(const Describe& describe, F function) {
  EachField<F> visitor(function);
  describe(visitor);
}

Describe fields_of(const SignalBase& signal) {
  return [&signal](FieldVisitor& visitor) { signal.describe(visitor); };
}

py::object find_field(const Describe& describe, std::string_view name, const py::object& owner,
                      Memory memory) {
  py::object found;
  for_each_field(describe, [&](const FieldView& view) {
    if (!found && view.info.name == name) found = to_python(view, owner, memory);
  });
  return found;
}

template <class F>
void for_each_field_of_record(const FieldView& view, std::size_t index, F function) {
  EachField<F> visitor(function);
  view.visit_record(view.data ? view.at(index) : nullptr, visitor);
}

py::object message_type() {
  return py::module_::import("vinerow.messages").attr("Message");
}

std::int64_t integer_at(const FieldView& view, std::size_t index) {
  switch (view.kind) {
    case FieldKind::kInt8:
      return view.value<std::int8_t>(index);
    case FieldKind::kInt16:
      return view.value<std::int16_t>(index);
    case FieldKind::kInt32:
      return view.value<std::int32_t>(index);
    case FieldKind::kInt64:
      return view.value<std::int64_t>(index);
    case FieldKind::kUint8:
      return view.value<std::uint8_t>(index);
    case FieldKind::kUint16:
      return view.value<std::uint16_t>(index);
    case FieldKind::kUint32:
      return view.value<std::uint32_t>(index);
    default:
      return static_cast<std::int64_t>(view.value<std::uint64_t>(index));
  }
}

py::object enum_to_python(const FieldView& view, std::size_t index) {
  const std::int64_t value = integer_at(view, index);
  for (const EnumName& name : view.names) {
    if (name.value == value) return py::str(name.name.data(), name.name.size());
  }
  return py::int_(value);
}

/// An array of doubles or other numbers at an address.
/// @param shape, strides  in values and bytes
py::object array_at(const py::dtype& dtype, const void* data, std::vector<py::ssize_t> shape,
                    std::vector<py::ssize_t> strides, const py::object& owner, Memory memory) {
  if (!data) return py::array(dtype, std::move(shape));
  if (memory == Memory::kCopy) return py::array(dtype, std::move(shape), std::move(strides), data);
  py::array view(dtype, std::move(shape), std::move(strides), data, owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

/// Number of doubles in a kind that is a vector of them, else 0.
int doubles_in(FieldKind kind) {
  return kind == FieldKind::kVector3 ? 3 : kind == FieldKind::kQuaternion ? 4 : 0;
}

const void* first_double(FieldKind kind, const void* value) {
  if (!value) return nullptr;
  if (kind == FieldKind::kVector3) return static_cast<const Eigen::Vector3d*>(value)->data();
  return static_cast<const Eigen::Quaterniond*>(value)->coeffs().data();
}

py::object doubles_at(FieldKind kind, const void* value, const py::object& owner, Memory memory) {
  return array_at(py::dtype::of<double>(), first_double(kind, value), {doubles_in(kind)},
                  {sizeof(double)}, owner, memory);
}

py::object single_to_python(const FieldView& view, const py::object& owner, Memory memory) {
  if (!view.names.empty()) return enum_to_python(view, 0);
  switch (view.kind) {
    case FieldKind::kBool:
      return py::bool_(view.value<bool>());
    case FieldKind::kFloat32:
      return py::float_(view.value<float>());
    case FieldKind::kFloat64:
      return py::float_(view.value<double>());
    case FieldKind::kUint64:
      return py::int_(view.value<std::uint64_t>());
    case FieldKind::kText:
      return py::str(view.value<std::string>());
    case FieldKind::kVector3:
    case FieldKind::kQuaternion:
      return doubles_at(view.kind, view.data, owner, memory);
    case FieldKind::kPose: {
      const auto& pose = view.value<Pose>();
      return make_pose(doubles_at(FieldKind::kVector3, &pose.p, owner, memory),
                       doubles_at(FieldKind::kQuaternion, &pose.q, owner, memory));
    }
    case FieldKind::kRecord: {
      py::object message = message_type()(py::str(view.record.data(), view.record.size()));
      for_each_field_of_record(view, 0, [&](const FieldView& inner) {
        message[py::str(inner.info.name.data(), inner.info.name.size())] =
            to_python(inner, owner, memory);
      });
      return message;
    }
    default:
      return py::int_(integer_at(view, 0));
  }
}

/// Columns of a list of records: one value per field, with one entry per record.
py::object columns_of(const FieldView& view) {
  py::object message = message_type()(py::str(view.record.data(), view.record.size()));
  const py::object none = py::none();
  std::vector<py::str> names;
  std::vector<py::list> columns;
  std::vector<bool> numeric;
  for_each_field_of_record(view, 0, [&](const FieldView& inner) {
    names.emplace_back(inner.info.name.data(), inner.info.name.size());
    columns.emplace_back();
    numeric.push_back(inner.shape != FieldShape::kSequence && inner.names.empty() &&
                      inner.kind != FieldKind::kText && inner.kind != FieldKind::kRecord &&
                      inner.kind != FieldKind::kPose);
  });
  for (std::size_t i = 0; i < view.count; ++i) {
    std::size_t column = 0;
    for_each_field_of_record(view, i, [&](const FieldView& inner) {
      columns[column++].append(to_python(inner, none, Memory::kCopy));
    });
  }
  const py::object array = py::module_::import("numpy").attr("array");
  for (std::size_t k = 0; k < names.size(); ++k) {
    message[names[k]] = numeric[k] ? array(columns[k]) : py::object(columns[k]);
  }
  return message;
}

py::object list_to_python(const FieldView& view, const py::object& owner, Memory memory) {
  // A vector may move its values with the next write; an array cannot.
  if (view.shape == FieldShape::kSequence) memory = Memory::kCopy;
  const auto count = static_cast<py::ssize_t>(view.count);
  const auto stride = static_cast<py::ssize_t>(view.stride);
  if (view.kind == FieldKind::kText || !view.names.empty()) {
    py::list texts;
    for (std::size_t i = 0; i < view.count; ++i) {
      texts.append(view.names.empty() ? py::object(py::str(view.value<std::string>(i)))
                                      : enum_to_python(view, i));
    }
    return texts;
  }
  switch (view.kind) {
    case FieldKind::kRecord:
      return columns_of(view);
    case FieldKind::kVector3:
    case FieldKind::kQuaternion:
      return array_at(py::dtype::of<double>(), first_double(view.kind, view.data),
                      {count, doubles_in(view.kind)}, {stride, sizeof(double)}, owner, memory);
    case FieldKind::kPose: {
      const auto* first = static_cast<const Pose*>(view.data);
      return make_pose(array_at(py::dtype::of<double>(), first ? first->p.data() : nullptr,
                                {count, 3}, {stride, sizeof(double)}, owner, memory),
                       array_at(py::dtype::of<double>(), first ? first->q.coeffs().data() : nullptr,
                                {count, 4}, {stride, sizeof(double)}, owner, memory));
    }
    default:
      return array_at(number_dtype(view.kind), view.data, {count}, {stride}, owner, memory);
  }
}

std::string type_name(const FieldView& view) {
  static constexpr const char* kNames[] = {"bool",    "int8",   "int16",  "int32",      "int64",
                                           "uint8",   "uint16", "uint32", "uint64",     "float32",
                                           "float64", "str",    "vector", "quaternion", "pose"};
  std::string name = !view.names.empty()               ? "enum"
                     : view.kind == FieldKind::kRecord ? std::string(view.record)
                                                       : kNames[static_cast<int>(view.kind)];
  if (view.shape == FieldShape::kArray) name += "[" + std::to_string(view.count) + "]";
  if (view.shape == FieldShape::kSequence) name += "[]";
  return name;
}

}  // namespace

py::object to_python(const FieldView& view, const py::object& owner, Memory memory) {
  if (view.shape == FieldShape::kSingle) return single_to_python(view, owner, memory);
  return list_to_python(view, owner, memory);
}

py::object field_to_python(const SignalBase& signal, std::string_view name, const py::object& owner,
                           Memory memory) {
  return find_field(fields_of(signal), name, owner, memory);
}

py::object field_to_python(const Describe& describe, std::string_view name) {
  return find_field(describe, name, py::none(), Memory::kCopy);
}

std::vector<std::string> field_names(const Describe& describe) {
  std::vector<std::string> names;
  for_each_field(describe, [&](const FieldView& view) { names.emplace_back(view.info.name); });
  return names;
}

std::vector<std::string> field_names(const SignalBase& signal) {
  return field_names(fields_of(signal));
}

py::dict field_infos(const SignalBase& signal) {
  py::dict infos;
  for_each_field(fields_of(signal), [&](const FieldView& view) {
    infos[py::str(view.info.name.data(), view.info.name.size())] =
        py::make_tuple(type_name(view), std::string(view.info.unit), std::string(view.info.words));
  });
  return infos;
}

py::object message_to_python(const char* type, const Describe& describe) {
  py::object message = message_type()(type);
  const py::object none = py::none();
  for_each_field(describe, [&](const FieldView& view) {
    message[py::str(view.info.name.data(), view.info.name.size())] =
        to_python(view, none, Memory::kCopy);
  });
  return message;
}

py::object message_to_python(const SignalBase& signal) {
  return message_to_python(signal.type(), fields_of(signal));
}

}  // namespace vinerow::python

#include "python/core/message_codec.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "engine/api/messages.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

[[noreturn]] void refuse(const std::string& place, const std::string& sentence) {
  throw ConfigError(place + " " + sentence);
}

std::string type_of(const py::handle& value) {
  return py::str(py::type::handle_of(value).attr("__name__"));
}

/// Converts with Python's own rules and turns its exception into a sentence.
template <class T>
T cast_to(const py::handle& value, const std::string& place, const char* wanted) {
  try {
    return value.cast<T>();
  } catch (const py::cast_error&) {
    refuse(place, fmt::format("must be {}, not {}", wanted, type_of(value)));
  }
}

/// One-dimensional doubles. @param count  required number, or 0
py::array_t<double> doubles(const py::handle& value, std::size_t count, const std::string& place) {
  auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(
      py::reinterpret_borrow<py::object>(value));
  if (!array) {
    PyErr_Clear();
    refuse(place, fmt::format("must be numbers, not {}", type_of(value)));
  }
  if (array.ndim() != 1) {
    refuse(place, fmt::format("must have one axis, not {}", array.ndim()));
  }
  if (count && static_cast<std::size_t>(array.size()) != count) {
    refuse(place, fmt::format("must have {} numbers, not {}", count, array.size()));
  }
  return array;
}

template <HasFields T>
void read_fields(T& message, const py::handle& value, const std::string& place);

void read_value(bool& to, const py::handle& value, const std::string& place) {
  to = cast_to<bool>(value, place, "a bool");
}
template <class T>
requires std::is_arithmetic_v<T>
void read_value(T& to, const py::handle& value, const std::string& place) {
  if constexpr (std::is_integral_v<T>) {
    to = cast_to<T>(value, place, "an int");
  } else {
    to = static_cast<T>(cast_to<double>(value, place, "a number"));
  }
}
template <class T>
requires std::is_enum_v<T>
void read_value(T& to, const py::handle& value, const std::string& place) {
  const auto text = cast_to<std::string>(value, place, "the name of a value");
  std::vector<std::string> known;
  for (const EnumName& name : enum_names(T{})) {
    if (name.name == text) {
      to = static_cast<T>(name.value);
      return;
    }
    known.emplace_back(name.name);
  }
  refuse(place, fmt::format("= '{}' is unknown{} (known: {})", text, did_you_mean(text, known),
                            join(known)));
}
void read_value(std::string& to, const py::handle& value, const std::string& place) {
  to = cast_to<std::string>(value, place, "a str");
}
void read_value(Eigen::Vector3d& to, const py::handle& value, const std::string& place) {
  const auto array = doubles(value, 3, place);
  to = Eigen::Map<const Eigen::Vector3d>(array.data());
}
void read_value(Eigen::Quaterniond& to, const py::handle& value, const std::string& place) {
  const auto array = doubles(value, 4, place);
  to.coeffs() = Eigen::Map<const Eigen::Vector4d>(array.data());
}
void read_value(Pose& to, const py::handle& value, const std::string& place) {
  if (!py::hasattr(value, "position") || !py::hasattr(value, "orientation")) {
    refuse(place, fmt::format("must be a vinerow.Pose, not {}", type_of(value)));
  }
  read_value(to.p, value.attr("position"), place + ".position");
  read_value(to.q, value.attr("orientation"), place + ".orientation");
}
template <HasFields T>
void read_value(T& to, const py::handle& value, const std::string& place) {
  read_fields(to, value, place);
}

/// Element of a list, for its place in errors.
py::sequence sequence_of(const py::handle& value, const std::string& place) {
  if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value)) {
    refuse(place, fmt::format("must be a list, not {}", type_of(value)));
  }
  return py::reinterpret_borrow<py::sequence>(value);
}

template <class T, std::size_t kCount>
void read_value(std::array<T, kCount>& to, const py::handle& value, const std::string& place) {
  const py::sequence list = sequence_of(value, place);
  if (list.size() != kCount) {
    refuse(place, fmt::format("must have {} values, not {}", kCount, list.size()));
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    read_value(to[i], py::object(list[i]), fmt::format("{}[{}]", place, i));
  }
}
template <class T>
void read_value(std::vector<T>& to, const py::handle& value, const std::string& place) {
  if constexpr (std::is_same_v<T, double>) {
    const auto array = doubles(value, 0, place);
    to.assign(array.data(), array.data() + array.size());
  } else {
    const py::sequence list = sequence_of(value, place);
    to.resize(list.size());
    for (std::size_t i = 0; i < to.size(); ++i) {
      read_value(to[i], py::object(list[i]), fmt::format("{}[{}]", place, i));
    }
  }
}

struct ReadField {
  const py::dict& values;
  const std::string& place;
  std::size_t& used;
  std::vector<std::string>& known;

  template <class T>
  void operator()(const FieldInfo& info, T& to) const {
    known.emplace_back(info.name);
    const py::str key(info.name.data(), info.name.size());
    if (!values.contains(key)) return;
    ++used;
    read_value(to, values[key], fmt::format("{}.{}", place, info.name));
  }
};

template <HasFields T>
void read_fields(T& message, const py::handle& value, const std::string& place) {
  if (!py::isinstance<py::dict>(value)) {
    refuse(place,
           fmt::format("must be a dict of the fields of {}, not {}", T::kType, type_of(value)));
  }
  const auto values = py::reinterpret_borrow<py::dict>(value);
  std::size_t used = 0;
  std::vector<std::string> known;
  T::fields(message, ReadField{values, place, used, known});
  if (used == values.size()) return;
  for (const auto& [key, entry] : values) {
    const std::string name = py::str(key);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      refuse(place, fmt::format("has no field '{}'{} (known: {})", name, did_you_mean(name, known),
                                join(known)));
    }
  }
}

/// Named numbers are a dict {name: number} in Python.
void read_fields(NamedValues& message, const py::handle& value, const std::string& place) {
  if (!py::isinstance<py::dict>(value)) {
    refuse(place, fmt::format("must be a dict of names and numbers, not {}", type_of(value)));
  }
  for (const auto& [key, number] : py::reinterpret_borrow<py::dict>(value)) {
    message.names.push_back(cast_to<std::string>(key, place, "a dict whose keys are str"));
    message.values.push_back(
        cast_to<double>(number, fmt::format("{}['{}']", place, message.names.back()), "a number"));
  }
}

template <class T>
class ReaderOf final : public AnyReader {
 public:
  explicit ReaderOf(SignalReader<T> reader) : reader_(reader) {}
  std::uint64_t count() const override { return reader_.sequence(); }
  Time stamp() const override { return reader_.stamp(); }
  void describe(FieldVisitor& visitor) const override { visit_fields(reader_.value(), visitor); }

 private:
  SignalReader<T> reader_;
};

template <class T>
class WriterOf final : public AnyWriter {
 public:
  WriterOf(SignalWriter<T> writer, std::string name) : writer_(writer), name_(std::move(name)) {}
  std::vector<std::string> write(Time stamp, const py::handle& value) override {
    T message;
    read_fields(message, value, name_);
    if (has_nan_field(message)) throw ConfigError(name_ + " contains NaN");
    writer_.write(stamp, message);
    if constexpr (std::is_same_v<T, NamedValues>) return std::move(message.names);
    return {};
  }

 private:
  SignalWriter<T> writer_;
  std::string name_;
};

template <class T>
MessageCodec codec_of() {
  return {T::kType, [](std::string signal) { return outside_signal<T>(std::move(signal)); },
          [](const std::string& signal, Time stamp, const py::handle& value) {
            T message;
            read_fields(message, value, signal);
            return outside_command<T>(signal, stamp, message);
          },
          [](Ports& ports, const std::string& name, bool optional) {
            auto reader = optional ? ports.read_optional<T>(name) : ports.read<T>(name);
            return std::unique_ptr<AnyReader>(std::make_unique<ReaderOf<T>>(reader));
          },
          [](Ports& ports, const std::string& name) {
            return std::unique_ptr<AnyWriter>(
                std::make_unique<WriterOf<T>>(ports.write<T>(name), name));
          }};
}

const std::map<std::string_view, MessageCodec>& codecs() {
  static const auto all = [] {
    std::map<std::string_view, MessageCodec> map;
    for_each_message_type([&]<class T>(T*) { map.emplace(T::kType, codec_of<T>()); });
    return map;
  }();
  return all;
}

}  // namespace

const MessageCodec* find_codec(std::string_view type) {
  const auto found = codecs().find(type);
  return found == codecs().end() ? nullptr : &found->second;
}

PlannedPath path_from_python(const py::handle& value, const std::string& place) {
  PlannedPath path;
  read_fields(path, value, place);
  return path;
}

std::vector<std::string> message_types() {
  std::vector<std::string> names;
  for (const auto& [name, codec] : codecs()) names.emplace_back(name);
  return names;
}

std::string_view outside_type(std::string_view signal) {
  const std::string_view what = signal.substr(signal.rfind('/') + 1);
  if (what == "actuators") return NamedValues::kType;
  if (what == "plan") return PlannedPath::kType;
  if (what == "authority") return MovementAuthority::kType;
  return {};
}

}  // namespace vinerow::python

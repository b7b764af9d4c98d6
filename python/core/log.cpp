#include "python/core/log.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/messages.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/record/log_reader.h"
#include "python/core/arguments.h"
#include "python/core/fields_to_python.h"
#include "python/core/run.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

struct PythonLog {
  explicit PythonLog(const std::filesystem::path& path) : file(path), reader(path) {}
  std::filesystem::path file;
  record::LogReader reader;
};

/// Collects one field of many messages.
class Column {
 public:
  explicit Column(const FieldView& view) : first_(view), name_(view.info.name) {}
  const std::string& name() const { return name_; }

  /// Single numbers, vectors, quaternions and poses are kept as bytes, other values as objects.
  void add(const FieldView& view) {
    if (!is_plain()) {
      objects_.append(to_python(view, py::none(), Memory::kCopy));
      return;
    }
    if (first_.kind == FieldKind::kPose) {
      const auto& pose = view.value<Pose>();
      append(pose.p.data(), 3 * sizeof(double));
      append(pose.q.coeffs().data(), 4 * sizeof(double));
    } else {
      append(view.data, view.stride);
    }
    ++count_;
  }

  py::object array() const {
    if (!is_plain()) return objects_;
    switch (first_.kind) {
      case FieldKind::kVector3:
        return doubles(0, 3, 3);
      case FieldKind::kQuaternion:
        return doubles(0, 4, 4);
      case FieldKind::kPose:
        return make_pose(doubles(0, 3, 7), doubles(3, 4, 7));
      default:
        return py::array(number_dtype(first_.kind), {count_}, bytes_.data());
    }
  }

 private:
  bool is_plain() const {
    return first_.shape == FieldShape::kSingle && first_.names.empty() &&
           first_.kind != FieldKind::kText && first_.kind != FieldKind::kRecord;
  }
  void append(const void* data, std::size_t size) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    std::memcpy(bytes_.data() + at, data, size);
  }
  /// A copy of some of the doubles of each message.
  py::array doubles(std::size_t first, py::ssize_t used, std::size_t per_message) const {
    const auto stride = static_cast<py::ssize_t>(per_message * sizeof(double));
    return py::array(py::dtype::of<double>(), {count_, used}, {stride, py::ssize_t{sizeof(double)}},
                     bytes_.data() + first * sizeof(double));
  }

  FieldView first_;
  std::string name_;
  std::vector<std::byte> bytes_;
  py::ssize_t count_ = 0;
  py::list objects_;
};

/// Adds the fields of one message after the other to their columns.
class Columns final : public FieldVisitor {
 public:
  void field(const FieldView& view) override {
    if (next_ == columns_.size()) columns_.emplace_back(view);
    columns_[next_++].add(view);
  }
  void end_message() { next_ = 0; }
  py::object message(const char* type, const std::vector<double>& stamps_s) const {
    py::object message = py::module_::import("vinerow.messages").attr("Message")(type);
    message["stamp_s"] = py::array(static_cast<py::ssize_t>(stamps_s.size()), stamps_s.data());
    for (const Column& column : columns_) message[py::str(column.name())] = column.array();
    return message;
  }

 private:
  std::vector<Column> columns_;
  std::size_t next_ = 0;
};

/// A topic whose messages are collected when a pass runs.
struct Collected {
  std::string name;  ///< as the caller wrote it
  const char* type;
  Columns columns;
  std::vector<double> stamps_s;
};

const record::ChannelInfo& channel(const record::LogReader& log, const std::string& name) {
  std::vector<std::string> known;
  for (const record::ChannelInfo& info : log.info().channels) {
    const auto signal = info.metadata.find("signal");
    if (info.metadata.count("exact_of")) continue;
    if (info.topic == name || (signal != info.metadata.end() && signal->second == name))
      return info;
    known.push_back(signal == info.metadata.end() ? info.topic : signal->second);
  }
  throw py::key_error(fmt::format("the log has no topic '{}'{} (known: {})", name,
                                  did_you_mean(name, known), join(known)));
}

/// Makes the pass collect a topic. @throws KeyError, ConfigError
std::unique_ptr<Collected> collect(const record::LogReader& log, const std::string& name,
                                   record::LogPass& pass) {
  const record::ChannelInfo& info = channel(log, name);
  const auto type = info.metadata.find("vinerow_type");
  std::unique_ptr<Collected> topic;
  if (type != info.metadata.end()) {
    for_each_message_type([&]<class T>(T*) {
      if (type->second != T::kType) return;
      topic = std::make_unique<Collected>(Collected{name, T::kType, {}, {}});
      pass.read<T>(info.topic, [to = topic.get()](Time stamp, const T& message) {
        to->stamps_s.push_back(stamp.nearest_s());
        visit_fields(message, to->columns);
        to->columns.end_message();
      });
    });
  }
  if (!topic) {
    throw ConfigError(fmt::format(
        "topic '{}' has messages of {}, which are not vinerow's: read them with the package mcap",
        info.topic, info.schema));
  }
  return topic;
}

Typed<"vinerow.messages.Message"> read_one(const PythonLog& log, const TextArgument& topic) {
  record::LogPass pass(log.reader);
  const auto collected = collect(log.reader, topic.value("topic"), pass);
  pass.run();
  return collected->columns.message(collected->type, collected->stamps_s);
}

Typed<"dict[str, vinerow.messages.Message]"> read_several(
    const PythonLog& log, const Typed<"collections.abc.Iterable[str]">& topics) {
  if (py::isinstance<py::str>(topics) || !py::isinstance<py::iterable>(topics)) {
    throw ConfigError(fmt::format("topics must be a list of names, not {}", type_name_of(topics)));
  }
  record::LogPass pass(log.reader);
  std::vector<std::unique_ptr<Collected>> collected;
  for (const py::handle& topic : topics) {
    const TextArgument name{py::reinterpret_borrow<py::object>(topic)};
    collected.push_back(collect(log.reader, name.value("a topic"), pass));
  }
  pass.run();
  py::dict messages;
  for (const std::unique_ptr<Collected>& topic : collected) {
    messages[py::str(topic->name)] = topic->columns.message(topic->type, topic->stamps_s);
  }
  return messages;
}

Typed<"dict[str, tuple[str, int]]"> topics(const PythonLog& log) {
  py::dict dict;
  for (const record::ChannelInfo& info : log.reader.info().channels) {
    if (info.metadata.count("exact_of")) continue;
    const auto signal = info.metadata.find("signal");
    const auto type = info.metadata.find("vinerow_type");
    dict[py::str(signal == info.metadata.end() ? info.topic : signal->second)] =
        py::make_tuple(type == info.metadata.end() ? info.schema : type->second, info.messages);
  }
  return dict;
}

/// A property that is a part of the log's information.
template <class F>
auto info_of(F read) {
  return [read](const PythonLog& log) { return read(log.reader.info()); };
}

}  // namespace

void bind_log(py::module_& module) {
  using record::LogInfo;
  py::class_<PythonLog>(module, "Log", R"(A log of a run, by topic.

log["rover/truth"] reads all messages of a signal: a Message with `stamp_s` (n,) and one column per field.)")
      .def(py::init([](const PathArgument& file) {
             return std::make_unique<PythonLog>(file.value("file"));
           }),
           py::arg("file"))
      .def("__getitem__", &read_one, py::arg("topic"))
      .def("read", &read_several, py::arg("topics"),
           "{topic: Message} of several signals. Reads the file once, not once for each.")
      .def(
          "__contains__",
          [](const PythonLog& log, const py::object& name) { return topics(log).contains(name); },
          py::arg("topic"))
      .def("topics", &topics, "{name: (type, number of messages)}")
      .def(
          "render_at",
          [](const PythonLog& log, const std::vector<double>& times_s, const py::object& camera,
             std::optional<int> width, std::optional<int> height) {
            return render(log.file, times_s, camera, width, height);
          },
          py::arg("times_s"), py::arg("camera"), py::arg("width"), py::arg("height"),
          "Pictures (h, w, 3) at increasing times.")
      .def_property_readonly("file", [](const PythonLog& log) { return log.file.string(); })
      .def_property_readonly("complete", info_of([](const LogInfo& info) { return info.complete; }),
                             "False if the run was interrupted.")
      .def_property_readonly("warnings", info_of([](const LogInfo& info) { return info.warnings; }),
                             "Sentences about damaged parts of the file.")
      .def_property_readonly("metadata", info_of([](const LogInfo& info) { return info.metadata; }),
                             "{key: text} about the run: scenario, seed, version.")
      .def_property_readonly("first_s",
                             info_of([](const LogInfo& info) { return info.first.nearest_s(); }),
                             "Simulated time of the first message.")
      .def_property_readonly("last_s",
                             info_of([](const LogInfo& info) { return info.last.nearest_s(); }),
                             "Simulated time of the last message.");
}

}  // namespace vinerow::python

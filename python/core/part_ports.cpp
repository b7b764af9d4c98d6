#include "python/core/part_ports.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "engine/api/messages.h"
#include "engine/api/vehicle.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "python/core/arguments.h"
#include "python/core/usage_error.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

/// Type of the message that a signal of this name has in every vehicle; empty if names differ.
std::string_view usual_type(std::string_view signal) {
  const std::string_view what = signal.substr(signal.rfind('/') + 1);
  if (what == "truth" || what == "estimate") return Odometry::kType;
  if (what == "command") return VelocityCommand::kType;
  if (what == "local_command") return LocalCommand::kType;
  if (what == "follower") return FollowerState::kType;
  return outside_type(signal);
}

}  // namespace

PartReader::PartReader(std::shared_ptr<Life> life, std::string name, const char* type,
                       std::unique_ptr<AnyReader> reader)
    : life_(std::move(life)), name_(std::move(name)), type_(type), reader_(std::move(reader)) {}

std::uint64_t PartReader::count() const {
  return checked().count();
}

double PartReader::stamp_s() const {
  return written().stamp().s();
}

py::object PartReader::value() const {
  return message_to_python(type_, describe());
}

py::object PartReader::field(const std::string& name) const {
  if (py::object found = field_to_python(describe(), name)) return found;
  const auto known = field_names(describe());
  throw py::key_error(fmt::format("signal '{}' has no field '{}'{} (known: {})", name_, name,
                                  did_you_mean(name, known), join(known)));
}

const AnyReader& PartReader::checked() const {
  life_->demand(life_->stage == Life::Stage::kWorking, fmt::format("reader '{}'", name_),
                "in step()");
  return *reader_;
}

const AnyReader& PartReader::written() const {
  const AnyReader& reader = checked();
  if (reader.count() == 0) {
    throw UsageError(fmt::format("signal '{}' has no value yet; ask has_value first", name_));
  }
  return reader;
}

Describe PartReader::describe() const {
  return [&reader = written()](FieldVisitor& visitor) { reader.describe(visitor); };
}

PartWriter::PartWriter(std::shared_ptr<Life> life, std::string name,
                       std::unique_ptr<AnyWriter> writer)
    : life_(std::move(life)), name_(std::move(name)), writer_(std::move(writer)) {}

void PartWriter::write(const py::handle& value) {
  life_->demand(life_->stage == Life::Stage::kWorking, fmt::format("writer '{}'", name_),
                "in step()");
  const std::vector<std::string> names = writer_->write(life_->now, value);
  if (name_ != "actuators" || names == known_names_) return;
  for (const std::string& actuator : names) {
    static_cast<void>(life_->vehicle->actuator_index(actuator, life_->part));
  }
  known_names_ = names;
}

PartPorts::PartPorts(std::shared_ptr<Life> life, Ports& ports)
    : life_(std::move(life)), ports_(&ports) {}

PartReader PartPorts::read(const std::string& name, const std::string& type, bool optional) {
  const MessageCodec& codec = codec_for(name, type);
  return PartReader(life_, name, codec.name, codec.read(*ports_, name, optional));
}

PartWriter PartPorts::write(const std::string& name, const std::string& type) {
  return PartWriter(life_, name, codec_for(name, type).write(*ports_, name));
}

const MessageCodec& PartPorts::codec_for(const std::string& name, const std::string& type) const {
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

void bind_part_ports(py::module_& module) {
  py::class_<PartReader>(module, "PartReader", "A signal as a part reads it; only in its step().")
      .def_property_readonly("has_value",
                             [](const PartReader& reader) { return reader.count() > 0; })
      .def_property_readonly("count", &PartReader::count, "Number of writes so far.")
      .def_property_readonly("stamp_s", &PartReader::stamp_s, "Time of the value, s.")
      .def_property_readonly("value", &PartReader::value, "A vinerow.Message of copies.")
      .def(
          "__getitem__",
          [](const PartReader& reader, const TextArgument& field) {
            return reader.field(field.value("field"));
          },
          py::arg("field"),
          "A copy of one field. Raises KeyError without such a field, UsageError without a value.");
  py::class_<PartWriter>(module, "PartWriter", "A signal as a part writes it; only in its step().")
      .def("write", &PartWriter::write, py::arg("value"),
           "{name: number} for actuators, else {field: value}; fields that are absent keep their "
           "default. Raises ConfigError.");
  py::class_<PartPorts>(module, "PartPorts", "Where a part connects its signals.")
      .def(
          "read",
          [](PartPorts& ports, const TextArgument& name, const TextArgument& type, bool optional) {
            return ports.read(name.value("name"), type.value("type"), optional);
          },
          py::arg("name"), py::arg("type") = "", py::arg("optional") = false)
      .def(
          "write",
          [](PartPorts& ports, const TextArgument& name, const TextArgument& type) {
            return ports.write(name.value("name"), type.value("type"));
          },
          py::arg("name"), py::arg("type") = "");
}

}  // namespace vinerow::python

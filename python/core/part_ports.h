#pragma once
/// What a part written in Python gets in connect(): readers and writers of signals.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "python/core/fields_to_python.h"
#include "python/core/message_codec.h"
#include "python/core/part_life.h"

namespace vinerow::python {

/// A signal as a part reads it; only in its step().
class PartReader {
 public:
  PartReader(std::shared_ptr<Life> life, std::string name, const char* type,
             std::unique_ptr<AnyReader> reader);

  std::uint64_t count() const;
  double stamp_s() const;
  pybind11::object value() const;
  pybind11::object field(const std::string& name) const;

 private:
  const AnyReader& checked() const;
  const AnyReader& written() const;
  Describe describe() const;

  std::shared_ptr<Life> life_;
  std::string name_;
  const char* type_;
  std::unique_ptr<AnyReader> reader_;
};

/// A signal as a part writes it; only in its step().
class PartWriter {
 public:
  PartWriter(std::shared_ptr<Life> life, std::string name, std::unique_ptr<AnyWriter> writer);

  /// @throws ConfigError  for what the message or the vehicle has not
  void write(const pybind11::handle& value);

 private:
  std::shared_ptr<Life> life_;
  std::string name_;
  std::unique_ptr<AnyWriter> writer_;
  std::vector<std::string> known_names_;  ///< that the vehicle has
};

class PartPorts {
 public:
  PartPorts(std::shared_ptr<Life> life, Ports& ports);

  /// @param type  of the message; may be empty where the name determines it
  /// @throws ConfigError, UsageError
  PartReader read(const std::string& name, const std::string& type, bool optional);
  PartWriter write(const std::string& name, const std::string& type);

 private:
  const MessageCodec& codec_for(const std::string& name, const std::string& type) const;

  std::shared_ptr<Life> life_;
  Ports* ports_;
};

void bind_part_ports(pybind11::module_& module);

}  // namespace vinerow::python

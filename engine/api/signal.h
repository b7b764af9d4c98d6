#pragma once
/// Typed, time-stamped signals and the bus that owns them.
///
/// A signal has one writer and any number of readers. Its name is "<vehicle>/<what>" ("rover/gps")
/// or "run/<what>". Readers see the last value written (zero-order hold) with its time. Connecting
/// checks names and types, so a wrong wire is an error while loading.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/api/message.h"
#include "engine/core/check.h"
#include "engine/core/hash.h"
#include "engine/core/time.h"

namespace vinerow {

/// Writer of signals that programs outside the run write (outside.h), in lists and errors.
inline constexpr const char* kOutside = "outside";

class SignalBase {
 public:
  SignalBase(std::string name, const MessageType& type) : name_(std::move(name)), type_(type) {}
  virtual ~SignalBase() = default;
  SignalBase(const SignalBase&) = delete;
  SignalBase& operator=(const SignalBase&) = delete;

  const std::string& name() const { return name_; }
  /// kType of its message.
  const char* type() const { return type_.name; }
  const MessageType& message_type() const { return type_; }
  Time stamp() const { return stamp_; }
  /// Number of writes so far; 0 = never written.
  std::uint64_t sequence() const { return sequence_; }
  /// Number of writes that readers no longer see (SignalBus::release()).
  std::uint64_t forgotten() const { return forgotten_; }
  const std::string& writer() const { return writer_; }
  const std::string& first_reader() const { return first_reader_; }
  /// Name of the signal in whose frame this one is, for what a part computes from a sensor's
  /// reading, e.g. "rover/front"; empty: its frame is the one of its own name.
  const std::string& frame_source() const { return frame_source_; }
  /// True if the signal has a reader, also an optional one.
  bool is_read() const { return is_read_; }

  /// Adds name, time and value to the digest of the run.
  virtual void hash_into(Hasher& hasher) const = 0;
  /// True if any field is NaN. Infinity is allowed: it means "nothing seen".
  virtual bool has_nan() const = 0;
  /// Passes every field of the value to the visitor: name, unit, type and address. Nothing is
  /// copied. Views are valid until the next write. No heap.
  virtual void describe(FieldVisitor& visitor) const = 0;

 protected:
  friend class SignalBus;
  std::string name_;
  MessageType type_;
  Time stamp_;
  std::uint64_t sequence_ = 0;
  std::uint64_t forgotten_ = 0;
  std::string writer_;
  std::string frame_source_;
  std::string first_reader_;
  bool is_read_ = false;
};

/// @tparam T  a message (field.h), built-in or from a plug-in
template <class T>
class Signal final : public SignalBase {
 public:
  explicit Signal(std::string name) : SignalBase(std::move(name), vinerow::message_type<T>()) {}

  const T& value() const { return value_; }
  /// Writes in place: no allocation if vectors keep their size.
  void write(Time stamp, const T& value) {
    value_ = value;
    stamp_ = stamp;
    ++sequence_;
  }
  void hash_into(Hasher& hasher) const override {
    hasher.add(std::string_view(name_));
    hasher.add(stamp_.ns);
    hash_fields(value_, hasher);
  }
  bool has_nan() const override { return has_nan_field(value_); }
  void describe(FieldVisitor& visitor) const override { visit_fields(value_, visitor); }

 private:
  T value_{};
};

/// True if the signal's message is T: same name and same layout.
template <class T>
bool is_message(const SignalBase& signal) {
  const MessageType& type = message_type<T>();
  return std::string_view(signal.type()) == type.name &&
         signal.message_type().layout == type.layout;
}

/// Handle with which a part reads a signal. Cheap to copy; valid as long as the bus.
template <class T>
class SignalReader {
 public:
  SignalReader() = default;
  explicit SignalReader(const Signal<T>* signal) : signal_(signal) {}
  bool connected() const { return signal_ != nullptr; }
  bool has_value() const { return sequence() > 0; }
  const T& value() const {
    VINEROW_ASSERT(has_value());
    return signal_->value();
  }
  Time stamp() const { return signal_->stamp(); }
  /// Number of writes by the current writer.
  std::uint64_t sequence() const {
    return signal_ ? signal_->sequence() - signal_->forgotten() : 0;
  }
  /// True once per write if called regularly: whether there is a write newer than `seen`.
  bool is_newer_than(std::uint64_t& seen) const {
    if (sequence() == seen) return false;
    seen = sequence();
    return true;
  }

 private:
  const Signal<T>* signal_ = nullptr;
};

/// Handle with which a part writes a signal.
template <class T>
class SignalWriter {
 public:
  SignalWriter() = default;
  explicit SignalWriter(Signal<T>* signal) : signal_(signal) {}
  bool connected() const { return signal_ != nullptr; }
  void write(Time stamp, const T& value) {
    VINEROW_ASSERT(signal_ != nullptr);
    signal_->write(stamp, value);
  }

 private:
  Signal<T>* signal_ = nullptr;
};

class SignalBus {
 public:
  /// @param frame_source  see SignalBase::frame_source()
  /// @throws ConfigError if the name has a writer already or another type.
  template <class T>
  SignalWriter<T> advertise(const std::string& name, const std::string& writer,
                            const std::string& frame_source = {});

  /// The signal may be advertised later; check_connected() finds those that never were.
  /// @throws ConfigError if the name has another type.
  template <class T>
  SignalReader<T> subscribe(const std::string& name, const std::string& reader);

  /// Like subscribe, but a signal without a writer is no error: the reader then never has a value.
  template <class T>
  SignalReader<T> subscribe_optional(const std::string& name, const std::string& reader);

  /// Like subscribe, for a signal that programs outside the run write. Until they do, the reader
  /// has no value. @throws ConfigError if a part writes the signal, or the name has another type.
  template <class T>
  SignalReader<T> subscribe_outside(const std::string& name, const std::string& reader);

  /// @throws ConfigError "rover.controller reads signal 'rover/estimat', which nobody writes; did
  /// you mean ...?"
  void check_connected() const;

  /// Releases the signals written so far by the parts below `part` ("rover": "rover.controller",
  /// "rover.sensors.gps"), so that other parts can write them. Until they do, readers see no value.
  void release(std::string_view part);

  /// Signals in order of creation, which is the same in every run.
  const std::vector<std::unique_ptr<SignalBase>>& signals() const { return signals_; }
  /// @returns nullptr if there is no such signal
  SignalBase* find(std::string_view name) const;

 private:
  SignalBase& slot(const std::string& name, const MessageType& type, const std::string& who,
                   std::unique_ptr<SignalBase> (*make)(const std::string&));
  void set_writer(SignalBase& signal, const std::string& writer);
  void set_reader(SignalBase& signal, const std::string& reader);

  std::vector<std::unique_ptr<SignalBase>> signals_;
  std::map<std::string, SignalBase*, std::less<>> by_name_;
};

template <class T>
SignalWriter<T> SignalBus::advertise(const std::string& name, const std::string& writer,
                                     const std::string& frame_source) {
  SignalBase& signal = slot(name, message_type<T>(), writer, [](const std::string& n) {
    return std::unique_ptr<SignalBase>(std::make_unique<Signal<T>>(n));
  });
  set_writer(signal, writer);
  signal.frame_source_ = frame_source;
  return SignalWriter<T>(static_cast<Signal<T>*>(&signal));
}

template <class T>
SignalReader<T> SignalBus::subscribe(const std::string& name, const std::string& reader) {
  SignalBase& signal = slot(name, message_type<T>(), reader, [](const std::string& n) {
    return std::unique_ptr<SignalBase>(std::make_unique<Signal<T>>(n));
  });
  set_reader(signal, reader);
  return SignalReader<T>(static_cast<const Signal<T>*>(&signal));
}

template <class T>
SignalReader<T> SignalBus::subscribe_optional(const std::string& name, const std::string& reader) {
  SignalBase& signal = slot(name, message_type<T>(), reader, [](const std::string& n) {
    return std::unique_ptr<SignalBase>(std::make_unique<Signal<T>>(n));
  });
  signal.is_read_ = true;
  return SignalReader<T>(static_cast<const Signal<T>*>(&signal));
}

template <class T>
SignalReader<T> SignalBus::subscribe_outside(const std::string& name, const std::string& reader) {
  const SignalReader<T> signal = subscribe<T>(name, reader);
  SignalBase& base = *find(name);
  if (base.writer() != kOutside) set_writer(base, kOutside);
  return signal;
}

/// View of the bus for one part: local names inside its vehicle, e.g. "estimate" ->
/// "rover/estimate".
class Ports {
 public:
  /// @param scope  vehicle name, or "run"
  /// @param part   part that connects, for errors, e.g. "rover.controller"
  /// @param written_as  local names that are written under another name, for a part that runs next
  /// to the owner of those signals
  Ports(SignalBus& bus, std::string scope, std::string part,
        std::map<std::string, std::string> written_as = {})
      : bus_(bus),
        scope_(std::move(scope)),
        part_(std::move(part)),
        written_as_(std::move(written_as)) {}

  /// @param name  local name; a name with '/' is used unchanged
  template <class T>
  SignalReader<T> read(const std::string& name) {
    return bus_.subscribe<T>(full_name(name), part_);
  }
  /// For optional signals, e.g. of a metric that judges plans if there are any.
  template <class T>
  SignalReader<T> read_optional(const std::string& name) {
    return bus_.subscribe_optional<T>(full_name(name), part_);
  }
  /// For commands of programs outside the run: `vinerow run --live`, ROS 2 nodes, a Session's
  /// owner.
  template <class T>
  SignalReader<T> read_from_outside(const std::string& name) {
    return bus_.subscribe_outside<T>(full_name(name), part_);
  }
  template <class T>
  SignalWriter<T> write(const std::string& name) {
    return bus_.advertise<T>(name_to_write(name), part_);
  }
  /// Like write, for a signal in the frame of another one, e.g. labels of a camera's picture.
  template <class T>
  SignalWriter<T> write_in_frame_of(const std::string& source, const std::string& name) {
    return bus_.advertise<T>(name_to_write(name), part_, full_name(source));
  }
  const std::string& scope() const { return scope_; }
  const std::string& part() const { return part_; }

 private:
  std::string full_name(const std::string& name) const {
    return name.find('/') == std::string::npos ? scope_ + "/" + name : name;
  }
  std::string name_to_write(const std::string& name) const {
    const auto other = written_as_.find(name);
    return full_name(other == written_as_.end() ? name : other->second);
  }
  SignalBus& bus_;
  std::string scope_;
  std::string part_;
  std::map<std::string, std::string> written_as_;
};

}  // namespace vinerow

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
  /// How many of them readers do not see any more (SignalBus::release()).
  std::uint64_t forgotten() const { return forgotten_; }
  const std::string& writer() const { return writer_; }
  const std::string& first_reader() const { return first_reader_; }

  /// Adds name, time and value to the digest of the run.
  virtual void hash_into(Hasher& hasher) const = 0;
  /// True if any field is NaN. Infinity is allowed: it says "nothing seen".
  virtual bool has_nan() const = 0;
  /// Shows every field of the value by name, with unit, type and place: nothing is copied. Views
  /// hold until the next write. No heap.
  virtual void describe(FieldVisitor& visitor) const = 0;

 protected:
  friend class SignalBus;
  std::string name_;
  MessageType type_;
  Time stamp_;
  std::uint64_t sequence_ = 0;
  std::uint64_t forgotten_ = 0;
  std::string writer_;
  std::string first_reader_;
};

/// @tparam T  a message (field.h): one of ours, or one that a plug-in brings
template <class T>
class Signal final : public SignalBase {
 public:
  explicit Signal(std::string name) : SignalBase(std::move(name), vinerow::message_type<T>()) {}

  const T& value() const { return value_; }
  /// Writes in place: no allocation when vectors keep their size.
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

/// Whether a signal's message is T: the same name and the same layout.
template <class T>
bool is_message(const SignalBase& signal) {
  const MessageType& type = message_type<T>();
  return std::string_view(signal.type()) == type.name &&
         signal.message_type().layout == type.layout;
}

/// A part's end of a signal it reads. Cheap to copy; valid as long as the bus.
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
  /// Number of writes by the present writer.
  std::uint64_t sequence() const {
    return signal_ ? signal_->sequence() - signal_->forgotten() : 0;
  }
  /// True once per write when called regularly: "is there something newer than I saw?"
  bool is_newer_than(std::uint64_t& seen) const {
    if (sequence() == seen) return false;
    seen = sequence();
    return true;
  }

 private:
  const Signal<T>* signal_ = nullptr;
};

/// A part's end of the signal it writes.
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
  /// @throws ConfigError if the name has a writer already or another type.
  template <class T>
  SignalWriter<T> advertise(const std::string& name, const std::string& writer);

  /// The signal may be advertised later; check_connected() finds those that never were.
  /// @throws ConfigError if the name has another type.
  template <class T>
  SignalReader<T> subscribe(const std::string& name, const std::string& reader);

  /// Like subscribe, but it is no error if nobody writes the signal: the reader never has a value then.
  template <class T>
  SignalReader<T> subscribe_optional(const std::string& name, const std::string& reader);

  /// @throws ConfigError "rover.controller reads 'rover/estimat' which nobody writes; did you mean
  /// ...?"
  void check_connected() const;

  /// Lets others write what the parts below `part` ("rover": "rover.controller", "rover.sensors.gps")
  /// have written so far. Readers see nothing until they do.
  void release(std::string_view part);

  /// In order of creation, which is the same in every run.
  const std::vector<std::unique_ptr<SignalBase>>& signals() const { return signals_; }
  /// @returns nullptr if there is none
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
SignalWriter<T> SignalBus::advertise(const std::string& name, const std::string& writer) {
  SignalBase& signal = slot(name, message_type<T>(), writer, [](const std::string& n) {
    return std::unique_ptr<SignalBase>(std::make_unique<Signal<T>>(n));
  });
  set_writer(signal, writer);
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
  return SignalReader<T>(static_cast<const Signal<T>*>(&signal));
}

/// The bus as one part sees it: local names inside its vehicle, e.g. "estimate" ->
/// "rover/estimate".
class Ports {
 public:
  /// @param scope  vehicle name, or "run"
  /// @param part   who connects, for errors, e.g. "rover.controller"
  /// @param written_as  local names that are written under another one, for a part that runs beside
  ///   the one whose signals those are
  Ports(SignalBus& bus, std::string scope, std::string part,
        std::map<std::string, std::string> written_as = {})
      : bus_(bus),
        scope_(std::move(scope)),
        part_(std::move(part)),
        written_as_(std::move(written_as)) {}

  /// @param name  local name; a name with '/' is taken as it is
  template <class T>
  SignalReader<T> read(const std::string& name) {
    return bus_.subscribe<T>(full_name(name), part_);
  }
  /// For what a part can do without, e.g. a metric that judges plans where there are any.
  template <class T>
  SignalReader<T> read_optional(const std::string& name) {
    return bus_.subscribe_optional<T>(full_name(name), part_);
  }
  template <class T>
  SignalWriter<T> write(const std::string& name) {
    const auto other = written_as_.find(name);
    return bus_.advertise<T>(full_name(other == written_as_.end() ? name : other->second), part_);
  }
  const std::string& scope() const { return scope_; }
  const std::string& part() const { return part_; }

 private:
  std::string full_name(const std::string& name) const {
    return name.find('/') == std::string::npos ? scope_ + "/" + name : name;
  }
  SignalBus& bus_;
  std::string scope_;
  std::string part_;
  std::map<std::string, std::string> written_as_;
};

}  // namespace vinerow

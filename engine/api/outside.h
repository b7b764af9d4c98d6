#pragma once
/// Signals that somebody outside a run writes, in place of a part: an autopilot, a person at a
/// joystick, a learner. The run takes values in by stamp, so that the same ones at the same stamps
/// give the same bits however the run is stepped.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "engine/api/signal.h"
#include "engine/core/time.h"

namespace vinerow {

/// Who writes such a signal, in the bus's list and in errors.
inline constexpr const char* kOutside = "outside";

/// A signal to be written from outside.
struct OutsideSignal {
  std::string name;  ///< "<vehicle>/<what>"
  /// Claims it, before any part is built. @throws ConfigError
  std::function<void(SignalBus&)> advertise;
};

/// @param name  "<vehicle>/<what>", e.g. outside_signal<NamedValues>("rover/actuators")
template <class T>
OutsideSignal outside_signal(std::string name) {
  auto advertise = [name](SignalBus& bus) { bus.advertise<T>(name, kOutside); };
  return {std::move(name), std::move(advertise)};
}

/// A value that a signal is to take.
struct OutsideCommand {
  Time stamp;  ///< it is written at the first instant that is not earlier
  /// Holds the value; has the name and the type of the signal it is for, and is on no bus.
  std::shared_ptr<SignalBase> value;
  void (*write)(const SignalBase& value, SignalBase& to, Time now) = nullptr;
};

template <class T>
OutsideCommand outside_command(std::string signal, Time stamp, const T& value) {
  auto sample = std::make_shared<Signal<T>>(std::move(signal));
  sample->write(stamp, value);
  return {stamp, std::move(sample), [](const SignalBase& from, SignalBase& to, Time now) {
            static_cast<Signal<T>&>(to).write(now, static_cast<const Signal<T>&>(from).value());
          }};
}

}  // namespace vinerow

#pragma once
/// Signals written from outside a run in place of a part: by an autopilot, a joystick, a learner.
/// The run applies values by their stamps, so equal values at equal stamps give equal bits however
/// the run is stepped.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "engine/api/signal.h"
#include "engine/core/time.h"

namespace vinerow {

/// Declaration of a signal that is written from outside.
struct OutsideSignal {
  std::string name;  ///< "<vehicle>/<what>"
  /// Advertises the signal, before any part is built. @throws ConfigError
  std::function<void(SignalBus&)> advertise;
};

/// @param name  "<vehicle>/<what>", e.g. outside_signal<NamedValues>("rover/actuators")
template <class T>
OutsideSignal outside_signal(std::string name) {
  auto advertise = [name](SignalBus& bus) { bus.advertise<T>(name, kOutside); };
  return {std::move(name), std::move(advertise)};
}

/// A value for a signal, with its time.
struct OutsideCommand {
  Time stamp;  ///< written at the first instant that is not earlier
  /// Holds the value. Has the name and type of the target signal, but is not on the bus.
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

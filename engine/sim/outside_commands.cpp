#include "engine/sim/outside_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow {

OutsideCommands::OutsideCommands(SignalBus& bus, const std::vector<OutsideSignal>& signals)
    : bus_(bus) {
  for (const OutsideSignal& signal : signals) signal.advertise(bus_);
}

void OutsideCommands::close() {
  for (const auto& written : bus_.signals()) {
    if (written->writer() != kOutside) continue;
    const std::string& name = written->name();
    signals_.push_back(name);
    if (written->is_read()) continue;
    std::vector<std::string> read;
    for (const auto& signal : bus_.signals()) {
      if (signal->is_read()) read.push_back(signal->name());
    }
    throw ConfigError(fmt::format("signal '{}' is taken over, but no part reads it{} (read: {})",
                                  name, did_you_mean(name, read), join(read)));
  }
}

SignalBase& OutsideCommands::find(const SignalBase& value) const {
  const std::string& name = value.name();
  SignalBase* signal = bus_.find(name);
  if (std::find(signals_.begin(), signals_.end(), name) != signals_.end()) {
    if (std::string_view(signal->type()) == value.type()) return *signal;
    throw ConfigError(fmt::format("signal '{}' is {}, not {}", name, signal->type(), value.type()));
  }
  const std::string taken = signals_.empty() ? "none" : join(signals_);
  if (signal && !signal->writer().empty()) {
    throw ConfigError(fmt::format("signal '{}' is written by {}, not from outside (taken over: {})",
                                  name, signal->writer(), taken));
  }
  throw ConfigError(fmt::format("signal '{}' is not taken over{} (taken over: {})", name,
                                did_you_mean(name, signals_), taken));
}

void OutsideCommands::add(OutsideCommand command, Time now) {
  const SignalBase& value = *command.value;
  static_cast<void>(find(value));
  if (command.stamp < now) {
    throw ConfigError(
        fmt::format("a command for '{}' at {:.9g} s comes too late: the next instant is {:.9g} s",
                    value.name(), command.stamp.s(), now.s()));
  }
  if (command.value->has_nan()) {
    throw ConfigError(fmt::format("a command for '{}' at {:.9g} s contains NaN", value.name(),
                                  command.stamp.s()));
  }
  const auto earlier = [](const OutsideCommand& a, const OutsideCommand& b) {
    return std::tie(a.stamp.ns, a.value->name()) < std::tie(b.stamp.ns, b.value->name());
  };
  waiting_.insert(std::upper_bound(waiting_.begin(), waiting_.end(), command, earlier),
                  std::move(command));
}

void OutsideCommands::deliver(Time now) {
  const auto due =
      std::find_if(waiting_.begin(), waiting_.end(),
                   [now](const OutsideCommand& command) { return now < command.stamp; });
  for (auto command = waiting_.begin(); command != due; ++command) {
    command->write(*command->value, *bus_.find(command->value->name()), now);
  }
  waiting_.erase(waiting_.begin(), due);
}

}  // namespace vinerow

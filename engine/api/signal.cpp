#include "engine/api/signal.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow {

SignalBase& SignalBus::slot(const std::string& name, const MessageType& type,
                            const std::string& who,
                            std::unique_ptr<SignalBase> (*make)(const std::string&)) {
  if (SignalBase* existing = find(name)) {
    if (std::string_view(existing->type()) != type.name) {
      throw ConfigError(fmt::format("{} takes signal '{}' as {}, but it is {}", who, name,
                                    type.name, existing->type()));
    }
    if (existing->message_type().layout != type.layout) {
      throw ConfigError(fmt::format(
          "{} takes signal '{}' as {}, but it is another message of that name, with other fields",
          who, name, type.name));
    }
    return *existing;
  }
  signals_.push_back(make(name));
  by_name_.emplace(name, signals_.back().get());
  return *signals_.back();
}

void SignalBus::release(std::string_view part) {
  const std::string below = std::string(part) + ".";
  for (const auto& signal : signals_) {
    if (!signal->writer_.starts_with(below)) continue;
    signal->writer_.clear();
    signal->forgotten_ = signal->sequence_;
  }
}

void SignalBus::set_writer(SignalBase& signal, const std::string& writer) {
  if (!signal.writer_.empty()) {
    throw ConfigError(fmt::format("signal '{}' is written by both {} and {}", signal.name(),
                                  signal.writer_, writer));
  }
  signal.writer_ = writer;
}

void SignalBus::set_reader(SignalBase& signal, const std::string& reader) {
  signal.is_read_ = true;
  if (signal.first_reader_.empty()) signal.first_reader_ = reader;
}

void SignalBus::check_connected() const {
  for (const auto& signal : signals_) {
    if (!signal->writer().empty() || signal->first_reader().empty()) continue;
    // Suggest only names of the same vehicle, and compare only their last part.
    const std::size_t slash = signal->name().find('/') + 1;
    const std::string scope = signal->name().substr(0, slash);
    const std::string last = signal->name().substr(slash);
    std::vector<std::string> written;
    std::string hint;
    for (const auto& other : signals_) {
      if (other->writer().empty() || !other->name().starts_with(scope)) continue;
      written.push_back(other->name().substr(slash));
      // "front_semantic" beside "front": a camera writes some pictures only if a parameter says so.
      if (last.starts_with(written.back() + "_")) {
        hint = fmt::format("; {} writes '{}': does one of its parameters add '{}'?",
                           other->writer(), written.back(), last.substr(written.back().size()));
      }
    }
    throw ConfigError(
        fmt::format("{} reads signal '{}', which nobody writes{}{} (written in '{}': {})",
                    signal->first_reader(), signal->name(), did_you_mean(last, written), hint,
                    scope, join(written)));
  }
}

SignalBase* SignalBus::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : found->second;
}

}  // namespace vinerow

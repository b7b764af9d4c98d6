#pragma once
/// Notes of the simulator itself. Never called from a normal step.

#include <functional>
#include <string>

namespace vinerow {

using LogSink = std::function<void(const std::string&)>;

void log_note(const std::string& text);

/// Replaces where the texts go (default: stderr) and returns the sink before.
LogSink set_log_sink(LogSink sink);

}  // namespace vinerow

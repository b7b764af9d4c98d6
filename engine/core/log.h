#pragma once
/// Log notes of the simulator itself. Never called from a normal step.

#include <functional>
#include <string>

namespace vinerow {

using LogSink = std::function<void(const std::string&)>;

void log_note(const std::string& text);

/// Replaces the sink of the texts (default: stderr) and returns the previous one.
LogSink set_log_sink(LogSink sink);

}  // namespace vinerow

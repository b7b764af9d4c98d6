#pragma once
/// Warnings and notes of the simulator itself. Never called from a normal step.

#include <functional>
#include <string>

namespace vinerow {

enum class LogLevel { kNote, kWarning };

using LogSink = std::function<void(LogLevel, const std::string&)>;

void log_note(const std::string& text);
void log_warning(const std::string& text);

/// Replaces where the texts go (default: stderr) and returns the sink before. Tests use it to fail
/// on warnings.
LogSink set_log_sink(LogSink sink);

}  // namespace vinerow

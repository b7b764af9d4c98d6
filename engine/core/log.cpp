#include "engine/core/log.h"

#include <cstdio>
#include <mutex>
#include <utility>

namespace vinerow {
namespace {

std::mutex& sink_mutex() {
  static std::mutex mutex;
  return mutex;
}

LogSink& sink() {
  static LogSink instance = [](const std::string& text) {
    std::fprintf(stderr, "%s\n", text.c_str());
  };
  return instance;
}

}  // namespace

void log_note(const std::string& text) {
  const std::scoped_lock lock(sink_mutex());
  sink()(text);
}

LogSink set_log_sink(LogSink next) {
  const std::scoped_lock lock(sink_mutex());
  return std::exchange(sink(), std::move(next));
}

}  // namespace vinerow

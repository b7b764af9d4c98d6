#include "engine/run/command_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/record/log_reader.h"
#include "engine/run/log_observer.h"
#include "engine/sim/session.h"
#include "engine/sim/simulation.h"

namespace vinerow::run {
namespace {

std::optional<std::string> find_value(const std::map<std::string, std::string>& map,
                                      const std::string& key) {
  const auto found = map.find(key);
  if (found == map.end()) return std::nullopt;
  return found->second;
}

/// Reads the values of one signal. @returns false if its type is not a built-in one
bool read_signal(const record::LogReader& log, const std::string& signal, const std::string& type,
                 std::vector<OutsideCommand>& commands) {
  bool known = false;
  for_each_message_type([&]<class T>(T*) {
    if (type != T::kType) return;
    known = true;
    log.read<T>("/" + signal, [&](Time stamp, const T& value) {
      commands.push_back(outside_command<T>(signal, stamp, value));
    });
  });
  return known;
}

}  // namespace

CommandLog read_command_log(const std::filesystem::path& file) {
  const record::LogReader log(file);
  CommandLog result;
  result.file = file;
  for (const record::ChannelInfo& channel : log.info().channels) {
    const auto signal = find_value(channel.metadata, "signal");
    const auto type = find_value(channel.metadata, "vinerow_type");
    if (!signal || !type || find_value(channel.metadata, "writer") != kOutside) continue;
    result.signals.push_back(*signal);
    if (read_signal(log, *signal, *type, result.commands)) continue;
    throw ConfigError(
        fmt::format("{}: the commands for '{}' are {}, a type of a plug-in, which "
                    "cannot be replayed",
                    file.string(), *signal, *type));
  }
  // A missing command would change the run.
  if (log.info().damaged > 0) {
    throw ConfigError(fmt::format("{}: the log is damaged, so its commands are not complete ({})",
                                  file.string(),
                                  log.info().warnings.empty() ? "" : log.info().warnings.front()));
  }
  std::ranges::stable_sort(result.commands, {}, [](const auto& c) { return c.stamp.ns; });
  const std::map<std::string, std::string>& end = log.info().result;
  result.digest = find_value(end, "digest").value_or("");
  if (end.empty()) {
    result.stop_before = log.info().last + Duration{1};  // killed
  } else if (find_value(end, "end") != kRunOver) {
    result.stop_before = Time{std::stoll(find_value(end, "end_ns").value_or("0"))};
  }
  return result;
}

void CommandReplay::begin(Session& session) {
  next_ = 0;
  std::vector<std::string> own = session.simulation().outside_signals();
  std::vector<std::string> logged = log_.signals;
  std::ranges::sort(own);
  std::ranges::sort(logged);
  if (own == logged) return;
  const auto taken = [](const std::vector<std::string>& names) {
    return names.empty() ? std::string("no commands from outside")
                         : fmt::format("commands for {}", join(names));
  };
  throw ConfigError(fmt::format(
      "{}: its run took {}, this scenario takes {}: replay the commands with the scenario that the "
      "log contains",
      log_.file.string(), taken(logged), taken(own)));
}

RunDriver::Next CommandReplay::next(Session& session, Time slice_end) {
  Time until = slice_end;
  if (log_.stop_before) {
    if (session.now() >= *log_.stop_before) {
      throw SimulationError(
          "run", session.now(),
          fmt::format("the run of {} was ended here from outside", log_.file.string()));
    }
    until = std::min(until, Time{log_.stop_before->ns - 1});
  }
  for (; next_ < log_.commands.size() && log_.commands[next_].stamp <= until; ++next_) {
    session.command(log_.commands[next_]);
  }
  return {until};
}

}  // namespace vinerow::run

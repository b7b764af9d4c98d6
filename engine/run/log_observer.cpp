#include "engine/run/log_observer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/core/whole_file.h"
#include "engine/run/run_channels.h"
#include "engine/run/summary.h"
#include "engine/sim/simulation.h"

namespace vinerow::run {
namespace {

record::RecorderOptions options_of(const scenario::Scenario& scenario) {
  record::RecorderOptions options;
  options.compression = scenario.record.compression;
  return options;
}

std::map<std::string, std::string> metadata_of(const scenario::Scenario& scenario) {
  return {{"scenario", scenario.name},
          {"seed", std::to_string(scenario.seed)},
          {"vinerow", program_version()},
          {"latitude_longitude_note", "frame map is East-North-Up at the scenario's origin"}};
}

}  // namespace

LogObserver::LogObserver(const Simulation& simulation, const std::filesystem::path& file)
    : recorder_(file, options_of(simulation.scenario()), metadata_of(simulation.scenario())) {
  recorder_.add_attachment("scenario.resolved.yaml", "application/yaml",
                           simulation.scenario().resolved_yaml);
  add_run_channels(simulation, recorder_.channels());
}

void LogObserver::finish(const Simulation& simulation, const std::string& end) {
  recorder_.add_result({{"digest", simulation.digest()},
                        {"end", end},
                        {"end_ns", std::to_string(simulation.now().ns)}});
  recorder_.finish();
}

EventFile::EventFile(const std::filesystem::path& file)
    : name_(fmt::format("'{}'", file.string())) {
  file_.reset(std::fopen(file.c_str(), "wb"));
  if (!file_) throw_cannot_write(name_, errno);
}

void EventFile::on_event(Time now, const Event& event) {
  const char* level = event.level == Event::Level::kInfo      ? "info"
                      : event.level == Event::Level::kWarning ? "warning"
                                                              : "error";
  const std::string line = nlohmann::ordered_json{{"t_s", now.nearest_s()},
                                                  {"level", level},
                                                  {"source", event.source},
                                                  {"text", event.text}}
                               .dump() +
                           "\n";
  if (error_number_) return;
  // Flushed line by line, so that the events of a killed run are readable.
  errno = 0;
  const bool stored = std::fwrite(line.data(), 1, line.size(), file_.get()) == line.size() &&
                      std::fflush(file_.get()) == 0;
  if (stored) {
    whole_bytes_ += static_cast<off_t>(line.size());
    return;
  }
  error_number_ = errno;
  static_cast<void>(::ftruncate(::fileno(file_.get()), whole_bytes_));  // no partial line
}

void EventFile::check() const {
  if (error_number_) throw_cannot_write(name_, *error_number_);
}

}  // namespace vinerow::run

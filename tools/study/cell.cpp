#include "tools/study/cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/core/whole_file.h"
#include "engine/run/run.h"
#include "engine/sim/judge.h"

namespace vinerow::study {
namespace {

constexpr std::array<std::pair<CellState, const char*>, 9> kWords = {{
    {CellState::kWaiting, "waiting"},
    {CellState::kNotNeeded, "not needed"},
    {CellState::kMet, "met"},
    {CellState::kNotMet, "not met"},
    {CellState::kBrokenOff, "broken off"},
    {CellState::kInvalid, "invalid"},
    {CellState::kCrashed, "crashed"},
    {CellState::kOutOfTime, "out of time"},
    {CellState::kOutOfMemory, "out of memory"},
}};

/// Reason why a complete run did not meet its requirements; the most important one counts.
std::string reason_of(const run::RunResult& result) {
  if (!result.error.empty()) return result.error;
  for (const PhaseReport& phase : result.phases) {
    if (phase.state != PhaseState::kSucceeded) {
      return fmt::format("phase {} {}{}{}", phase.name, to_string(phase.state),
                         phase.reason.empty() ? "" : ": ", phase.reason);
    }
  }
  for (const CriterionResult& criterion : result.criteria) {
    if (!criterion.met) return sentence_of(criterion);
  }
  return "";
}

CellResult result_of(const run::RunResult& run) {
  CellResult cell;
  cell.state = run.status == run::RunStatus::kAllMet      ? CellState::kMet
               : run.status == run::RunStatus::kBrokenOff ? CellState::kBrokenOff
                                                          : CellState::kNotMet;
  if (cell.state != CellState::kMet) cell.reason = reason_of(run);
  cell.digest = run.digest;
  for (const auto& [owner, numbers] : run.metrics) {
    for (const auto& [name, value] : numbers) cell.values[owner + "." + name] = value;
  }
  for (const auto& [vehicle, numbers] : run.planning) {
    for (const auto& [name, value] : numbers) {
      cell.values[fmt::format("planning.{}.{}", vehicle, name)] = value;
    }
  }
  cell.values["run.met"] = cell.state == CellState::kMet ? 1.0 : 0.0;
  cell.values["run.finished"] = run.finished ? 1.0 : 0.0;
  cell.values["run.simulated_s"] = run.simulated_s;
  if (run.phases.empty()) return cell;
  cell.values["run.phases"] = static_cast<double>(run.phases.size());
  cell.values["run.phases_succeeded"] = static_cast<double>(std::count_if(
      run.phases.begin(), run.phases.end(),
      [](const PhaseReport& phase) { return phase.state == PhaseState::kSucceeded; }));
  return cell;
}

nlohmann::ordered_json number_json(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  return value;
}

double number_of(const nlohmann::json& json) {
  if (json.is_number()) return json.get<double>();
  const std::string word = json.get<std::string>();
  if (word == "inf") return std::numeric_limits<double>::infinity();
  if (word == "-inf") return -std::numeric_limits<double>::infinity();
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

const char* to_string(CellState state) {
  for (const auto& [known, word] : kWords) {
    if (known == state) return word;
  }
  return "?";
}

CellState cell_state_of(const std::string& word) {
  for (const auto& [state, known] : kWords) {
    if (word == known) return state;
  }
  std::vector<std::string> known;
  for (const auto& entry : kWords) known.emplace_back(entry.second);
  throw ConfigError(fmt::format("'{}' is not a state of a cell, must be one of: {}{}", word,
                                join(known), did_you_mean(word, known)));
}

bool is_finished(CellState state) {
  return state != CellState::kWaiting && state != CellState::kNotNeeded;
}

bool has_numbers(CellState state) {
  return state == CellState::kMet || state == CellState::kNotMet;
}

std::string cell_json(const CellResult& result) {
  nlohmann::ordered_json json = {{"state", to_string(result.state)},
                                 {"reason", result.reason},
                                 {"digest", result.digest},
                                 {"values", nlohmann::ordered_json::object()}};
  for (const auto& [name, value] : result.values) json["values"][name] = number_json(value);
  json["cost"] = {{"wall_s", result.cost.wall_s},
                  {"cpu_s", result.cost.cpu_s},
                  {"peak_MB", result.cost.peak_MB},
                  {"host", result.cost.host}};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

CellResult cell_result_of(const std::string& text, const std::string& file) {
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    CellResult result;
    result.state = cell_state_of(json.at("state").get<std::string>());
    result.reason = json.at("reason").get<std::string>();
    result.digest = json.at("digest").get<std::string>();
    for (const auto& [name, value] : json.at("values").items()) {
      result.values[name] = number_of(value);
    }
    const nlohmann::json& cost = json.at("cost");
    result.cost = {cost.at("wall_s").get<double>(), cost.at("cpu_s").get<double>(),
                   cost.at("peak_MB").get<double>(), cost.at("host").get<std::string>()};
    return result;
  } catch (const nlohmann::json::exception& error) {
    throw ConfigError(
        fmt::format("'{}' is not the result of a cell ({}); remove it to run the cell again", file,
                    error.what()));
  }
}

CellResult run_cell(const scenario::ScenarioSource& source, const scenario::Overrides& overrides,
                    const Registry& registry, const std::shared_ptr<RunShelf>& shelf,
                    scenario::KeepRuns keep, const std::filesystem::path& folder) {
  CellResult result;
  try {
    run::RunOptions options;
    options.out = folder;
    options.log = keep == scenario::KeepRuns::kLog || keep == scenario::KeepRuns::kFailed;
    options.pictures = false;
    options.measure_cost = false;
    options.shelf = shelf;
    const run::RunResult run =
        run::run_scenario(source.load(registry, overrides), registry, options);
    if (!run.write_failure.empty()) throw WriteError(run.write_failure);
    return result_of(run);
  } catch (const ConfigError& error) {
    result.state = CellState::kInvalid;
    result.reason = error.what();
  } catch (const WriteError&) {
    throw;
  } catch (const std::exception& error) {
    result.state = CellState::kBrokenOff;
    result.reason = error.what();
  }
  return result;
}

}  // namespace vinerow::study

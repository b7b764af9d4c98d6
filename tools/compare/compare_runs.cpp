#include "tools/compare/compare_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "engine/core/error.h"
#include "tools/compare/json_file.h"
#include "tools/compare/text_table.h"
#include "tools/terminal/colour.h"

namespace vinerow::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// Numbers and criteria of a summary, under names that are the same in every run.
struct SummaryNumbers {
  ComparedRun run;
  std::vector<std::pair<std::string, double>> metrics;
  std::vector<std::pair<std::string, CriterionState>> criteria;
};

std::string text_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || found->is_null()) return "";
  return found->is_string() ? found->get<std::string>() : found->dump();
}

void add_numbers(const Json& json, const std::string& prefix,
                 std::vector<std::pair<std::string, double>>& metrics) {
  for (const auto& [key, value] : json.items()) {
    const std::string name = prefix.empty() ? key : key.empty() ? prefix : prefix + "." + key;
    if (value.is_object()) {
      add_numbers(value, name, metrics);
    } else if (value.is_number()) {
      metrics.emplace_back(name, value.get<double>());
    } else if (value.is_null()) {
      metrics.emplace_back(name, kNotMeasured);
    }
  }
}

void add_criteria(const Json& list, const std::string& prefix, SummaryNumbers& summary) {
  if (!list.is_array()) return;
  for (const Json& criterion : list) {
    if (!criterion.is_object() || !criterion.contains("met")) continue;
    summary.criteria.emplace_back(
        prefix + text_in(criterion, "name"),
        criterion["met"] == true ? CriterionState::kMet : CriterionState::kFailed);
  }
}

SummaryNumbers read_numbers(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "summary.json";
  const Json json = read_json_file(file);
  if (!json.contains("metrics") || !json["metrics"].is_object()) {
    throw ConfigError(fmt::format("{}: has no object 'metrics', so it is not the summary of a run",
                                  file.string()));
  }
  SummaryNumbers summary;
  summary.run.folder = folder.string();
  summary.run.scenario = text_in(json, "scenario");
  summary.run.status = text_in(json, "status");
  summary.run.digest = text_in(json, "digest");
  summary.run.seed = text_in(json, "seed");
  if (json.contains("exit_status") && json["exit_status"].is_number_integer()) {
    summary.run.exit_status = json["exit_status"].get<int>();
  }
  if (json.contains("simulated_s") && json["simulated_s"].is_number()) {
    summary.metrics.emplace_back("simulated_s", json["simulated_s"].get<double>());
  }
  add_numbers(json["metrics"], "", summary.metrics);
  add_criteria(json.value("criteria", Json::array()), "", summary);
  const Json phases = json.value("phases", Json::array());
  for (const Json& phase : phases.is_array() ? phases : Json::array()) {
    if (!phase.is_object()) continue;
    const std::string name = "phase " + text_in(phase, "name");
    summary.criteria.emplace_back(name + " succeeded", text_in(phase, "state") == "succeeded"
                                                           ? CriterionState::kMet
                                                           : CriterionState::kFailed);
    add_criteria(phase.value("criteria", Json::array()), name + ": ", summary);
  }
  return summary;
}

/// Values of all runs: first under the names of the first run, then under names that later runs
/// add.
template <class T>
std::vector<std::pair<std::string, std::vector<T>>> side_by_side(
    const std::vector<std::vector<std::pair<std::string, T>>>& runs, T absent) {
  std::vector<std::pair<std::string, std::vector<T>>> rows;
  std::map<std::string, std::size_t> places;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const auto& [name, value] : runs[r]) {
      const auto [place, added] = places.try_emplace(name, rows.size());
      if (added) rows.emplace_back(name, std::vector<T>(runs.size(), absent));
      rows[place->second].second[r] = value;
    }
  }
  return rows;
}

bool differ(double a, double b, double tolerance) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) != std::isnan(b);
  if (a == b) return false;  // also if both are infinite
  return !(std::abs(a - b) <= tolerance * std::max(std::abs(a), std::abs(b)));
}

std::string number_text(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.6g}", value + 0.0);  // no sign of a zero
}

std::string change_text(double from, double to) {
  if (std::isnan(from) || std::isnan(to)) return "";
  return fmt::format("{:+.4g}", to - from);
}

std::string share_text(double from, double to) {
  if (std::isnan(from) || std::isnan(to) || from == 0.0) return "";
  return fmt::format("{:+.1f} %", 100.0 * (to - from) / std::abs(from));
}

/// Short heading of a run: "A", "B", ...
std::string letter_of(std::size_t run) {
  return run < 26 ? std::string(1, static_cast<char>('A' + run)) : fmt::format("run {}", run + 1);
}

const char* word_of(CriterionState state) {
  switch (state) {
    case CriterionState::kMet:
      return "met";
    case CriterionState::kFailed:
      return "FAILED";
    case CriterionState::kAbsent:
      break;
  }
  return "absent";
}

void find_regressions(RunComparison& comparison) {
  for (const ComparedCriterion& criterion : comparison.criteria) {
    if (criterion.states.front() != CriterionState::kMet) continue;
    for (std::size_t r = 1; r < criterion.states.size(); ++r) {
      if (criterion.states[r] == CriterionState::kMet) continue;
      comparison.regressions.push_back(fmt::format("{}: {} in {}, met in {}", criterion.name,
                                                   word_of(criterion.states[r]), letter_of(r),
                                                   letter_of(0)));
    }
  }
  const int before = comparison.runs.front().exit_status;
  for (std::size_t r = 1; r < comparison.runs.size(); ++r) {
    const ComparedRun& run = comparison.runs[r];
    if (run.exit_status > before) {
      comparison.regressions.push_back(fmt::format("{} ended with exit status {} ({}), {} with {}",
                                                   letter_of(r), run.exit_status, run.status,
                                                   letter_of(0), before));
    }
  }
}

Json json_number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace

RunComparison compare_runs(const std::vector<std::filesystem::path>& folders, double tolerance) {
  RunComparison comparison;
  std::vector<std::vector<std::pair<std::string, double>>> metrics;
  std::vector<std::vector<std::pair<std::string, CriterionState>>> criteria;
  for (const std::filesystem::path& folder : folders) {
    SummaryNumbers summary = read_numbers(folder);
    comparison.runs.push_back(std::move(summary.run));
    metrics.push_back(std::move(summary.metrics));
    criteria.push_back(std::move(summary.criteria));
  }
  for (auto& [name, values] : side_by_side(metrics, kNotMeasured)) {
    ComparedMetric metric{name, values, false};
    for (const double value : values) {
      metric.differs = metric.differs || differ(values.front(), value, tolerance);
    }
    comparison.differences += metric.differs ? 1 : 0;
    comparison.metrics.push_back(std::move(metric));
  }
  for (auto& [name, states] : side_by_side(criteria, CriterionState::kAbsent)) {
    comparison.criteria.push_back({name, states});
  }
  find_regressions(comparison);
  return comparison;
}

std::string comparison_text(const RunComparison& comparison, bool all) {
  const std::size_t count = comparison.runs.size();
  std::string text;
  for (std::size_t r = 0; r < count; ++r) {
    const ComparedRun& run = comparison.runs[r];
    const bool same_bits = r > 0 && run.digest == comparison.runs.front().digest;
    text +=
        printable(fmt::format("{}  {}: {}, seed {}, {}{}", letter_of(r), run.folder, run.scenario,
                              run.seed, run.status, same_bits ? ", bit-identical to A" : "")) +
        "\n";
  }
  std::vector<std::vector<std::string>> table = {{"metric"}};
  for (std::size_t r = 0; r < count; ++r) table.front().push_back(letter_of(r));
  for (std::size_t r = 1; r < count; ++r) {
    table.front().insert(table.front().end(), {letter_of(r) + " - A", "change"});
  }
  for (const ComparedMetric& metric : comparison.metrics) {
    if (!all && !metric.differs) continue;
    std::vector<std::string>& row = table.emplace_back();
    row.push_back(metric.name);
    for (const double value : metric.values) row.push_back(number_text(value));
    for (std::size_t r = 1; r < count; ++r) {
      row.push_back(change_text(metric.values.front(), metric.values[r]));
      row.push_back(share_text(metric.values.front(), metric.values[r]));
    }
  }
  if (table.size() > 1) text += "\n" + text_table(table);
  text +=
      fmt::format("\n{} of {} metrics differ\n", comparison.differences, comparison.metrics.size());
  std::string changes;
  std::size_t met_by_all = 0;
  for (const ComparedCriterion& criterion : comparison.criteria) {
    const bool met = std::all_of(criterion.states.begin(), criterion.states.end(),
                                 [](CriterionState s) { return s == CriterionState::kMet; });
    met_by_all += met ? 1 : 0;
    if (met) continue;
    changes += "  " + printable(criterion.name) + ":";
    for (std::size_t r = 0; r < count; ++r) {
      const CriterionState state = criterion.states[r];
      changes += fmt::format(
          " {} {}", letter_of(r),
          coloured(word_of(state), state == CriterionState::kMet ? Colour::kGood : Colour::kBad));
    }
    changes += "\n";
  }
  text += fmt::format("{} of {} criteria and phases met by all{}\n{}", met_by_all,
                      comparison.criteria.size(), changes.empty() ? "" : "; not:", changes);
  for (const std::string& regression : comparison.regressions) {
    text += coloured("regression", Colour::kBad) + ": " + printable(regression) + "\n";
  }
  return text;
}

nlohmann::ordered_json comparison_json(const RunComparison& comparison) {
  Json json;
  for (const ComparedRun& run : comparison.runs) {
    json["runs"].push_back({{"folder", run.folder},
                            {"scenario", run.scenario},
                            {"seed", run.seed},
                            {"status", run.status},
                            {"exit_status", run.exit_status},
                            {"digest", run.digest}});
  }
  json["metrics"] = Json::object();
  for (const ComparedMetric& metric : comparison.metrics) {
    Json& entry = json["metrics"][metric.name];
    entry["values"] = Json::array();
    entry["differences"] = Json::array();
    for (const double value : metric.values) {
      entry["values"].push_back(json_number(value));
      entry["differences"].push_back(json_number(value - metric.values.front()));
    }
    entry["differs"] = metric.differs;
  }
  json["criteria"] = Json::object();
  for (const ComparedCriterion& criterion : comparison.criteria) {
    Json& states = json["criteria"][criterion.name];
    for (const CriterionState state : criterion.states) {
      states.push_back(state == CriterionState::kAbsent ? Json(nullptr)
                                                        : Json(state == CriterionState::kMet));
    }
  }
  json["metrics_that_differ"] = comparison.differences;
  json["regressions"] = comparison.regressions;
  return json;
}

}  // namespace vinerow::tools

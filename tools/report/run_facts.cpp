#include "tools/report/run_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tools/report/html.h"
#include "tools/report/units.h"

namespace vinerow::tools::report {
namespace {

std::string plain(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return value.is_number() ? number_text(value.get<double>()) : value.dump();
}

/// Table of the planners' counters, for every vehicle.
std::string planning_table(const RunFolder& run) {
  const auto planning = run.summary.find("planning");
  if (planning == run.summary.end() || !planning->is_object()) return "";
  std::vector<std::vector<std::string>> rows;
  for (const auto& [vehicle, numbers] : planning->items()) {
    for (const auto& [name, value] : numbers.items()) {
      rows.push_back({escaped(vehicle), escaped(words_of(name)), number_cell(number_of(value)),
                      escaped(unit_of(name))});
    }
  }
  return rows.empty()
             ? ""
             : "<details><summary>Planner statistics</summary>\n" +
                   table({"vehicle", "number", "value", "unit"}, rows, "planning") + "</details>\n";
}

/// "its estimator error_state_kalman", "the true state (no estimator)".
std::string state_source(const Json& estimation) {
  const auto estimator = estimation.find("estimator");
  if (estimator == estimation.end() || !estimator->is_string()) {
    return "the true state (no estimator)";
  }
  if (*estimator == "truth") return "the true state (estimator 'truth')";
  std::string source = "its estimator " + estimator->get<std::string>();
  for (const Json& of_truth : list_in(estimation, "truth")) {
    source += ", with the true " + plain(of_truth);
  }
  return source;
}

}  // namespace

std::string facts(const RunFolder& run) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const std::string& what, const std::string& value) {
    rows.push_back({what, escaped(value)});
  };
  add("scenario", run.text("scenario"));
  add("verdict of the run", run.text("status"));
  add("digest of all signals", run.text("digest"));
  for (const char* key : {"seed", "physics_step_s", "steps"}) {
    const auto found = run.summary.find(key);
    if (found != run.summary.end()) add(words_of(key), found->dump());
  }
  const auto estimation = run.summary.find("estimation");
  if (estimation != run.summary.end() && estimation->is_object()) {
    for (const auto& [vehicle, source] : estimation->items()) {
      add(escaped(vehicle) + " acts on", state_source(source));
    }
  }
  const auto versions = run.summary.find("versions");
  if (versions != run.summary.end() && versions->is_object()) {
    for (const auto& [name, value] : versions->items()) add(name, plain(value));
  }
  for (const Json& note : list_in(run.summary, "notes")) add("note", plain(note));
  if (!run.text("picture_note").empty()) add("pictures", "none: " + run.text("picture_note"));
  std::string out = table({}, rows, "facts") + planning_table(run);
  if (!run.resolved_yaml.empty()) {
    out +=
        "<details><summary>Scenario as run, with all defaults"
        "</summary>\n<pre>" +
        escaped(run.resolved_yaml) + "</pre></details>\n";
  }
  return out;
}

std::string timings(const RunFolder& run) {
  std::string out = fmt::format(
      "<p>Only this part of the page depends on the machine. {} simulated in {:.2f} "
      "s: "
      "<strong id=\"real-time-factor\">{:.0f} ×</strong> real time, without pictures and without "
      "building the world.</p>\n",
      duration_text(std::max(0.0, run.end_s())), run.number("wall_s"),
      run.number("real_time_factor"));
  std::vector<std::vector<std::string>> rows;
  const auto number_in = [](const Json& entry, const char* key) {
    return number_cell(number_of(entry.value(key, Json())));
  };
  for (const Json& row : list_in(run.summary, "profile")) {
    rows.push_back({"<code>" + escaped(row.value("part", "")) + "</code>",
                    escaped(row.value("phase", "")), escaped(row.value("stage", "")),
                    number_in(row, "calls"), number_in(row, "wall_s"),
                    number_in(row, "us_per_call"), number_in(row, "longest_us"),
                    row.contains("allocations") ? number_in(row, "allocations") : ""});
  }
  if (!rows.empty()) {
    return out + table({"part", "phase", "stage", "calls", "computing time, s", "µs per call",
                        "longest, µs", "allocations"},
                       rows, "cost");
  }
  for (const Json& phase : list_in(run.summary, "phases")) {
    const auto wall = phase.find("wall_s");
    if (wall == phase.end() || phase.value("kind", "") != "job") continue;
    rows.push_back(
        {"phase " + escaped(phase.value("name", "")), "", "", number_cell(number_of(*wall)), ""});
  }
  for (const Json& task : list_in(run.summary, "cost")) {
    rows.push_back({"<code>" + escaped(task.value("task", "")) + "</code>",
                    number_in(task, "period_s"), number_in(task, "ticks"),
                    number_in(task, "wall_s"), number_in(task, "us_per_tick")});
  }
  return out + (rows.empty()
                    ? ""
                    : table({"task", "period, s", "ticks", "computing time, s", "µs per tick"},
                            rows, "cost"));
}

}  // namespace vinerow::tools::report

#include "engine/run/summary.h"

#include <fmt/format.h>
#include <vinerow/version.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/api/abi_version.h"
#include "engine/api/world_model.h"
#include "engine/run/run_profile.h"

namespace vinerow::run {
namespace {

using nlohmann::ordered_json;

ordered_json criteria_json(const std::vector<CriterionResult>& criteria) {
  ordered_json list = ordered_json::array();
  for (const CriterionResult& c : criteria) {
    list.push_back({{"name", c.name},
                    {"metric", c.metric},
                    {"kind", c.kind},
                    {"value", c.value},
                    {"limit", c.limit},
                    {"met", c.met}});
    // JSON has neither NaN nor infinity, so a reason explains the null.
    if (!std::isfinite(c.value)) {
      list.back()["reason"] = std::isnan(c.value) ? "not measured" : "infinite";
    }
  }
  return list;
}

/// Path of a product relative to the run's folder: "products/build_map" or a file in it.
std::string file_in_run(const PhaseReport& phase) {
  const std::filesystem::path folder = std::filesystem::path("products") / phase.name;
  const std::filesystem::path name = phase.product->file.filename();
  return name == phase.name ? folder.string() : (folder / name).string();
}

ordered_json phases_json(const RunResult& result) {
  ordered_json list = ordered_json::array();
  for (const PhaseReport& phase : result.phases) {
    ordered_json json = {{"name", phase.name}, {"kind", phase.job.empty() ? "vehicles" : "job"}};
    if (phase.job.empty()) {
      json["vehicles"] = phase.vehicles;
    } else {
      json["job"] = phase.job;
    }
    json["after"] = phase.after;
    json["state"] = to_string(phase.state);
    json["begin_s"] = phase.begin ? ordered_json(phase.begin->nearest_s()) : ordered_json();
    json["end_s"] = phase.end ? ordered_json(phase.end->nearest_s()) : ordered_json();
    json["reason"] = phase.reason;
    json["criteria"] = criteria_json(phase.criteria);
    json["numbers"] = phase.numbers;
    json["metrics"] = phase.metrics;
    json["notes"] = phase.notes;
    if (phase.product) {
      json["product"] = {{"kind", to_string(phase.product->kind)}};
      if (!phase.product->file.empty()) {
        json["product"]["file"] = file_in_run(phase);
      }
    }
    if (!phase.job.empty()) json["wall_s"] = phase.wall_s;
    list.push_back(std::move(json));
  }
  return list;
}

ordered_json crashes_json(const RunResult& result) {
  ordered_json list = ordered_json::array();
  for (const Crash& crash : result.crashes) {
    list.push_back({{"vehicle", crash.vehicle},
                    {"time_s", crash.time.nearest_s()},
                    {"kind", to_string(crash.kind)},
                    {"text", crash.text}});
  }
  return list;
}

/// Estimator of every vehicle, and the quantities that it takes from the truth ("state": all).
ordered_json estimation_json(const scenario::Scenario& scenario) {
  ordered_json list = ordered_json::object();
  for (const scenario::VehicleConfig& vehicle : scenario.vehicles) {
    ordered_json of_truth = ordered_json::array();
    if (vehicle.estimate_is_truth()) {
      of_truth.push_back("state");
    } else if (vehicle.estimator) {
      const ParameterSet& parameters = vehicle.estimator->parameters;
      for (const ParameterSpec& spec : parameters.specs()) {
        if (spec.kind != ParameterKind::kText || spec.choices.empty()) continue;
        const ParameterSet::Value* value = parameters.find(spec.name);
        if (value && std::get<std::string>(*value) == "truth") of_truth.push_back(spec.name);
      }
    }
    const auto& source = vehicle.autopilot ? vehicle.autopilot : vehicle.estimator;
    list[vehicle.name] = {{"estimator", source ? ordered_json(source->type) : ordered_json()},
                          {"truth", std::move(of_truth)}};
  }
  return list;
}

ordered_json cost_json(Simulation& simulation) {
  ordered_json list = ordered_json::array();
  for (const Scheduler::TaskReport& task : simulation.scheduler().reports()) {
    list.push_back(
        {{"task", task.name},
         {"period_s", task.period.nearest_s()},
         {"ticks", task.ticks},
         {"wall_s", task.wall_s},
         {"us_per_tick", task.ticks ? 1e6 * task.wall_s / static_cast<double>(task.ticks) : 0.0}});
  }
  return list;
}

ordered_json profile_json(const RunProfile& profile) {
  ordered_json list = ordered_json::array();
  for (const RunProfile::Row& row : profile.rows()) {
    list.push_back({{"part", row.part},
                    {"phase", row.phase},
                    {"stage", row.stage},
                    {"calls", row.calls},
                    {"wall_s", row.time_s},
                    {"us_per_call", 1e6 * row.time_s / static_cast<double>(row.calls)},
                    {"longest_us", 1e6 * row.longest_s}});
    if (profile.counts_allocations()) list.back()["allocations"] = row.allocations;
  }
  return list;
}

std::string status_name(const RunResult& result) {
  switch (result.status) {
    case RunStatus::kAllMet:
      return "all criteria met";
    case RunStatus::kCriterionFailed:
      for (const PhaseReport& phase : result.phases) {
        if (phase.state == PhaseState::kFailed) return "a phase failed";
      }
      if (result.crashes.empty()) return "a criterion failed";
      return fmt::format("a vehicle {}", to_string(result.crashes.front().kind));
    case RunStatus::kBadInput:
      return "bad input";
    case RunStatus::kBrokenOff:
      return "broken off";
  }
  return "?";
}

}  // namespace

std::string program_version() {
  return VINEROW_VERSION_STRING;
}

std::string summary_json(const RunResult& result, Simulation& simulation,
                         const RunProfile* profile) {
  const scenario::Scenario& scenario = simulation.scenario();
  ordered_json summary;
  summary["scenario"] = scenario.name;
  summary["status"] = status_name(result);
  summary["exit_status"] = static_cast<int>(result.status);
  if (!result.error.empty()) summary["error"] = result.error;
  summary["seed"] = scenario.seed;
  summary["digest"] = result.digest;
  summary["finished"] = result.finished;
  summary["simulated_s"] = result.simulated_s;
  summary["wall_s"] = result.wall_s;
  summary["real_time_factor"] = result.real_time_factor();
  summary["physics_step_s"] = scenario.physics_step.nearest_s();
  summary["steps"] = simulation.steps();
  summary["criteria"] = criteria_json(result.criteria);
  if (!result.phases.empty()) summary["phases"] = phases_json(result);
  if (!result.crashes.empty()) summary["crashes"] = crashes_json(result);
  summary["estimation"] = estimation_json(scenario);
  summary["metrics"] = ordered_json::object();
  for (const auto& [vehicle, metrics] : result.metrics) {
    for (const auto& [name, value] : metrics) summary["metrics"][vehicle][name] = value;
  }
  for (const auto& [vehicle, numbers] : result.planning) {
    for (const auto& [name, value] : numbers) summary["planning"][vehicle][name] = value;
  }
  for (const auto& file : result.canopy) {
    summary["canopy"].push_back("canopy/" + file.filename().string());
  }
  summary["pictures"] = ordered_json::array();
  for (const auto& picture : result.pictures) summary["pictures"].push_back(picture.string());
  if (!result.picture_note.empty()) summary["picture_note"] = result.picture_note;
  summary["notes"] = simulation.world().notes;
  summary["cost"] = cost_json(simulation);
  if (profile) {
    summary["profile"] = profile_json(*profile);
    summary["two_cores_save_s"] = profile->two_cores_save_s();
  }
  summary["versions"] = {{"vinerow", program_version()},
                         {"abi", fmt::format("{} ({})", VINEROW_ABI_VERSION, VINEROW_ABI_HEADERS)},
                         {"compiler", __VERSION__}};
  return summary.dump(2) + "\n";
}

}  // namespace vinerow::run

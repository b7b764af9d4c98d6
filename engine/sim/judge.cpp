#include "engine/sim/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/constants.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/scenario/known_names.h"
#include "engine/sim/separation.h"

namespace vinerow {
namespace {

/// Known metrics, the most similar first: at most kMaxWithHint if one is similar enough for a hint,
/// else all.
std::string list_metrics(const std::string& wrong, std::vector<std::string> known) {
  constexpr std::size_t kMaxWithHint = 10;
  if (nearest_name(wrong, known).empty()) return join(known);
  std::stable_sort(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
    return edit_distance(wrong, a) < edit_distance(wrong, b);
  });
  if (known.size() <= kMaxWithHint) return scenario::list_known(known, kMaxWithHint);
  // Only numbers of jobs have no owner.
  const bool of_job = wrong.find('.') == std::string::npos;
  return scenario::list_known(known, kMaxWithHint) +
         (of_job ? "; see 'vinerow list job'" : "; see 'vinerow list metric'");
}

double find_metric(const scenario::Criterion& criterion,
                   const std::map<std::string, std::map<std::string, double>>& metrics) {
  std::vector<std::string> known;
  for (const auto& [vehicle, values] : metrics) {
    for (const auto& [name, value] : values) {
      const std::string full = vehicle.empty() ? name : vehicle + "." + name;
      if (full == criterion.metric) return value;
      known.push_back(full);
    }
  }
  throw ConfigError(fmt::format("{}: criteria: metric '{}' does not exist{} (known: {})",
                                criterion.where.text(), criterion.metric,
                                did_you_mean(criterion.metric, known),
                                known.empty() ? "none" : list_metrics(criterion.metric, known)));
}

/// Reason why a metric has no value, derived from its name.
const char* why_not_measured(const std::string& metric) {
  const std::string name = metric.substr(metric.find('.') + 1);
  for (const char* begin : {"cross_track_", "heading_error_rms_rad", "altitude_error_",
                            "height_above_ground_", "row_speed_", "straight_"}) {
    if (name.starts_with(begin)) return "it never drove a leg";
  }
  if (name.starts_with("turn_") || name.ends_with("_turn")) return "it never drove a turn";
  if (name.starts_with("hover_")) return "it never hovered";
  return "there was nothing to measure";
}

/// "min = 0.2 and max = 0.8"
std::string limits_text(const scenario::Criterion& criterion) {
  std::string text = criterion.min ? fmt::format("min = {:g}", *criterion.min) : "";
  if (criterion.min && criterion.max) text += " and ";
  if (criterion.max) text += fmt::format("max = {:g}", *criterion.max);
  return text;
}

void refuse_impossible_limits(const scenario::Criterion& criterion, const ResultSpec* declared) {
  if (!declared || declared->range.can_be_in(criterion.min.value_or(-kInfinity),
                                             criterion.max.value_or(kInfinity))) {
    return;
  }
  throw ConfigError(fmt::format("{}: criteria: no value of {} meets {} (possible: {})",
                                criterion.where.text(), criterion.metric, limits_text(criterion),
                                declared->range.text()));
}

}  // namespace

std::string sentence_of(const CriterionResult& criterion) {
  const std::string limit =
      fmt::format("({} {:g})", criterion.kind == "max" ? "at most" : "at least", criterion.limit);
  if (std::isnan(criterion.value)) {
    return fmt::format("{} not measured {}: {}", criterion.metric, limit,
                       why_not_measured(criterion.metric));
  }
  if (std::isinf(criterion.value)) return fmt::format("{} = infinite {}", criterion.metric, limit);
  // -0.0 + 0.0 is 0.0: a zero has no sign.
  return fmt::format("{} = {:.6g} {}", criterion.metric, criterion.value + 0.0, limit);
}

std::vector<CriterionResult> judge(
    const std::vector<scenario::Criterion>& criteria,
    const std::map<std::string, std::map<std::string, double>>& metrics) {
  std::vector<CriterionResult> results;
  for (const scenario::Criterion& criterion : criteria) {
    const double value = find_metric(criterion, metrics);
    // A value that was not measured (NaN) meets no limit: both comparisons are false.
    if (criterion.max) {
      results.push_back({criterion.name, criterion.metric, "max", value, *criterion.max,
                         value <= *criterion.max});
    }
    if (criterion.min) {
      results.push_back({criterion.name, criterion.metric, "min", value, *criterion.min,
                         value >= *criterion.min});
    }
  }
  return results;
}

const ResultSpec* find_declared_result(const scenario::Scenario& scenario, const Registry& registry,
                                       const std::string& metric) {
  const std::size_t dot = metric.find('.');
  const std::string owner = metric.substr(0, dot), name = metric.substr(dot + 1);
  for (const scenario::NamedPart& part : scenario.metrics) {
    const PartSpec& spec = registry.spec(PartKind::kMetric, part.part.type);
    if (const ResultSpec* found = find_result(spec.results, name)) return found;
  }
  for (const scenario::VehicleConfig& vehicle : scenario.vehicles) {
    if (vehicle.name != owner) continue;
    for (const scenario::NamedPart& payload : vehicle.payloads) {
      if (!name.starts_with(payload.name + "_")) continue;
      const PartSpec& spec = registry.spec(PartKind::kPayload, payload.part.type);
      const std::string rest = name.substr(payload.name.size() + 1);
      if (const ResultSpec* found = find_result(spec.results, rest)) return found;
    }
  }
  return find_result(separation_results(), name);
}

void check_criteria(const std::vector<scenario::Criterion>& criteria,
                    const std::map<std::string, std::map<std::string, double>>& metrics,
                    const std::function<const ResultSpec*(const std::string&)>& declared) {
  for (const scenario::Criterion& criterion : criteria) {
    static_cast<void>(find_metric(criterion, metrics));
    refuse_impossible_limits(criterion, declared(criterion.metric));
  }
}

}  // namespace vinerow

#include "engine/scenario/scenario_criterion.h"

#include <fmt/format.h>

#include "engine/api/parameter_table.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/scenario_part.h"

namespace vinerow::scenario {
namespace {

/// Checks a metric's name: "rover.cross_track_rms_m", or "rows" for a job's own number.
void check_metric(const std::string& metric, const io::SourceMark& mark, const std::string& path,
                  const CriterionScope& scope) {
  if (scope.plain && !metric.empty()) return;
  const std::size_t dot = metric.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == metric.size()) {
    io::fail_at(mark,
                fmt::format("{}.metric = '{}', must be <vehicle>.<metric>, e.g. "
                            "{}.cross_track_rms_m",
                            path, metric, scope.owners.empty() ? "rover" : scope.owners.front()));
  }
  check_vehicle(metric.substr(0, dot), scope.owners, mark,
                fmt::format("{}.metric = '{}'", path, metric));
}

Criterion read_criterion(const io::YamlNode& node, const std::string& path,
                         const CriterionScope& scope, io::YamlNode& written) {
  require_mapping(node, path, "{metric: rover.cross_track_rms_m, max: 0.05}");
  check_keys(node, path, names_of(criterion_table().specs()), "", nullptr);
  ReadParameters read =
      read_parameters(node, node.mark, path, criterion_table().specs(), "criteria");
  const CriterionParams params = criterion_table().read(read.values, "");
  Criterion criterion;
  criterion.where = node.mark;
  criterion.metric = params.metric;
  criterion.min = params.min;
  criterion.max = params.max;
  check_metric(criterion.metric, node.find("metric")->mark, path, scope);
  if (!criterion.min && !criterion.max) {
    io::fail_at(node.mark, fmt::format("{}: min or max must be given", path));
  }
  if (criterion.min && criterion.max && *criterion.min > *criterion.max) {
    io::fail_at(node.mark, fmt::format("{}: min = {} is above max = {}", path, *criterion.min,
                                       *criterion.max));
  }
  criterion.name = params.name.value_or("");
  if (criterion.name.empty()) {
    criterion.name = criterion.metric;
    if (criterion.min) criterion.name += fmt::format(" >= {}", *criterion.min);
    if (criterion.max) criterion.name += fmt::format(" <= {}", *criterion.max);
  }
  written = std::move(read.resolved);
  written.put("name", io::yaml_text(criterion.name));
  return criterion;
}

}  // namespace

std::vector<Criterion> read_criteria(const io::YamlEntry* entry, const std::string& path,
                                     const CriterionScope& scope, io::YamlNode& written) {
  written = io::yaml_list();
  std::vector<Criterion> criteria;
  if (!entry) return criteria;
  if (!entry->value.is_list()) {
    io::fail_at(entry->mark, fmt::format("{} = {}, must be a list of entries like {{metric: "
                                         "rover.cross_track_rms_m, max: 0.05}}",
                                         path, io::shown(entry->value)));
  }
  for (std::size_t i = 0; i < entry->value.items.size(); ++i) {
    io::YamlNode one;
    criteria.push_back(
        read_criterion(entry->value.items[i], fmt::format("{}[{}]", path, i), scope, one));
    written.items.push_back(std::move(one));
  }
  return criteria;
}

}  // namespace vinerow::scenario

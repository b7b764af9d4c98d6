#include "tools/report/metric_table.h"

#include <optional>
#include <string_view>
#include <vector>

#include "engine/api/registry.h"
#include "engine/sim/separation.h"
#include "tools/parts/register_all.h"
#include "tools/report/units.h"

namespace vinerow::tools::report {
namespace {

/// All results that built-in parts declare. Those of payloads carry the payload's name in front,
/// as in summary.json.
std::vector<ResultSpec> all_results() {
  Registry registry;
  register_all(registry);
  std::vector<ResultSpec> all;
  for (const PartKind kind : {PartKind::kMetric, PartKind::kPayload, PartKind::kJob}) {
    for (const std::string& name : registry.names(kind)) {
      for (ResultSpec result : registry.spec(kind, name).results) {
        if (kind == PartKind::kPayload) result.name = "<payload>_" + result.name;
        all.push_back(std::move(result));
      }
    }
  }
  for (const ResultSpec& result : separation_results()) all.push_back(result);
  return all;
}

/// What the placeholders of a form such as "slip_max_<wheel>" stand for in a name; nothing if the
/// name has another form.
std::optional<std::vector<std::string>> placeholders_in(std::string_view name,
                                                        std::string_view form) {
  const std::size_t open = form.find('<');
  if (open == std::string_view::npos) {
    if (form != name) return std::nullopt;
    return std::vector<std::string>{};
  }
  if (!name.starts_with(form.substr(0, open))) return std::nullopt;
  const std::string_view rest = form.substr(form.find('>', open) + 1);
  for (std::size_t end = open + 1; end <= name.size(); ++end) {
    if (auto found = placeholders_in(name.substr(end), rest)) {
      found->insert(found->begin(), std::string(name.substr(open, end - open)));
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace

MetricMeaning metric_meaning(const std::string& name) {
  static const std::vector<ResultSpec> results = all_results();
  const ResultSpec* best = nullptr;
  std::vector<std::string> best_values;
  std::size_t best_length = 0;
  for (const ResultSpec& result : results) {
    auto values = placeholders_in(name, result.name);
    if (!values) continue;
    // The form with the most letters of its own: "<payload>_canopy_pictures" rather than
    // "<payload>_pictures".
    std::size_t length = name.size();
    for (const std::string& value : *values) length -= value.size();
    if (best && length <= best_length) continue;
    best = &result;
    best_values = std::move(*values);
    best_length = length;
  }
  if (!best) return {words_of(name), "", "", false};
  MetricMeaning meaning{best->title, best->definition, best->source, true};
  for (const std::string& value : best_values) meaning.title += " (" + value + ")";
  return meaning;
}

}  // namespace vinerow::tools::report

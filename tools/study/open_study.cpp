#include "tools/study/open_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/run/run.h"
#include "engine/scenario/known_names.h"
#include "engine/sim/plugin_loader.h"
#include "engine/sim/run_shelf.h"
#include "engine/sim/session.h"
#include "tools/parts/register_all.h"
#include "tools/study/derived.h"

namespace vinerow::study {
namespace {

/// Levels to try before the first cell: all, or only the extreme ones if a numeric factor has many.
std::vector<std::size_t> levels_to_try(const scenario::Factor& factor) {
  constexpr std::size_t kMax = 100;
  std::vector<std::size_t> all(factor.levels.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  if (all.size() <= kMax) return all;
  std::set<std::size_t> ends = {0, all.size() - 1};
  for (std::size_t column = 0; column < factor.columns.size(); ++column) {
    const auto less = [&](std::size_t a, std::size_t b) {
      return std::strtod(factor.levels[a].texts[column].c_str(), nullptr) <
             std::strtod(factor.levels[b].texts[column].c_str(), nullptr);
    };
    const auto [low, high] = std::minmax_element(all.begin(), all.end(), less);
    ends.insert({*low, *high});
  }
  return {ends.begin(), ends.end()};
}

/// Names of a cell's numbers, as far as they are known before its run.
std::set<std::string> numbers_of(const OpenStudy& open, const std::vector<std::size_t>& levels,
                                 const std::shared_ptr<RunShelf>& shelf) {
  SessionOptions options;
  options.shelf = shelf;
  const Session session(open.source.load(open.registry, open.design.overrides_of(levels)),
                        std::shared_ptr<const Registry>(std::shared_ptr<void>(), &open.registry),
                        std::move(options));
  std::set<std::string> names = {"run.met", "run.finished", "run.simulated_s"};
  for (const auto& [owner, numbers] : session.metrics()) {
    for (const auto& [name, value] : numbers) names.insert(owner + "." + name);
  }
  return names;
}

/// Name used by the study, and the place of its use.
struct UsedName {
  std::string name, what;
  io::SourceMark mark;
};

std::vector<UsedName> used_names(const scenario::Study& study) {
  std::vector<UsedName> used;
  for (const std::string& metric : study.metrics) {
    used.push_back({metric, "metrics", study.metrics_mark});
  }
  std::set<std::string> own;
  for (const scenario::Factor& factor : study.factors) {
    own.insert(factor.columns.begin(), factor.columns.end());
  }
  for (const scenario::DerivedColumn& column : study.derived) {
    for (const std::string& name : variables_of(column)) {
      if (!own.contains(name)) used.push_back({name, "derived." + column.name, column.where});
    }
    own.insert(column.name);
  }
  if (study.stop && !own.contains(study.stop->metric)) {
    used.push_back({study.stop->metric, "stop.metric", study.stop_mark});
  }
  return used;
}

/// Whether a name can be known only after the run: counters of planners, numbers of jobs.
bool is_known_later(const std::string& name, const scenario::Scenario& scenario) {
  const std::string owner = name.substr(0, name.find('.'));
  if (owner == "planning") return true;
  if (name == "run.phases" || name == "run.phases_succeeded") return !scenario.phases.empty();
  return std::any_of(scenario.phases.begin(), scenario.phases.end(),
                     [&](const auto& phase) { return phase.job && phase.name == owner; });
}

void check_names(const OpenStudy& open) {
  std::vector<UsedName> missing = used_names(open.study);
  if (missing.empty()) return;
  const auto shelf = std::make_shared<RunShelf>();
  std::set<std::string> known;
  const auto look = [&](const std::vector<std::size_t>& levels) {
    known.merge(numbers_of(open, levels, shelf));
    const scenario::Scenario scenario =
        open.source.load(open.registry, open.design.overrides_of(levels));
    std::erase_if(missing, [&](const UsedName& used) {
      return known.contains(used.name) || is_known_later(used.name, scenario);
    });
  };
  std::vector<std::size_t> first(open.study.factors.size(), 0);
  look(first);
  // Levels with other parts may have other numbers.
  for (std::size_t k = 0; k < first.size() && !missing.empty(); ++k) {
    for (const std::size_t level : levels_to_try(open.study.factors[k])) {
      std::vector<std::size_t> levels = first;
      levels[k] = level;
      if (level > 0 && !missing.empty()) look(levels);
    }
  }
  if (missing.empty()) return;
  const UsedName& used = missing.front();
  const std::vector<std::string> names(known.begin(), known.end());
  constexpr std::size_t kShown = 12;
  io::fail_at(used.mark,
              fmt::format("{}: no cell has a number '{}'{} (known: {})", used.what, used.name,
                          did_you_mean(used.name, names), scenario::list_known(names, kShown)));
}

}  // namespace

OpenStudy::OpenStudy(const std::filesystem::path& file)
    : study(scenario::load_study(file)),
      design(study),
      source(study.scenario),
      registry([this] {
        Registry made;
        register_all(made);
        const std::vector<std::size_t> first(study.factors.size(), 0);
        for (const auto& plugin :
             scenario::load_plugin_list(study.scenario, design.overrides_of(first))) {
          load_plugin(plugin, made);
        }
        return made;
      }()),
      identity(design, source, program_digest()) {}

void check_study(const OpenStudy& open) {
  const std::vector<std::size_t> first(open.study.factors.size(), 0);
  const auto check = [&](const std::vector<std::size_t>& levels) {
    run::check_runs_alone(open.source.load(open.registry, open.design.overrides_of(levels)));
  };
  check(first);
  for (std::size_t k = 0; k < first.size(); ++k) {
    for (const std::size_t level : levels_to_try(open.study.factors[k])) {
      if (level == 0) continue;
      std::vector<std::size_t> levels = first;
      levels[k] = level;
      check(levels);
    }
  }
  check_names(open);
}

}  // namespace vinerow::study

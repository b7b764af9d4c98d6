#include "tools/study/design.h"

#include <algorithm>

#include "engine/core/check.h"

namespace vinerow::study {
namespace {

bool changes_world(const scenario::Factor& factor) {
  for (const scenario::FactorLevel& level : factor.levels) {
    for (const scenario::OverrideValue& value : level.values) {
      const std::string key = value.path.substr(0, value.path.find('.'));
      if (key == "world" || key == "physics" || key == "gravity_mps2") return true;
    }
  }
  return false;
}

}  // namespace

Design::Design(const scenario::Study& study) : study_(study) {
  for (const scenario::Factor& factor : study.factors) {
    VINEROW_DEMAND(!factor.levels.empty());
    settings_ *= factor.levels.size();
    changes_world_.push_back(changes_world(factor));
    columns_.insert(columns_.end(), factor.columns.begin(), factor.columns.end());
  }
}

std::vector<std::size_t> Design::levels(std::size_t setting) const {
  std::vector<std::size_t> levels(study_.factors.size());
  for (std::size_t k = levels.size(); k-- > 0;) {
    const std::size_t count = study_.factors[k].levels.size();
    levels[k] = setting % count;
    setting /= count;
  }
  return levels;
}

scenario::Overrides Design::overrides_of(const std::vector<std::size_t>& levels) const {
  scenario::Overrides overrides;
  overrides.values = study_.set;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const auto& values = study_.factors[k].levels[levels[k]].values;
    overrides.values.insert(overrides.values.end(), values.begin(), values.end());
  }
  return overrides;
}

scenario::Overrides Design::overrides(std::size_t cell) const {
  scenario::Overrides overrides = overrides_of(levels(setting_of(cell)));
  overrides.seed = seed_of(cell);
  return overrides;
}

std::vector<std::string> Design::texts(std::size_t setting) const {
  std::vector<std::string> texts;
  const std::vector<std::size_t> at = levels(setting);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const auto& more = study_.factors[k].levels[at[k]].texts;
    texts.insert(texts.end(), more.begin(), more.end());
  }
  return texts;
}

std::vector<std::size_t> Design::settings_in_running_order() const {
  // Number of each setting's world: settings counted over the factors that change the world only.
  std::vector<std::size_t> world_of(settings_, 0), order(settings_);
  for (std::size_t setting = 0; setting < settings_; ++setting) {
    order[setting] = setting;
    std::size_t rest = setting, stride = 1;
    for (std::size_t k = study_.factors.size(); k-- > 0;) {
      const std::size_t count = study_.factors[k].levels.size();
      if (changes_world_[k]) {
        world_of[setting] += rest % count * stride;
        stride *= count;
      }
      rest /= count;
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return world_of[a] < world_of[b]; });
  return order;
}

}  // namespace vinerow::study

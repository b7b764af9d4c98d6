#include "tools/dataset/splits.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "engine/core/random.h"

namespace vinerow::dataset {
namespace {

std::uint64_t group_of(const study::Design& design, scenario::SplitBy by, std::size_t cell) {
  switch (by) {
    case scenario::SplitBy::kSeed:
      return design.seed_of(cell);
    case scenario::SplitBy::kSetting:
      return design.setting_of(cell);
    case scenario::SplitBy::kCell:
      break;
  }
  return cell;
}

}  // namespace

std::vector<Split> make_splits(const study::Design& design, const scenario::DatasetConfig& config) {
  std::map<std::uint64_t, Split> part_of_group;
  for (std::size_t cell = 0; cell < design.cells(); ++cell) {
    part_of_group[group_of(design, config.split_by, cell)] = Split::kTrain;
  }
  std::vector<std::uint64_t> groups;
  for (const auto& [group, part] : part_of_group) groups.push_back(group);
  RandomStream random(1, "dataset", "splits");
  for (std::size_t i = groups.size(); i > 1; --i) {
    std::swap(groups[i - 1], groups[random.next_u64() % i]);
  }
  std::size_t next = 0;
  const auto take = [&](double share, Split part) {
    if (share <= 0.0) return;
    const auto wanted = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::lround(share * static_cast<double>(groups.size()))));
    for (std::size_t k = 0; k < wanted && next + 1 < groups.size(); ++k) {
      part_of_group[groups[next++]] = part;
    }
  };
  take(config.validation_share, Split::kValidation);
  take(config.test_share, Split::kTest);
  std::vector<Split> parts;
  for (std::size_t cell = 0; cell < design.cells(); ++cell) {
    parts.push_back(part_of_group.at(group_of(design, config.split_by, cell)));
  }
  return parts;
}

}  // namespace vinerow::dataset

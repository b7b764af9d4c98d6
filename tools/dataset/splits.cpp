#include "tools/dataset/splits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "engine/core/random.h"
#include "engine/io/files/yaml.h"

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

void check_group_count(const study::Design& design, const scenario::DatasetConfig& config,
                       std::size_t groups, std::size_t parts) {
  if (groups >= parts) return;
  io::fail_at(design.study().dataset_mark,
              fmt::format("dataset.validation_share = {:g} and test_share = {:g} need at least {} "
                          "{}s, but the study has {}; add some, choose another split_by, or set a "
                          "share to 0",
                          config.validation_share, config.test_share, parts,
                          group_name(config.split_by), groups));
}

}  // namespace

const char* group_name(scenario::SplitBy by) {
  return by == scenario::SplitBy::kCell   ? "run"
         : by == scenario::SplitBy::kSeed ? "seed"
                                          : "setting";
}

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
  const auto wanted = [&](double share) -> std::size_t {
    if (share <= 0.0) return 0;
    return std::max(1l, std::lround(share * static_cast<double>(groups.size())));
  };
  std::size_t validation = wanted(config.validation_share), test = wanted(config.test_share);
  check_group_count(design, config, groups.size(), 1u + (validation > 0) + (test > 0));
  // Rounded up, they may leave none for training.
  while (validation + test >= groups.size()) --(validation > test ? validation : test);
  for (std::size_t k = 0; k < validation + test; ++k) {
    part_of_group[groups[k]] = k < validation ? Split::kValidation : Split::kTest;
  }
  std::vector<Split> parts;
  for (std::size_t cell = 0; cell < design.cells(); ++cell) {
    parts.push_back(part_of_group.at(group_of(design, config.split_by, cell)));
  }
  return parts;
}

}  // namespace vinerow::dataset

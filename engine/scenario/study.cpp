#include "engine/scenario/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/scenario_reader.h"
#include "engine/scenario/shipped_file.h"
#include "engine/scenario/study_factor.h"
#include "engine/scenario/study_keys.h"
#include "engine/scenario/yaml_include.h"

namespace vinerow::scenario {
namespace {

std::vector<OverrideValue> read_set(const io::YamlNode& node) {
  require_mapping(node, "set", "{duration_s: 100, rover.controller.speed_mps: 0.8}");
  std::vector<OverrideValue> values;
  for (const io::YamlEntry& entry : node.entries) values.push_back({entry.key, entry.value});
  return values;
}

std::vector<DerivedColumn> read_derived(const io::YamlNode& node) {
  require_mapping(node, "derived", "{product: rover.average_deviation_m * rover.time_s}");
  std::vector<DerivedColumn> columns;
  for (const io::YamlEntry& entry : node.entries) {
    check_name(entry, "derived", "column");
    if (!entry.value.is_scalar() || entry.value.text.empty()) {
      io::fail_at(entry.mark, fmt::format("derived.{} = {}, must be an expression of metrics",
                                          entry.key, io::shown(entry.value)));
    }
    columns.push_back({entry.key, entry.value.text, entry.mark});
  }
  return columns;
}

std::uint64_t read_seed(const io::YamlNode& node, const std::string& path) {
  const io::YamlScalar value = node.is_scalar() ? io::scalar_value(node) : io::YamlScalar(0.5);
  const auto* seed = std::get_if<std::int64_t>(&value);
  if (!seed || *seed < 0) {
    io::fail_at(node.mark,
                fmt::format("{} = {}, must be a whole number from 0", path, io::shown(node)));
  }
  return static_cast<std::uint64_t>(*seed);
}

/// Reads the seeds: 10 means 1 to 10, a list gives the seeds themselves.
std::vector<std::uint64_t> read_seeds(const io::YamlNode& node) {
  std::vector<std::uint64_t> seeds;
  if (node.is_list()) {
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      seeds.push_back(read_seed(node.items[i], fmt::format("seeds[{}]", i)));
    }
    std::set<std::uint64_t> once(seeds.begin(), seeds.end());
    if (once.size() < seeds.size()) io::fail_at(node.mark, "seeds names a seed twice");
  } else {
    const std::uint64_t count = read_seed(node, "seeds");
    if (static_cast<double>(count) > kMaxCells) {
      io::fail_at(node.mark, fmt::format("seeds = {}, must be at most {:.0f}", count, kMaxCells));
    }
    for (std::uint64_t seed = 1; seed <= count; ++seed) seeds.push_back(seed);
  }
  if (seeds.empty()) {
    io::fail_at(node.mark,
                fmt::format("seeds = {}, must be the number of seeds (at least 1) or a list "
                            "of them",
                            io::shown(node)));
  }
  return seeds;
}

/// Checks that at most one factor varies each key path. A factor may vary a part of a value set by
/// an earlier factor.
void check_key_paths(const Study& study) {
  struct Use {
    std::string path, by;
  };
  std::vector<Use> uses;
  const auto check = [&](const std::string& path, const std::string& by,
                         const io::SourceMark& mark) {
    for (const Use& use : uses) {
      if (use.path == path) {
        io::fail_at(mark,
                    fmt::format("{} is set by {} and by {}; remove one of them", path, use.by, by));
      }
      if (use.path.starts_with(path + ".")) {
        io::fail_at(mark, fmt::format("{} of {} would overwrite {} of {}; put {} first", path, by,
                                      use.path, use.by, by));
      }
    }
  };
  for (const OverrideValue& value : study.set) {
    check(value.path, "set", value.value.mark);
    uses.push_back({value.path, "set"});
  }
  for (const Factor& factor : study.factors) {
    // Levels of one factor may share paths.
    std::map<std::string, io::SourceMark> mine;
    for (const FactorLevel& level : factor.levels) {
      for (const OverrideValue& value : level.values) mine.emplace(value.path, value.value.mark);
    }
    const std::string by = "factors." + factor.name;
    for (const auto& [path, mark] : mine) {
      if (path == "seed") io::fail_at(mark, by + " cannot vary seed; list the seeds under 'seeds'");
      check(path, by, mark);
    }
    for (const auto& [path, mark] : mine) uses.push_back({path, by});
  }
}

/// Readers of the tables take columns by name, so each name is there once.
void check_columns(const Study& study) {
  std::map<std::string, std::string> seen;
  for (const char* own : {"cell", "setting", "seed", "state", "reason", "digest", "finished", "met",
                          "failed", "met_share", "met_share_low", "met_share_high"}) {
    seen.emplace(own, "every table");
  }
  const auto take = [&](const std::string& column, const std::string& who,
                        const io::SourceMark& where) {
    const auto [place, is_new] = seen.emplace(column, who);
    if (is_new) return;
    io::fail_at(where, fmt::format("{} and {} both give a column '{}'; rename {}", place->second,
                                   who, column, who));
  };
  for (const Factor& factor : study.factors) {
    for (const std::string& column : factor.columns) {
      take(column, "factors." + factor.name, factor.where);
    }
  }
  for (const DerivedColumn& column : study.derived) {
    take(column.name, "derived." + column.name, column.where);
  }
  for (const std::string& metric : study.metrics) {
    if (std::count(study.metrics.begin(), study.metrics.end(), metric) == 1) continue;
    io::fail_at(study.metrics_mark, fmt::format("metrics has '{}' twice", metric));
  }
}

void check_cell_count(const Study& study, const io::SourceMark& mark) {
  double cells = static_cast<double>(study.seeds.size());
  for (const Factor& factor : study.factors) cells *= static_cast<double>(factor.levels.size());
  if (cells <= kMaxCells) return;
  std::string product = fmt::format("{} seeds", study.seeds.size());
  for (const Factor& factor : study.factors) {
    product += fmt::format(" x {} of {}", factor.levels.size(), factor.name);
  }
  io::fail_at(mark,
              fmt::format("{} make {:.3g} cells, must be at most {:.0f}; sample the factors, or "
                          "reduce the study",
                          product, cells, kMaxCells));
}

/// A data set's list of names: at least one, each once.
void check_names(const io::YamlNode& dataset, const char* key,
                 const std::vector<std::string>& names) {
  const io::YamlNode* node = dataset.find(key);
  const io::SourceMark& mark = node ? node->mark : dataset.mark;
  if (names.empty()) {
    io::fail_at(mark, fmt::format("dataset.{} = [], must name at least one", key));
  }
  for (const std::string& name : names) {
    if (std::count(names.begin(), names.end(), name) == 1) continue;
    io::fail_at(mark, fmt::format("dataset.{} has '{}' twice", key, name));
  }
}

/// Something is left for training.
void check_shares(const io::YamlNode& dataset, const DatasetConfig& config) {
  const double both = config.validation_share + config.test_share;
  if (both < 1.0) return;
  const io::YamlNode* node = dataset.find("validation_share");
  if (!node) node = dataset.find("test_share");
  io::fail_at(node->mark, fmt::format("dataset.validation_share + dataset.test_share = {:g}, must "
                                      "be < 1: the rest is for training",
                                      both));
}

}  // namespace

Study load_study(const std::filesystem::path& named) {
  const std::filesystem::path file = find_shipped(named);
  const io::YamlNode root = load_yaml_with_includes(file);
  const io::SourceMark whole{file.string(), 0};
  const std::vector<ParameterSpec> specs = study_table().specs();
  std::vector<std::string> known = names_of(specs);
  for (const FreeStudyKey& key : free_study_keys()) known.push_back(key.name);
  check_keys(root, "", known, "", nullptr);
  const io::YamlNode* version = root.find("vinerow_study");
  if (!version) {
    io::fail_at(whole,
                fmt::format("vinerow_study must be given: the version of the file format, which "
                            "is {} ('vinerow_study: {}')",
                            kStudyVersion, kStudyVersion));
  }
  const ReadParameters read = read_parameters(root, whole, "", specs, "study");
  const StudyValues values = study_table().read(read.values, "");
  if (values.format != kStudyVersion) {
    io::fail_at(version->mark,
                fmt::format("vinerow_study = {}, this program reads version {} of the "
                            "file format",
                            values.format, kStudyVersion));
  }
  Study study = values.study;
  study.file = std::filesystem::absolute(file).lexically_normal();
  if (study.name.empty()) study.name = file.stem().string();
  if (!is_valid_name(study.name)) {
    const io::YamlNode* name = root.find("name");
    io::fail_at(
        name ? name->mark : whole,
        fmt::format("name = '{}', must be made of letters, digits, '_' and '-' and start with "
                    "a letter or '_' (results go to runs/<name>)",
                    study.name));
  }
  if (const io::YamlNode* stop = root.find("stop")) study.stop_mark = stop->mark;
  if (const io::YamlNode* metrics = root.find("metrics")) study.metrics_mark = metrics->mark;
  if (const io::YamlNode* dataset = root.find("dataset")) {
    study.dataset_mark = dataset->mark;
    check_names(*dataset, "formats", study.dataset->formats);
    check_names(*dataset, "classes", study.dataset->classes);
    check_shares(*dataset, *study.dataset);
  }
  if (const io::YamlNode* node = root.find("set")) study.set = read_set(*node);
  if (const io::YamlNode* node = root.find("factors")) study.factors = read_factors(*node);
  if (const io::YamlNode* node = root.find("derived")) study.derived = read_derived(*node);
  const io::YamlNode* seeds = root.find("seeds");
  study.seeds = seeds ? read_seeds(*seeds) : std::vector<std::uint64_t>{1};
  check_key_paths(study);
  check_columns(study);
  check_cell_count(study, whole);
  if (study.stop && study.stop->at_least > static_cast<int>(study.seeds.size())) {
    io::fail_at(study.stop_mark, fmt::format("stop.at_least = {}, but there are {} seeds",
                                             study.stop->at_least, study.seeds.size()));
  }
  return study;
}

}  // namespace vinerow::scenario

#include "engine/scenario/study_factor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/scenario/scenario_reader.h"
#include "engine/scenario/space_filling.h"
#include "engine/scenario/yaml_include.h"

namespace vinerow::scenario {
namespace {

/// Forms of a factor; each has a key that no other form has.
enum class FactorForm { kValues, kRange, kAlternatives, kZip, kSample };

struct FormKeys {
  FactorForm form;
  const char* tag;
  const char* example;
  std::vector<std::string> keys;
};

const std::vector<FormKeys>& forms() {
  static const std::vector<FormKeys> all = [] {
    std::vector<std::string> range = {"key"};
    for (const auto& specs : {factor_range_table().specs(), range_steps_table().specs()}) {
      for (const std::string& name : names_of(specs)) range.push_back(name);
    }
    std::vector<std::string> sample = names_of(sample_table().specs());
    sample.push_back("ranges");
    return std::vector<FormKeys>{
        {FactorForm::kValues,
         "values",
         "{key: rover.controller.lookahead_m, values: [0.5, 1]}",
         {"key", "values"}},
        {FactorForm::kRange, "from",
         "{key: rover.controller.lookahead_m, from: 0.5, to: 2, step: 0.5}", range},
        {FactorForm::kAlternatives,
         "alternatives",
         "{alternatives: {lqr: {plane.controller: {type: fixed_wing_lqr}}}}",
         {"alternatives"}},
        {FactorForm::kZip,
         "zip",
         "{zip: {rover.controller.speed_mps: [1, 2], duration_s: [200, 100]}}",
         {"zip"}},
        {FactorForm::kSample, "sample",
         "{sample: sobol, count: 64, ranges: {rover.controller.lookahead_m: {from: 0.5, to: 2}}}",
         sample}};
  }();
  return all;
}

const FormKeys& form_of(const io::YamlNode& node, const std::string& path) {
  require_mapping(node, path, forms().front().example);
  for (const FormKeys& form : forms()) {
    if (node.has(form.tag)) return form;
  }
  std::string tags;
  for (const FormKeys& form : forms()) tags += (tags.empty() ? "" : ", ") + std::string(form.tag);
  io::fail_at(node.mark, fmt::format("{} must have one of the keys {}; e.g. {}", path, tags,
                                     forms().front().example));
}

/// Text of a value in tables: a text without quotes, a mapping in one line.
std::string table_text(const io::YamlNode& value) {
  if (value.is_scalar()) return value.text;
  if (value.is_null()) return "";
  io::YamlNode flow = value;
  flow.flow = true;
  std::string text = io::to_yaml(flow);
  while (text.ends_with('\n')) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

io::YamlNode number_node(double value, const io::YamlNode& like) {
  const bool is_whole = value == std::floor(value) && std::abs(value) < 9e15;
  io::YamlNode node =
      is_whole ? io::yaml_integer(static_cast<std::int64_t>(value)) : io::yaml_number(value);
  node.mark = like.mark;
  node.folder = like.folder;
  return node;
}

std::string read_key(const io::YamlNode& node, const std::string& path, const char* example) {
  const io::YamlNode* key = node.find("key");
  if (!key) {
    io::fail_at(node.mark, fmt::format("{}.key must be given: the path of a parameter; e.g. {}",
                                       path, example));
  }
  if (!key->is_scalar() || key->text.empty()) {
    io::fail_at(key->mark, fmt::format("{}.key = {}, must be the path of a parameter, e.g. "
                                       "rover.controller.lookahead_m",
                                       path, io::shown(*key)));
  }
  return key->text;
}

void require_items(const io::YamlNode& list, const std::string& path) {
  if (!list.is_list()) {
    io::fail_at(list.mark, fmt::format("{} = {}, must be a list of values", path, io::shown(list)));
  }
  if (list.items.empty()) {
    io::fail_at(list.mark, fmt::format("{} is empty, must have at least one value", path));
  }
}

void require_entries(const io::YamlNode& mapping, const std::string& path, const char* example) {
  require_mapping(mapping, path, example);
  if (mapping.entries.empty()) {
    io::fail_at(mapping.mark, fmt::format("{} is empty, must have at least one entry", path));
  }
}

void read_values(const io::YamlNode& node, const std::string& path, Factor& factor) {
  const std::string key = read_key(node, path, forms().front().example);
  const io::YamlNode& values = *node.find("values");
  require_items(values, path + ".values");
  factor.columns = {factor.name};
  for (const io::YamlNode& value : values.items) {
    factor.levels.push_back({{{key, value}}, {table_text(value)}});
  }
}

FactorRange read_range(const io::YamlNode& node, const std::string& path) {
  const auto& specs = factor_range_table().specs();
  const FactorRange range =
      factor_range_table().read(read_parameters(node, node.mark, path, specs, "").values, "");
  if (!(range.from <= range.to)) {
    io::fail_at(node.mark,
                fmt::format("{}: from = {} is above to = {}", path, range.from, range.to));
  }
  if (range.logarithmic && !(range.from > 0.0)) {
    io::fail_at(node.find("from")->mark,
                fmt::format("{}.from = {}, must be > 0 on a logarithmic scale", path, range.from));
  }
  return range;
}

/// Values of a range as shares of it (0 to 1).
std::vector<double> shares_of(const FactorRange& range, const io::YamlNode& node,
                              const std::string& path) {
  const auto& specs = range_steps_table().specs();
  const RangeSteps steps =
      range_steps_table().read(read_parameters(node, node.mark, path, specs, "").values, "");
  if (steps.step.has_value() == steps.count.has_value()) {
    io::fail_at(node.mark, fmt::format("{}: one of step and count must be given", path));
  }
  if (steps.step && range.logarithmic) {
    io::fail_at(node.find("step")->mark,
                fmt::format("{}.step = {}, must not be given for a logarithmic scale; give count",
                            path, *steps.step));
  }
  const double span = range.to - range.from;
  constexpr double kRounding = 1e-9;
  const double count = steps.count ? static_cast<double>(*steps.count)
                                   : std::floor(span / *steps.step + kRounding) + 1.0;
  if (count > kMaxCells) {
    io::fail_at(node.mark, fmt::format("{} has {:.6g} values, must have at most {:.0f}", path,
                                       count, kMaxCells));
  }
  // With a step, the last value may be below `to`.
  const double last = steps.count || span == 0.0 ? 1.0 : (count - 1.0) * *steps.step / span;
  std::vector<double> shares(static_cast<std::size_t>(count), 0.0);
  for (std::size_t i = 1; i < shares.size(); ++i) {
    shares[i] = last * static_cast<double>(i) / (count - 1.0);
  }
  return shares;
}

void read_range_factor(const io::YamlNode& node, const std::string& path, Factor& factor) {
  const std::string key = read_key(node, path, forms()[1].example);
  const FactorRange range = read_range(node, path);
  factor.columns = {factor.name};
  for (const double share : shares_of(range, node, path)) {
    const io::YamlNode value = number_node(number_at(range, share), node);
    // Several values may round to the same whole number.
    if (!factor.levels.empty() && factor.levels.back().texts.front() == value.text) continue;
    factor.levels.push_back({{{key, value}}, {value.text}});
  }
}

void read_alternatives(const io::YamlNode& node, const std::string& path, Factor& factor) {
  const char* example = "{lqr: {plane.controller: {type: fixed_wing_lqr}}}";
  const io::YamlNode& alternatives = *node.find("alternatives");
  require_entries(alternatives, path + ".alternatives", example);
  factor.columns = {factor.name};
  for (const io::YamlEntry& alternative : alternatives.entries) {
    const std::string place = fmt::format("{}.alternatives.{}", path, alternative.key);
    // An empty alternative is the unmodified scenario.
    require_mapping(alternative.value, place, "{plane.controller: {type: fixed_wing_lqr}}");
    FactorLevel level{{}, {alternative.key}};
    for (const io::YamlEntry& value : alternative.value.entries) {
      level.values.push_back({value.key, value.value});
    }
    factor.levels.push_back(std::move(level));
  }
}

void read_zip(const io::YamlNode& node, const std::string& path, Factor& factor) {
  const io::YamlNode& zip = *node.find("zip");
  require_entries(zip, path + ".zip", "{duration_s: [100, 200], seed: [1, 2]}");
  for (const io::YamlEntry& entry : zip.entries) {
    const std::string place = fmt::format("{}.zip.{}", path, entry.key);
    require_items(entry.value, place);
    if (factor.columns.empty()) factor.levels.resize(entry.value.items.size());
    if (entry.value.items.size() != factor.levels.size()) {
      io::fail_at(entry.mark,
                  fmt::format("{} has {} values, {} has {}; zipped lists must be equally "
                              "long",
                              place, entry.value.items.size(), zip.entries.front().key,
                              factor.levels.size()));
    }
    factor.columns.push_back(entry.key);
    for (std::size_t i = 0; i < factor.levels.size(); ++i) {
      factor.levels[i].values.push_back({entry.key, entry.value.items[i]});
      factor.levels[i].texts.push_back(table_text(entry.value.items[i]));
    }
  }
}

void read_sample(const io::YamlNode& node, const std::string& path, Factor& factor) {
  const auto& specs = sample_table().specs();
  const SampleParams params =
      sample_table().read(read_parameters(node, node.mark, path, specs, "").values, "");
  const io::YamlNode* ranges = node.find("ranges");
  const char* example = "{rover.controller.lookahead_m: {from: 0.5, to: 2}}";
  if (!ranges) {
    io::fail_at(node.mark, fmt::format("{}.ranges must be given, e.g. {}", path, example));
  }
  require_entries(*ranges, path + ".ranges", example);
  std::vector<FactorRange> read;
  for (const io::YamlEntry& entry : ranges->entries) {
    const std::string place = fmt::format("{}.ranges.{}", path, entry.key);
    require_mapping(entry.value, place, "{from: 0.5, to: 2}");
    check_keys(entry.value, place, names_of(factor_range_table().specs()), "", nullptr);
    read.push_back(read_range(entry.value, place));
    factor.columns.push_back(entry.key);
  }
  if (params.kind == SampleKind::kSobol && read.size() > kMaxSobolDimensions) {
    io::fail_at(ranges->mark, fmt::format("{}.ranges has {} keys, a Sobol sample at most {}", path,
                                          read.size(), kMaxSobolDimensions));
  }
  const auto count = static_cast<std::size_t>(params.count);
  const std::vector<std::vector<double>> points =
      params.kind == SampleKind::kSobol
          ? sobol_points(count, read.size())
          : latin_hypercube(count, read.size(), static_cast<std::uint64_t>(params.seed));
  factor.levels.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < read.size(); ++k) {
      const io::YamlEntry& entry = ranges->entries[k];
      const io::YamlNode value = number_node(number_at(read[k], points[i][k]), entry.value);
      factor.levels[i].values.push_back({entry.key, value});
      factor.levels[i].texts.push_back(value.text);
    }
  }
}

Factor read_factor(const io::YamlEntry& entry) {
  const std::string path = "factors." + entry.key;
  check_name(entry, "factors", "factor");
  const FormKeys& form = form_of(entry.value, path);
  check_keys(entry.value, path, form.keys, fmt::format("a factor by '{}'", form.tag), nullptr);
  Factor factor;
  factor.name = entry.key;
  factor.where = entry.mark;
  switch (form.form) {
    case FactorForm::kValues:
      read_values(entry.value, path, factor);
      break;
    case FactorForm::kRange:
      read_range_factor(entry.value, path, factor);
      break;
    case FactorForm::kAlternatives:
      read_alternatives(entry.value, path, factor);
      break;
    case FactorForm::kZip:
      read_zip(entry.value, path, factor);
      break;
    case FactorForm::kSample:
      read_sample(entry.value, path, factor);
      break;
  }
  return factor;
}

}  // namespace

const ParameterTable<FactorRange>& factor_range_table() {
  using P = FactorRange;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("from", "", &P::from, kAnyNumber, "the first value, in the parameter's unit")
          .required()
          .number("to", "", &P::to, kAnyNumber,
                  "the last value, or the upper limit of values with a step")
          .required()
          .choice("scale", &P::logarithmic, {{"linear", false}, {"log", true}},
                  "values with equal steps or with equal ratios")
          .boolean("whole", &P::whole, "round to whole numbers");
  return table;
}

const ParameterTable<RangeSteps>& range_steps_table() {
  using P = RangeSteps;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("step", "", &P::step, kPositive, "difference between successive values")
          .integer("count", &P::count, between(1, kMaxCells), "number of values");
  return table;
}

const ParameterTable<SampleParams>& sample_table() {
  using P = SampleParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("sample", &P::kind,
                  {{"latin_hypercube", SampleKind::kLatinHypercube}, {"sobol", SampleKind::kSobol}},
                  "distribution of points over the ranges: one in each of `count` slices of every "
                  "key (McKay et al. 1979), or the Sobol sequence (1967) without its first point")
          .required()
          .integer("count", &P::count, between(1, kMaxCells), "number of points")
          .required()
          .integer("seed", &P::seed, kNotNegative, "seed of a Latin hypercube");
  return table;
}

double number_at(const FactorRange& range, double share) {
  double value = range.from + share * (range.to - range.from);
  if (range.logarithmic) value = range.from * std::pow(range.to / range.from, share);
  if (range.whole) return std::round(value);
  return std::stod(fmt::format("{:.12g}", value));
}

std::vector<Factor> read_factors(const io::YamlNode& node) {
  require_mapping(node, "factors", "{lookahead: " + std::string(forms().front().example) + "}");
  std::vector<Factor> factors;
  for (const io::YamlEntry& entry : node.entries) factors.push_back(read_factor(entry));
  return factors;
}

}  // namespace vinerow::scenario

#include "tools/vinerow/table_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "tools/vinerow/parameter_words.h"

namespace vinerow::tools {
namespace {

bool has_key(const std::vector<std::string>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Unit as spelt in keys: "mps" for "m/s", "per_m2" for "1/m2".
std::string unit_suffix(const std::string& unit) {
  if (unit.starts_with("1/")) return "per_" + unit.substr(2);
  std::string suffix = unit;
  std::replace(suffix.begin(), suffix.end(), '/', 'p');
  std::erase(suffix, ' ');
  return suffix;
}

std::string words_of(const ParameterSpec& spec) {
  std::string limits = spec.unit;
  if (const std::string range = range_text(spec); !range.empty()) {
    limits += (limits.empty() ? "" : ", ") + range;
  }
  return limits.empty() ? spec.description : fmt::format("{} ({})", spec.description, limits);
}

/// Sets one key of the values, and names the flag in errors.
struct Setter {
  std::shared_ptr<ParameterSet> values;
  std::string key, flag;

  void operator()(ParameterSet::Value value) const {
    try {
      values->set(key, std::move(value), flag);
    } catch (const ConfigError& error) {
      throw ConfigError(fmt::format("{}: {}", flag, error.what()));
    }
  }
};

template <class T>
CLI::Option* add_value(CLI::App& command, const std::string& names, const std::string& words,
                       const Setter& set) {
  return command.add_option_function<T>(names, [set](const T& value) { set(value); }, words);
}

CLI::Option* add_flag(CLI::App& command, const std::string& names, const ParameterSpec& spec,
                      const Setter& set) {
  const std::string words = words_of(spec);
  switch (spec.kind) {
    case ParameterKind::kNumber:
      return add_value<double>(command, names, words, set);
    case ParameterKind::kInteger:
      return add_value<std::int64_t>(command, names, words, set);
    case ParameterKind::kBoolean:
      return command.add_flag_function(
          fmt::format("{},!--no-{}", names, set.flag.substr(2)),
          [set](std::int64_t count) { set(count > 0); }, words);
    case ParameterKind::kText:
    case ParameterKind::kPath:
      return add_value<std::string>(command, names, words, set);
    case ParameterKind::kNumberList:
      return add_value<std::vector<double>>(command, names, words, set)->delimiter(',');
    case ParameterKind::kTextList:
      return add_value<std::vector<std::string>>(command, names, words, set)->delimiter(',');
    case ParameterKind::kGroup:
    case ParameterKind::kGroupList:
      break;
  }
  VINEROW_DEMAND(!"a mapping has no flag");
  return nullptr;
}

}  // namespace

std::string flag_name(const ParameterSpec& spec) {
  std::string name = spec.name;
  const std::string suffix = "_" + unit_suffix(spec.unit);
  if (suffix.size() > 1 && name.ends_with(suffix)) name.resize(name.size() - suffix.size());
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

std::shared_ptr<const ParameterSet> add_table_flags(CLI::App& command,
                                                    const std::vector<ParameterSpec>& specs,
                                                    const TableFlags& flags) {
  auto values = std::make_shared<ParameterSet>(specs);
  for (const ParameterSpec& spec : specs) {
    if (has_key(flags.without, spec.name)) continue;
    const std::string own = flag_name(spec);
    const auto named = flags.names.find(spec.name);
    const std::string flag = named == flags.names.end() ? own : named->second;
    const std::string names = flag == own ? own : flag + "," + own;
    CLI::Option* option = add_flag(command, names, spec, Setter{values, spec.name, flag});
    const bool has_default = !std::holds_alternative<std::monostate>(spec.default_value) &&
                             spec.kind != ParameterKind::kBoolean && default_text(spec) != "\"\"" &&
                             default_text(spec) != "[]";
    if (has_default) option->default_str(default_text(spec));
    if (!flags.group.empty() && !has_key(flags.general, spec.name)) option->group(flags.group);
  }
  return values;
}

}  // namespace vinerow::tools

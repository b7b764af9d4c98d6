#include "engine/scenario/scenario_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>

#include "engine/core/error.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/yaml_include.h"

namespace vinerow::scenario {
namespace {

using Value = ParameterSet::Value;

bool is_text(const io::YamlNode& node) {
  return node.is_scalar() && std::holds_alternative<std::string>(io::scalar_value(node));
}

/// Hint for the user, appended to "must be ...".
std::string type_hint(const io::YamlNode& node, const ParameterSpec& spec) {
  const bool wants_number =
      spec.kind == ParameterKind::kNumber || spec.kind == ParameterKind::kInteger;
  if (node.is_null()) return "; give a value or remove the key";
  if (wants_number && is_text(node)) {
    if (node.quoted) return "; write it without quotes";
    const bool starts_like_number = node.text.find_first_of("0123456789") < 2;
    if (starts_like_number && !spec.unit.empty()) {
      return fmt::format("; write the number alone, its unit is {}", spec.unit);
    }
  }
  if ((spec.kind == ParameterKind::kText || spec.kind == ParameterKind::kPath) &&
      node.is_scalar() && !is_text(node)) {
    return "; put it in quotes to make it a text";
  }
  return "";
}

[[noreturn]] void fail_type(const io::YamlNode& node, const ParameterSpec& spec,
                            const std::string& path) {
  io::fail_at(node.mark, fmt::format("{} = {}, must be {}{}", path, io::shown(node),
                                     allowed_text(spec), type_hint(node, spec)));
}

bool is_not_finite_word(const io::YamlNode& node) {
  if (!node.is_scalar() || node.quoted) return false;
  std::string word;
  for (const char c : node.text) {
    if (c != '+' && c != '-' && c != '.') word += static_cast<char>(c | 0x20);
  }
  return word == "nan" || word == "inf" || word == "infinity";
}

double read_number(const io::YamlNode& node, const ParameterSpec& spec, const std::string& path) {
  if (is_not_finite_word(node)) {
    io::fail_at(node.mark,
                fmt::format("{} = {}, must be finite ({})", path, node.text, allowed_text(spec)));
  }
  if (node.is_scalar()) {
    const io::YamlScalar value = io::scalar_value(node);
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    if (const auto* real = std::get_if<double>(&value)) return *real;
  }
  fail_type(node, spec, path);
}

std::int64_t read_integer(const io::YamlNode& node, const ParameterSpec& spec,
                          const std::string& path) {
  if (node.is_scalar()) {
    const io::YamlScalar value = io::scalar_value(node);
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return *whole;
    // 3.0 is a whole number too, as in JSON Schema. Above 9e15 (2^53) doubles cannot represent all
    // whole numbers.
    const auto* real = std::get_if<double>(&value);
    if (real && std::abs(*real) < 9e15 && *real == std::floor(*real)) {
      return static_cast<std::int64_t>(*real);
    }
  }
  fail_type(node, spec, path);
}

const std::string& read_text(const io::YamlNode& node, const ParameterSpec& spec,
                             const std::string& path) {
  if (!is_text(node)) fail_type(node, spec, path);
  return node.text;
}

Value read_list(const io::YamlNode& node, const ParameterSpec& spec, const std::string& path) {
  if (!node.is_list()) fail_type(node, spec, path);
  std::vector<double> numbers;
  std::vector<std::string> texts;
  ParameterSpec entry = spec;
  entry.kind =
      spec.kind == ParameterKind::kNumberList ? ParameterKind::kNumber : ParameterKind::kText;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string item_path = fmt::format("{}[{}]", path, i);
    if (entry.kind == ParameterKind::kNumber) {
      numbers.push_back(read_number(node.items[i], entry, item_path));
    } else {
      texts.push_back(read_text(node.items[i], entry, item_path));
    }
  }
  if (entry.kind == ParameterKind::kNumber) return numbers;
  return texts;
}

/// Reads the mapping of a group and checks it for unknown keys.
ReadParameters read_group(const io::YamlNode& node, const std::string& path,
                          const ParameterSpec& spec) {
  const std::vector<std::string> names = names_of(spec.fields);
  require_mapping(node, path, names.empty() ? "{}" : "{" + names.front() + ": ...}");
  check_keys(node, path, names, "", nullptr);
  return read_parameters(node, node.mark, path, spec.fields, spec.name);
}

io::YamlNode resolved_value(const ParameterSet& values, const ParameterSpec& spec) {
  io::YamlNode list = io::yaml_list();
  switch (spec.kind) {
    case ParameterKind::kNumber:
      return io::yaml_number(values.number(spec.name));
    case ParameterKind::kInteger:
      return io::yaml_integer(values.integer(spec.name));
    case ParameterKind::kBoolean:
      return io::yaml_boolean(values.boolean(spec.name));
    case ParameterKind::kText:
    case ParameterKind::kPath:
      return io::yaml_text(values.text(spec.name));
    case ParameterKind::kNumberList:
      for (const double number : values.numbers(spec.name)) {
        list.items.push_back(io::yaml_number(number));
      }
      return list;
    case ParameterKind::kTextList:
      for (const std::string& text : values.texts(spec.name)) {
        list.items.push_back(io::yaml_text(text));
      }
      return list;
    case ParameterKind::kGroup:
    case ParameterKind::kGroupList:
      break;  // built while reading
  }
  return list;
}

/// True if a default is written out. Paths are not: the part defines the base folder of a default
/// path.
bool has_printable_default(const ParameterSet& values, const ParameterSpec& spec) {
  return values.has(spec.name) && spec.kind != ParameterKind::kPath &&
         spec.kind != ParameterKind::kGroup && spec.kind != ParameterKind::kGroupList;
}

/// Reads, checks and stores one given value. @returns its form in the resolved scenario
io::YamlNode read_value(const io::YamlNode& node, const std::string& path,
                        const ParameterSpec& spec, const std::string& source,
                        ParameterSet& values) {
  io::YamlNode resolved;
  Value value;
  switch (spec.kind) {
    case ParameterKind::kNumber:
      value = read_number(node, spec, path);
      break;
    case ParameterKind::kInteger:
      value = read_integer(node, spec, path);
      break;
    case ParameterKind::kBoolean: {
      const io::YamlScalar scalar = node.is_scalar() ? io::scalar_value(node) : io::YamlScalar(0.0);
      const bool* truth = std::get_if<bool>(&scalar);
      if (!truth) fail_type(node, spec, path);
      value = *truth;
      break;
    }
    case ParameterKind::kText:
      value = read_text(node, spec, path);
      break;
    case ParameterKind::kPath:
      read_text(node, spec, path);
      value = read_path(node, path, spec.must_exist);
      break;
    case ParameterKind::kNumberList:
    case ParameterKind::kTextList:
      value = read_list(node, spec, path);
      break;
    case ParameterKind::kGroup: {
      ReadParameters group = read_group(node, path, spec);
      resolved = std::move(group.resolved);
      value = std::vector<ParameterSet>{std::move(group.values)};
      break;
    }
    case ParameterKind::kGroupList: {
      if (!node.is_list()) fail_type(node, spec, path);
      resolved = io::yaml_list();
      std::vector<ParameterSet> groups;
      for (std::size_t i = 0; i < node.items.size(); ++i) {
        ReadParameters group = read_group(node.items[i], fmt::format("{}[{}]", path, i), spec);
        resolved.items.push_back(std::move(group.resolved));
        groups.push_back(std::move(group.values));
      }
      value = std::move(groups);
      break;
    }
  }
  try {
    values.set(spec.name, std::move(value), source);
  } catch (const ConfigError& fault) {
    // The message starts with the parameter's name; replace the name by the path.
    std::string text = fault.what();
    if (text.starts_with(spec.name)) text = path + text.substr(spec.name.size());
    io::fail_at(node.mark, text);
  }
  const bool is_group =
      spec.kind == ParameterKind::kGroup || spec.kind == ParameterKind::kGroupList;
  return is_group ? resolved : resolved_value(values, spec);
}

io::YamlNode with_source(io::YamlNode value, const std::string& source) {
  io::YamlNode mapping = io::yaml_mapping();
  mapping.flow = true;
  mapping.put("value", std::move(value));
  mapping.put("source", io::yaml_text(source));
  return mapping;
}

/// Reads a given parameter: plain, or as {value, source}.
io::YamlNode read_given(const io::YamlEntry& entry, const std::string& path,
                        const ParameterSpec& spec, ParameterSet& values) {
  const bool is_group =
      spec.kind == ParameterKind::kGroup || spec.kind == ParameterKind::kGroupList;
  const io::YamlNode& node = entry.value;
  if (is_group || !node.is_mapping()) {
    io::YamlNode located = node;
    if (located.is_null()) located.mark = entry.mark;
    return read_value(located, path, spec, node.mark.text(), values);
  }
  check_keys(node, path, {"value", "source"}, "", nullptr);
  const io::YamlNode* value = node.find("value");
  if (!value) {
    io::fail_at(node.mark,
                fmt::format("{}: value must be given with source ({})", path, allowed_text(spec)));
  }
  const io::YamlNode* source = node.find("source");
  if (source && (!is_text(*source) || source->text.empty())) {
    io::fail_at(source->mark, fmt::format("{}.source = {}, must be a text that is not empty", path,
                                          io::shown(*source)));
  }
  io::YamlNode resolved =
      read_value(*value, path, spec, source ? source->text : value->mark.text(), values);
  return source ? with_source(std::move(resolved), source->text) : resolved;
}

}  // namespace

ReadParameters read_parameters(const io::YamlNode& mapping, const io::SourceMark& where,
                               const std::string& path, const std::vector<ParameterSpec>& specs,
                               const std::string& owner) {
  ReadParameters result{ParameterSet(specs, owner)};
  for (const ParameterSpec& spec : specs) {
    const std::string key_path = join_path(path, spec.name);
    if (const io::YamlEntry* entry = mapping.find_entry(spec.name)) {
      result.resolved.put(spec.name, read_given(*entry, key_path, spec, result.values));
    } else if (spec.required) {
      io::fail_at(where, fmt::format("{} must be given: {} ({})", key_path, allowed_text(spec),
                                     spec.description));
    } else if (has_printable_default(result.values, spec)) {
      result.resolved.put(spec.name, resolved_value(result.values, spec));
    }
  }
  return result;
}

std::string read_path(const io::YamlNode& text, const std::string& path, bool must_exist) {
  if (text.text.empty()) io::fail_at(text.mark, path + " = '', must be the path of a file");
  const std::filesystem::path absolute = (text.folder / text.text).lexically_normal();
  std::error_code error;
  if (must_exist && !std::filesystem::exists(absolute, error)) {
    io::fail_at(text.mark, fmt::format("{} = '{}': no such file (looked for {}){}", path, text.text,
                                       absolute.string(), io::nearest_file_hint(absolute)));
  }
  return absolute.string();
}

Duration check_rate(double rate_Hz, Duration physics_step, const io::SourceMark& mark,
                    const std::string& path) {
  const Duration period = period_of_rate(rate_Hz);
  if (period.ns % physics_step.ns == 0) return period;
  const std::int64_t steps = period.ns / physics_step.ns;
  const auto rate_of = [&](std::int64_t n) {
    // The fewest digits that are read back as a rate that fits.
    const double fitting_Hz = 1e9 / static_cast<double>(n * physics_step.ns);
    for (int digits = 6; digits < 17; ++digits) {
      const std::string text = fmt::format("{:.{}g}", fitting_Hz, digits);
      if (period_of_rate(std::stod(text)).ns == n * physics_step.ns) return text + " Hz";
    }
    return fmt::format("{} Hz", fitting_Hz);
  };
  const std::string fitting =
      steps == 0 ? rate_of(1) + " is the fastest"
                 : fmt::format("{} and {} fit", rate_of(steps + 1), rate_of(steps));
  io::fail_at(
      mark, fmt::format("{} = {} Hz, its period of {:.9g} s is not a whole number of physics steps "
                        "of {} s; {}",
                        path, rate_Hz, period.s(), physics_step.s(), fitting));
}

std::vector<std::string> names_of(const std::vector<ParameterSpec>& specs) {
  std::vector<std::string> names;
  for (const ParameterSpec& spec : specs) names.push_back(spec.name);
  return names;
}

}  // namespace vinerow::scenario

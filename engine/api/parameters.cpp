#include "engine/api/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_limits.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow {
namespace {

const char* kind_words(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kNumber:
      return "a number";
    case ParameterKind::kInteger:
      return "a whole number";
    case ParameterKind::kBoolean:
      return "true or false";
    case ParameterKind::kText:
      return "a text";
    case ParameterKind::kPath:
      return "a path";
    case ParameterKind::kNumberList:
      return "a list of numbers";
    case ParameterKind::kTextList:
      return "a list of texts";
    case ParameterKind::kGroup:
      return "a mapping";
    case ParameterKind::kGroupList:
      return "a list of mappings";
  }
  return "?";
}

const char* value_words(const ParameterSet::Value& value) {
  constexpr const char* kWords[] = {
      "a number",          "a whole number",  "true or false",     "a text",
      "a list of numbers", "a list of texts", "a list of mappings"};
  return kWords[value.index()];
}

std::string with_unit(double value, const std::string& unit) {
  return unit.empty() ? fmt::format("{}", value) : fmt::format("{} {}", value, unit);
}

std::string range_words(const ParameterSpec& spec) {
  const bool has_min = std::isfinite(spec.min), has_max = std::isfinite(spec.max);
  const char* at_least = spec.min_exclusive ? ">" : ">=";
  if (has_min && has_max) {
    return fmt::format("{} {} and <= {}", at_least, with_unit(spec.min, spec.unit),
                       with_unit(spec.max, spec.unit));
  }
  if (has_min) return fmt::format("{} {}", at_least, with_unit(spec.min, spec.unit));
  return fmt::format("<= {}", with_unit(spec.max, spec.unit));
}

void check_number(const ParameterSpec& spec, double value, const std::string& place) {
  if (!std::isfinite(value)) {
    throw ConfigError(fmt::format("{} = {}, must be a finite number", place, value));
  }
  const auto demand_within = [&](const ParameterSpec& range) {
    const bool too_small = range.min_exclusive ? value <= range.min : value < range.min;
    if (!too_small && value <= range.max) return;
    throw ConfigError(
        fmt::format("{} = {}, must be {}", place, with_unit(value, spec.unit), range_words(range)));
  };
  demand_within(spec);
  demand_within(with_limits_of_unit(spec));
}

[[noreturn]] void fail_kind(const ParameterSpec& spec, const ParameterSet::Value& value) {
  throw ConfigError(
      fmt::format("{} must be {}, not {}", spec.name, kind_words(spec.kind), value_words(value)));
}

/// Accepts integers as numbers, and an empty list for every list type.
ParameterSet::Value convert(const ParameterSpec& spec, ParameterSet::Value value) {
  const auto* whole = std::get_if<std::int64_t>(&value);
  const auto* real = std::get_if<double>(&value);
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  switch (spec.kind) {
    case ParameterKind::kNumber:
      if (whole) return static_cast<double>(*whole);
      if (!real) fail_kind(spec, value);
      break;
    case ParameterKind::kInteger:
      if (real && std::isfinite(*real) && *real == std::floor(*real) && std::abs(*real) < 9e15) {
        return static_cast<std::int64_t>(*real);
      }
      if (!whole) fail_kind(spec, value);
      break;
    case ParameterKind::kBoolean:
      if (!std::holds_alternative<bool>(value)) fail_kind(spec, value);
      break;
    case ParameterKind::kText:
    case ParameterKind::kPath:
      if (!std::holds_alternative<std::string>(value)) fail_kind(spec, value);
      break;
    case ParameterKind::kNumberList:
      if (!numbers) fail_kind(spec, value);
      break;
    case ParameterKind::kTextList:
      if (numbers && numbers->empty()) return std::vector<std::string>{};
      if (!std::holds_alternative<std::vector<std::string>>(value)) fail_kind(spec, value);
      break;
    case ParameterKind::kGroup:
    case ParameterKind::kGroupList:
      if (numbers && numbers->empty() && spec.kind == ParameterKind::kGroupList)
        return std::vector<ParameterSet>{};
      if (!std::holds_alternative<std::vector<ParameterSet>>(value)) fail_kind(spec, value);
      break;
  }
  return value;
}

}  // namespace

void check_parameter(const ParameterSpec& spec, const ParameterSet::Value& value) {
  switch (spec.kind) {
    case ParameterKind::kNumber:
      check_number(spec, std::get<double>(value), spec.name);
      break;
    case ParameterKind::kInteger:
      check_number(spec, static_cast<double>(std::get<std::int64_t>(value)), spec.name);
      break;
    case ParameterKind::kText: {
      const auto& text = std::get<std::string>(value);
      if (!spec.choices.empty() &&
          std::find(spec.choices.begin(), spec.choices.end(), text) == spec.choices.end()) {
        throw ConfigError(fmt::format("{} = '{}', must be one of: {}{}", spec.name, text,
                                      join(spec.choices), did_you_mean(text, spec.choices)));
      }
      break;
    }
    case ParameterKind::kNumberList: {
      const auto& numbers = std::get<std::vector<double>>(value);
      if (spec.size > 0 && static_cast<int>(numbers.size()) != spec.size) {
        throw ConfigError(
            fmt::format("{} has {} entries, must have {}", spec.name, numbers.size(), spec.size));
      }
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        check_number(spec, numbers[i], fmt::format("{}[{}]", spec.name, i));
      }
      break;
    }
    case ParameterKind::kTextList:
      for (const std::string& text : std::get<std::vector<std::string>>(value)) {
        if (!spec.choices.empty() &&
            std::find(spec.choices.begin(), spec.choices.end(), text) == spec.choices.end()) {
          throw ConfigError(fmt::format("{} has '{}', each must be one of: {}{}", spec.name, text,
                                        join(spec.choices), did_you_mean(text, spec.choices)));
        }
      }
      break;
    case ParameterKind::kGroup:
    case ParameterKind::kGroupList:
      for (const ParameterSet& group : std::get<std::vector<ParameterSet>>(value))
        group.require_complete();
      break;
    case ParameterKind::kBoolean:
    case ParameterKind::kPath:
      break;
  }
}

ParameterSet::ParameterSet(std::vector<ParameterSpec> specs, std::string owner)
    : specs_(std::move(specs)), owner_(std::move(owner)) {
  for (const ParameterSpec& spec : specs_) {
    std::visit(
        [&](const auto& value) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, std::monostate>) {
            values_.emplace(spec.name, Entry{value, "default"});
          }
        },
        spec.default_value);
  }
}

ParameterSet& ParameterSet::set(std::string_view name, Value value, std::string source) {
  const auto known =
      std::find_if(specs_.begin(), specs_.end(), [&](const auto& s) { return s.name == name; });
  if (known == specs_.end()) {
    std::vector<std::string> names;
    for (const ParameterSpec& s : specs_) names.push_back(s.name);
    throw ConfigError(fmt::format("unknown parameter '{}'{}{} (known: {})", name,
                                  owner_.empty() ? "" : fmt::format(" of {}", owner_),
                                  did_you_mean(name, names), names.empty() ? "none" : join(names)));
  }
  Value converted = convert(*known, std::move(value));
  check_parameter(*known, converted);
  values_.insert_or_assign(known->name, Entry{std::move(converted), std::move(source)});
  return *this;
}

void ParameterSet::require_complete() const {
  for (const ParameterSpec& spec : specs_) {
    if (spec.required && !has(spec.name)) {
      throw ConfigError(fmt::format("{}{} must be given ({})", owner_.empty() ? "" : owner_ + ": ",
                                    spec.name, spec.description));
    }
  }
}

bool ParameterSet::has(std::string_view name) const {
  static_cast<void>(spec(name));
  return values_.find(name) != values_.end();
}

const ParameterSet::Value* ParameterSet::find(std::string_view name) const {
  static_cast<void>(spec(name));
  const auto found = values_.find(name);
  return found == values_.end() ? nullptr : &found->second.value;
}

const ParameterSpec& ParameterSet::spec(std::string_view name) const {
  const auto known =
      std::find_if(specs_.begin(), specs_.end(), [&](const auto& s) { return s.name == name; });
  VINEROW_DEMAND(known != specs_.end() && "a part reads a parameter that its spec does not have");
  return *known;
}

template <class T>
const T& ParameterSet::get(std::string_view name) const {
  static_cast<void>(spec(name));
  const auto found = values_.find(name);
  VINEROW_DEMAND(found != values_.end() &&
                 "a part reads a parameter without value; ask has() first");
  const T* value = std::get_if<T>(&found->second.value);
  VINEROW_DEMAND(value != nullptr && "a part reads a parameter as another type than its spec's");
  return *value;
}

double ParameterSet::number(std::string_view name) const {
  return get<double>(name);
}
std::int64_t ParameterSet::integer(std::string_view name) const {
  return get<std::int64_t>(name);
}
bool ParameterSet::boolean(std::string_view name) const {
  return get<bool>(name);
}
const std::string& ParameterSet::text(std::string_view name) const {
  return get<std::string>(name);
}
const std::vector<double>& ParameterSet::numbers(std::string_view name) const {
  return get<std::vector<double>>(name);
}
const std::vector<std::string>& ParameterSet::texts(std::string_view name) const {
  return get<std::vector<std::string>>(name);
}

const std::vector<ParameterSet>& ParameterSet::groups(std::string_view name) const {
  static const std::vector<ParameterSet> none;
  return has(name) ? get<std::vector<ParameterSet>>(name) : none;
}

const ParameterSet& ParameterSet::group(std::string_view name) const {
  const auto& entries = get<std::vector<ParameterSet>>(name);
  VINEROW_DEMAND(entries.size() == 1);
  return entries.front();
}

std::string ParameterSet::source(std::string_view name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? "" : found->second.source;
}

ParameterSet ParameterSet::make_group(std::string_view name) const {
  const ParameterSpec& group_spec = spec(name);
  return ParameterSet(group_spec.fields, group_spec.name);
}

}  // namespace vinerow

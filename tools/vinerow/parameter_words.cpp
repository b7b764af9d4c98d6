#include "tools/vinerow/parameter_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace vinerow::tools {

namespace {

/// All digits of a written number; six of a computed one, such as 148.96902673401405.
std::string number_words(double value) {
  const std::string exact = fmt::format("{}", value), rounded = fmt::format("{:.6g}", value);
  return exact.size() <= rounded.size() + 2 ? exact : rounded;
}

}  // namespace

std::string default_text(const ParameterSpec& spec) {
  if (spec.required) return "required";
  const auto list = [](const auto& values) { return fmt::format("[{}]", fmt::join(values, ", ")); };
  if (const auto* v = std::get_if<double>(&spec.default_value)) return number_words(*v);
  if (const auto* v = std::get_if<std::int64_t>(&spec.default_value)) return fmt::format("{}", *v);
  if (const auto* v = std::get_if<bool>(&spec.default_value)) return *v ? "true" : "false";
  if (const auto* v = std::get_if<std::string>(&spec.default_value))
    return v->empty() ? "\"\"" : *v;
  if (const auto* v = std::get_if<std::vector<double>>(&spec.default_value)) {
    std::vector<std::string> words;
    for (const double value : *v) words.push_back(number_words(value));
    return list(words);
  }
  if (const auto* v = std::get_if<std::vector<std::string>>(&spec.default_value)) return list(*v);
  return "-";
}

std::string range_text(const ParameterSpec& spec) {
  if (!spec.choices.empty()) return fmt::format("{}", fmt::join(spec.choices, " | "));
  const bool has_min = std::isfinite(spec.min), has_max = std::isfinite(spec.max);
  if (has_min && has_max)
    return fmt::format("{}{:g}, {:g}]", spec.min_exclusive ? "(" : "[", spec.min, spec.max);
  if (has_min) return fmt::format("{} {:g}", spec.min_exclusive ? ">" : ">=", spec.min);
  if (has_max) return fmt::format("<= {:g}", spec.max);
  return "";
}

}  // namespace vinerow::tools

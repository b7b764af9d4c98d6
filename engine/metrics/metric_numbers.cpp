#include "engine/metrics/metric_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vinerow::metrics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Whether a name is of a form such as "nis_<source>_mean".
bool is_of_form(std::string_view form, std::string_view name) {
  const std::size_t open = form.find('<');
  if (open == std::string_view::npos) return form == name;
  if (!name.starts_with(form.substr(0, open))) return false;
  const std::string_view rest = form.substr(form.find('>', open) + 1);
  for (std::size_t end = open + 1; end <= name.size(); ++end) {
    if (is_of_form(rest, name.substr(end))) return true;
  }
  return false;
}

}  // namespace

bool MetricNumber::can_be_in(double min, double max) const {
  const double least = std::max(lowest, whole ? std::ceil(min) : min);
  const double most = std::min(highest, whole ? std::floor(max) : max);
  return least <= most;
}

std::string MetricNumber::range_text() const {
  if (whole && lowest == 0.0 && highest == 1.0) return "0 or 1";
  const std::string kind = whole ? "whole numbers " : "";
  if (std::isfinite(lowest) && std::isfinite(highest)) {
    return fmt::format("{}{:g} to {:g}", kind, lowest, highest);
  }
  return std::isfinite(lowest) ? fmt::format("{}from {:g}", kind, lowest) : "";
}

MetricNumber signed_number(std::string name) {
  return {std::move(name), -kInfinity, kInfinity, false};
}

MetricNumber from_zero(std::string name) {
  return zero_to(kInfinity, std::move(name));
}

MetricNumber zero_to(double highest, std::string name) {
  return {std::move(name), 0.0, highest, false};
}

MetricNumber share_number(std::string name) {
  return zero_to(1.0, std::move(name));
}

MetricNumber count_number(std::string name) {
  return {std::move(name), 0.0, kInfinity, true};
}

MetricNumber flag_number(std::string name) {
  return {std::move(name), 0.0, 1.0, true};
}

std::vector<std::string> written(const std::vector<MetricNumber>& numbers) {
  std::vector<std::string> texts;
  for (const MetricNumber& number : numbers) {
    const std::string range = number.range_text();
    texts.push_back(range.empty() ? number.name : number.name + ": " + range);
  }
  return texts;
}

const MetricNumber* find_number(const std::vector<MetricNumber>& numbers, std::string_view name) {
  const auto found = std::find_if(numbers.begin(), numbers.end(), [&](const MetricNumber& number) {
    return is_of_form(number.name, name);
  });
  return found == numbers.end() ? nullptr : &*found;
}

}  // namespace vinerow::metrics

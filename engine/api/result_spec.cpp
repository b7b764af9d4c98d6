#include "engine/api/result_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vinerow {
namespace {

/// True if a name matches a pattern such as "nis_<source>_mean".
bool fits_form(std::string_view form, std::string_view name) {
  const std::size_t open = form.find('<');
  if (open == std::string_view::npos) return form == name;
  if (!name.starts_with(form.substr(0, open))) return false;
  const std::string_view rest = form.substr(form.find('>', open) + 1);
  for (std::size_t end = open + 1; end <= name.size(); ++end) {
    if (fits_form(rest, name.substr(end))) return true;
  }
  return false;
}

}  // namespace

bool ResultRange::can_be_in(double min, double max) const {
  const double low = std::max(lowest, whole ? std::ceil(min) : min);
  const double high = std::min(highest, whole ? std::floor(max) : max);
  return low <= high;
}

std::string ResultRange::text() const {
  if (whole && lowest == 0.0 && highest == 1.0) return "0 or 1";
  const std::string kind = whole ? "whole numbers " : "";
  if (std::isfinite(lowest) && std::isfinite(highest)) {
    return fmt::format("{}{:g} to {:g}", kind, lowest, highest);
  }
  return std::isfinite(lowest) ? fmt::format("{}from {:g}", kind, lowest) : "";
}

const ResultSpec* find_result(const std::vector<ResultSpec>& results, std::string_view name) {
  const auto found = std::find_if(results.begin(), results.end(), [&](const ResultSpec& result) {
    return fits_form(result.name, name);
  });
  return found == results.end() ? nullptr : &*found;
}

}  // namespace vinerow

#include "tools/vinerow/number_checks.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace vinerow::tools {
namespace {

/// As of times in a scenario: more seconds do not fit into the kernel's clock, and no other option
/// needs more.
constexpr double kLargest = 1e9;

template <class Holds>
CLI::Validator check(std::string words, std::string description, Holds holds) {
  return CLI::Validator(
      [words = std::move(words), holds](const std::string& text) {
        double value = 0.0;
        // NaN fulfils no condition.
        if (!CLI::detail::lexical_cast(text, value) || !holds(value)) {
          return fmt::format("must be {}, is '{}'", words, text);
        }
        if (value > kLargest) return fmt::format("must be <= {:g}, is '{}'", kLargest, text);
        return std::string();
      },
      std::move(description));
}

}  // namespace

CLI::Validator positive() {
  return check("> 0", "POSITIVE", [](double value) { return value > 0.0; });
}

CLI::Validator not_negative() {
  return check(">= 0", "NONNEGATIVE", [](double value) { return value >= 0.0; });
}

CLI::Validator within(double lowest, double highest) {
  return check(fmt::format("from {:g} to {:g}", lowest, highest),
               fmt::format("FLOAT in [{:g} - {:g}]", lowest, highest),
               [=](double value) { return value >= lowest && value <= highest; });
}

}  // namespace vinerow::tools

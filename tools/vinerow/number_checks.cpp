#include "tools/vinerow/number_checks.h"

#include <fmt/format.h>

namespace vinerow::tools {
namespace {

template <class Holds>
CLI::Validator check(const char* words, const char* name, Holds holds) {
  return CLI::Validator(
      [words, holds](const std::string& text) {
        double value = 0.0;
        // NaN fulfils no condition.
        const bool is_good = CLI::detail::lexical_cast(text, value) && holds(value);
        return is_good ? std::string() : fmt::format("must be {}, is '{}'", words, text);
      },
      name);
}

}  // namespace

CLI::Validator positive() {
  return check("> 0", "POSITIVE", [](double value) { return value > 0.0; });
}

CLI::Validator not_negative() {
  return check(">= 0", "NONNEGATIVE", [](double value) { return value >= 0.0; });
}

}  // namespace vinerow::tools

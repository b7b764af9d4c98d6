#include "tools/study/numbers.h"

#include <charconv>

namespace vinerow::study {

std::optional<double> number_in(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Numbers::Numbers(const Results& results) : results_(results) {
  const Design& design = results.design();
  for (std::size_t k = 0; k < design.columns().size(); ++k) factors_[design.columns()[k]] = k;
  for (const scenario::DerivedColumn& column : design.study().derived) {
    expressions_.emplace(column.name, column);
  }
}

double Numbers::factor(std::size_t cell, std::size_t column) const {
  const std::string text = results_.design().texts(results_.design().setting_of(cell))[column];
  return number_in(text).value_or(kNoNumber);
}

double Numbers::value(std::size_t cell, const std::string& name) {
  if (const auto found = factors_.find(name); found != factors_.end()) {
    return factor(cell, found->second);
  }
  if (!has_numbers(results_.state(cell))) return kNoNumber;
  // A column may use only columns before it in the file; open_study.cpp checks this.
  if (const auto found = expressions_.find(name); found != expressions_.end()) {
    return found->second.value([&](const std::string& used) { return value(cell, used); });
  }
  return results_.value(cell, name);
}

}  // namespace vinerow::study

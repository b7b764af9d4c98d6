#pragma once
/// Derived columns, computed from others: `cost: rover.time_s * 40 / 3600`.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/scenario/study.h"

namespace vinerow::study {

/// Names that an expression uses. @throws ConfigError "study.yaml:9: derived.cost = ..." if it is
/// not an expression
std::vector<std::string> variables_of(const scenario::DerivedColumn& column);

/// Compiled expression with the operators and functions of muParser.
class Expression {
 public:
  /// @throws ConfigError as variables_of()
  explicit Expression(const scenario::DerivedColumn& column);
  ~Expression();
  Expression(Expression&&) noexcept;

  /// @param value_of  value of a name; NaN if missing, which makes the result NaN
  double value(const std::function<double(const std::string&)>& value_of);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace vinerow::study

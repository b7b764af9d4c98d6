#include "tools/study/derived.h"

#include <fmt/format.h>
#include <muParser.h>

#include <limits>

namespace vinerow::study {
namespace {

/// Parser that accepts names with points, as metrics have.
mu::Parser make_parser(const scenario::DerivedColumn& column) {
  mu::Parser parser;
  parser.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
  parser.SetExpr(column.expression);
  return parser;
}

[[noreturn]] void fail(const scenario::DerivedColumn& column, const mu::ParserError& error) {
  io::fail_at(column.where, fmt::format("derived.{} = '{}' is not an expression: {}", column.name,
                                        column.expression, error.GetMsg()));
}

}  // namespace

std::vector<std::string> variables_of(const scenario::DerivedColumn& column) {
  try {
    mu::Parser parser = make_parser(column);
    std::vector<std::string> names;
    for (const auto& [name, place] : parser.GetUsedVar()) names.push_back(name);
    return names;
  } catch (const mu::ParserError& error) {
    fail(column, error);
  }
}

struct Expression::Parser {
  scenario::DerivedColumn column;
  mu::Parser parser;
  std::vector<std::string> names;
  std::vector<double> values;
};

Expression::Expression(const scenario::DerivedColumn& column)
    : parser_(
          std::make_unique<Parser>(Parser{column, make_parser(column), variables_of(column), {}})) {
  parser_->values.resize(parser_->names.size());
  try {
    for (std::size_t k = 0; k < parser_->names.size(); ++k) {
      parser_->parser.DefineVar(parser_->names[k], &parser_->values[k]);
    }
    static_cast<void>(parser_->parser.Eval());
  } catch (const mu::ParserError& error) {
    fail(column, error);
  }
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;

double Expression::value(const std::function<double(const std::string&)>& value_of) {
  for (std::size_t k = 0; k < parser_->names.size(); ++k) {
    parser_->values[k] = value_of(parser_->names[k]);
  }
  try {
    return parser_->parser.Eval();
  } catch (const mu::ParserError&) {
    return std::numeric_limits<double>::quiet_NaN();  // e.g. a division by zero
  }
}

}  // namespace vinerow::study

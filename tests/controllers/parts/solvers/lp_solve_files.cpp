/// lp_solve_files FILE: solves the linear programmes of a text file, for judges in other languages.
/// The file holds one programme after the other, numbers and "inf" separated by blanks:
///   n m, F (m x n, row by row), g (m), c (n)
/// Output is one line for each: status (one word), iterations, value, x (n), multipliers (m).
/// Exit code 2 where the file is not like that.

#include <cstdio>

#include "controllers/parts/solvers/linear_programme.h"
#include "tests/controllers/parts/solvers/number_reader.h"

namespace {

const char* word(vinerow::controllers::LpStatus status) {
  switch (status) {
    case vinerow::controllers::LpStatus::kSolved:
      return "solved";
    case vinerow::controllers::LpStatus::kInfeasible:
      return "infeasible";
    case vinerow::controllers::LpStatus::kUnbounded:
      return "unbounded";
    default:
      return "failed";
  }
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: lp_solve_files FILE\n", stderr);
    return 2;
  }
  vinerow::test::NumberReader numbers(arguments[1]);
  double n = 0.0;
  while (numbers.next(n)) {
    const int variables = static_cast<int>(n), rows = numbers.expect_int();
    Eigen::MatrixXd F(rows, variables);
    Eigen::VectorXd g(rows), c(variables);
    numbers.fill(F);
    numbers.fill(g);
    numbers.fill(c);
    vinerow::controllers::LinearProgramme programme(variables, rows);
    programme.set_rows(F, g);
    const vinerow::controllers::LpStatus status = programme.maximise(c);
    std::printf("%s %d %.17g", word(status), programme.iterations(), programme.value());
    for (const double x : programme.x()) std::printf(" %.17g", x);
    for (int i = 0; i < rows; ++i) std::printf(" %.17g", programme.multipliers()[i]);
    std::putchar('\n');
  }
  return 0;
}

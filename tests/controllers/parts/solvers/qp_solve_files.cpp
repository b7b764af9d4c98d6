/// qp_solve_files FILE: solves the quadratic programmes of a text file, for judges in other
/// languages. The file holds one programme after the other, numbers and "inf" separated by blanks:
///   n m, H (n x n, row by row), f, lower, upper (n), A (m x n, row by row), row_lower,
///   row_upper (m)
/// Output is one line for each: status (one word), iterations, cost, x (n), multipliers (n + m).
/// Exit code 2 where the file is not like that.

#include <cstdio>

#include "tests/controllers/parts/solvers/number_reader.h"
#include "tests/controllers/parts/solvers/qp_support.h"

namespace {

const char* word(vinerow::controllers::QpStatus status) {
  switch (status) {
    case vinerow::controllers::QpStatus::kSolved:
      return "solved";
    case vinerow::controllers::QpStatus::kInfeasible:
      return "infeasible";
    default:
      return "failed";
  }
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: qp_solve_files FILE\n", stderr);
    return 2;
  }
  vinerow::test::NumberReader numbers(arguments[1]);
  double n = 0.0;
  while (numbers.next(n)) {
    vinerow::test::QpProblem problem(static_cast<int>(n), numbers.expect_int());
    numbers.fill(problem.H);
    numbers.fill(problem.f);
    numbers.fill(problem.lower);
    numbers.fill(problem.upper);
    numbers.fill(problem.A);
    numbers.fill(problem.row_lower);
    numbers.fill(problem.row_upper);
    vinerow::controllers::QpSolver solver(problem.n(), problem.m());
    problem.prepare(solver);
    const vinerow::controllers::QpStatus status = problem.solve(solver);
    std::printf("%s %d %.17g", word(status), solver.iterations(), solver.cost());
    for (const double x : solver.x()) std::printf(" %.17g", x);
    for (const double multiplier : solver.multipliers()) std::printf(" %.17g", multiplier);
    std::putchar('\n');
  }
  return 0;
}

/// qp_solve_files [--time] FILE: solves the quadratic programmes of a text file, for judges in
/// other languages. The file holds one programme after the other, numbers and "inf" separated by
/// blanks:
///   n m, H (n x n, row by row), f, lower, upper (n), A (m x n, row by row), row_lower,
///   row_upper (m)
/// Output is one line for each: status (one word), iterations, cost, x (n), multipliers (n + m).
/// With --time: least times of a factorisation and of a cold solution after it, us.
/// Exit code 2 where the file is not like that.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <string_view>

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

void print_times(const vinerow::test::QpProblem& problem) {
  using Clock = std::chrono::steady_clock;
  using Microseconds = std::chrono::duration<double, std::micro>;
  constexpr int kTurns = 200;
  double prepare_us = std::numeric_limits<double>::infinity(), solve_us = prepare_us;
  for (int turn = 0; turn < kTurns; ++turn) {
    vinerow::controllers::QpSolver solver(problem.n(), problem.m());
    const auto begin = Clock::now();
    problem.prepare(solver);
    const auto prepared = Clock::now();
    problem.solve(solver);
    const auto end = Clock::now();
    prepare_us = std::min(prepare_us, Microseconds(prepared - begin).count());
    solve_us = std::min(solve_us, Microseconds(end - prepared).count());
  }
  std::printf("%.3f %.3f\n", prepare_us, solve_us);
}

}  // namespace

int main(int argument_count, char** arguments) {
  const bool has_times = argument_count == 3 && std::string_view(arguments[1]) == "--time";
  if (argument_count != 2 && !has_times) {
    std::fputs("usage: qp_solve_files [--time] FILE\n", stderr);
    return 2;
  }
  vinerow::test::NumberReader numbers(arguments[argument_count - 1]);
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
    if (has_times) {
      print_times(problem);
      continue;
    }
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

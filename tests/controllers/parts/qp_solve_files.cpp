/// qp_solve_files FILE: solves the quadratic programmes of a text file, for judges in other
/// languages. The file holds one programme after the other, numbers and "inf" separated by blanks:
///   n m, H (n x n, row by row), f, lower, upper (n), A (m x n, row by row), row_lower,
///   row_upper (m)
/// Output is one line for each: status (one word), iterations, cost, x (n), multipliers (n + m).
/// Exit code 2 where the file is not like that.

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/controllers/parts/qp_support.h"

namespace {

class Numbers {
 public:
  explicit Numbers(const std::string& text) : at_(text.c_str()) {}

  bool next(double& number) {
    char* end = nullptr;
    number = std::strtod(at_, &end);
    const bool found = end != at_;
    at_ = end;
    return found;
  }

  double expect() {
    double number = 0.0;
    if (!next(number)) {
      std::fputs("the file ends within a programme or holds a word that is no number\n", stderr);
      std::exit(2);
    }
    return number;
  }

  template <typename Matrix>
  void fill(Matrix& matrix) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) matrix(i, j) = expect();
    }
  }

 private:
  const char* at_;
};

const char* word(vinerow::QpStatus status) {
  switch (status) {
    case vinerow::QpStatus::kSolved:
      return "solved";
    case vinerow::QpStatus::kInfeasible:
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
  std::ifstream stream(arguments[1]);
  if (!stream) {
    std::fprintf(stderr, "cannot read %s\n", arguments[1]);
    return 2;
  }
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  Numbers numbers(text);
  double n = 0.0;
  while (numbers.next(n)) {
    vinerow::test::QpProblem problem(static_cast<int>(n), static_cast<int>(numbers.expect()));
    numbers.fill(problem.H);
    numbers.fill(problem.f);
    numbers.fill(problem.lower);
    numbers.fill(problem.upper);
    numbers.fill(problem.A);
    numbers.fill(problem.row_lower);
    numbers.fill(problem.row_upper);
    vinerow::QpSolver solver(problem.n(), problem.m());
    problem.prepare(solver);
    const vinerow::QpStatus status = problem.solve(solver);
    std::printf("%s %d %.17g", word(status), solver.iterations(), solver.cost());
    for (const double x : solver.x()) std::printf(" %.17g", x);
    for (const double multiplier : solver.multipliers()) std::printf(" %.17g", multiplier);
    std::putchar('\n');
  }
  return 0;
}

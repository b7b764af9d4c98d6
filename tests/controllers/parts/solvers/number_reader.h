#pragma once
/// Numbers and words of a text file that a judge in another language has written.

#include <Eigen/Core>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace vinerow::test {

/// Ends the program with exit status 2 where the file is not as expected.
class NumberReader {
 public:
  explicit NumberReader(const char* file) {
    std::ifstream stream(file);
    if (!stream) {
      std::fprintf(stderr, "cannot read %s\n", file);
      std::exit(2);
    }
    text_.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    at_ = text_.c_str();
  }
  NumberReader(const NumberReader&) = delete;
  NumberReader& operator=(const NumberReader&) = delete;

  /// "inf" and "nan" are numbers. @returns false at the end of the file
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
      std::fputs("the file ends too early or holds a word that is no number\n", stderr);
      std::exit(2);
    }
    return number;
  }
  int expect_int() { return static_cast<int>(expect()); }

  /// Row by row.
  template <typename Matrix>
  void fill(Matrix& matrix) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) matrix(i, j) = expect();
    }
  }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd result(rows, columns);
    fill(result);
    return result;
  }

  /// The next word, empty at the end of the file.
  std::string word() {
    while (*at_ == ' ' || *at_ == '\n') ++at_;
    std::string result;
    while (*at_ != '\0' && *at_ != ' ' && *at_ != '\n') result += *at_++;
    return result;
  }

 private:
  std::string text_;
  const char* at_ = nullptr;
};

}  // namespace vinerow::test

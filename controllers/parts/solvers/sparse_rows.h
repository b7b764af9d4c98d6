#pragma once
/// Small matrix stored by its nonzero entries. The matrices of sampled mechanical systems and of
/// their limits are mostly zeros, and at these sizes a product with them costs less than the call
/// of a dense one.

#include <Eigen/Core>
#include <vector>

namespace vinerow::controllers::mpc {

class SparseRows {
 public:
  SparseRows() { start_.push_back(0); }
  explicit SparseRows(const Eigen::MatrixXd& dense) : SparseRows() { append(dense); }

  void append(const Eigen::MatrixXd& dense) {
    for (Eigen::Index i = 0; i < dense.rows(); ++i) {
      for (Eigen::Index j = 0; j < dense.cols(); ++j) {
        if (dense(i, j) != 0.0) entries_.push_back({dense(i, j), static_cast<int>(j)});
      }
      start_.push_back(static_cast<int>(entries_.size()));
    }
  }

  int rows() const { return static_cast<int>(start_.size()) - 1; }

  /// y = M x
  void product(const double* x, double* y) const {
    for_each_row(x, [y](int i, double sum) { y[i] = sum; });
  }
  /// y = M x + y
  void add_product(const double* x, double* y) const {
    for_each_row(x, [y](int i, double sum) { y[i] += sum; });
  }

 private:
  struct Entry {
    double value;
    int column;
  };

  template <typename Take>
  void for_each_row(const double* x, Take take) const {
    const Entry* entry = entries_.data();
    const int* end = start_.data() + 1;
    const int count = rows();
    for (int i = 0; i < count; ++i) {
      double sum = 0.0;
      for (const Entry* last = entries_.data() + end[i]; entry != last; ++entry) {
        sum += entry->value * x[entry->column];
      }
      take(i, sum);
    }
  }

  std::vector<int> start_;
  std::vector<Entry> entries_;
};

}  // namespace vinerow::controllers::mpc

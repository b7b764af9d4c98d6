#pragma once
/// A small matrix kept by its entries that are not zero. The matrices of sampled mechanical systems
/// and of their limits are mostly zeros, and at these sizes a product with them costs less than the
/// call of a dense one.

#include <Eigen/Core>
#include <vector>

namespace vinerow::mpc {

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

  /// Row i times x
  double dot(int i, const double* x) const {
    const int* start = start_.data() + i;
    const Entry *entry = entries_.data() + start[0], *end = entries_.data() + start[1];
    double sum = 0.0;
    for (; entry != end; ++entry) sum += entry->value * x[entry->column];
    return sum;
  }

  /// y = M x + y
  void add_product(const double* x, double* y) const {
    const Entry* entry = entries_.data();
    for (int i = 0; i < rows(); ++i) {
      const Entry* end = entries_.data() + start_[static_cast<std::size_t>(i) + 1];
      double sum = y[i];
      for (; entry != end; ++entry) sum += entry->value * x[entry->column];
      y[i] = sum;
    }
  }

 private:
  struct Entry {
    double value;
    int column;
  };
  std::vector<int> start_;
  std::vector<Entry> entries_;
};

}  // namespace vinerow::mpc

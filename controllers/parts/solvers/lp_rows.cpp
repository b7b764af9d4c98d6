#include "controllers/parts/solvers/lp_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"

namespace vinerow::controllers::lp {

Rows::Rows(int variables, int max_rows)
    : F_(Eigen::MatrixXd::Zero(max_rows, variables)),
      g_(Eigen::VectorXd::Zero(max_rows)),
      length_(Eigen::VectorXd::Zero(max_rows)),
      scale_(Eigen::VectorXd::Ones(variables)),
      largest_(Eigen::VectorXd::Zero(max_rows)) {}

void Rows::set(const Eigen::Ref<const Eigen::MatrixXd>& F,
               const Eigen::Ref<const Eigen::VectorXd>& g) {
  VINEROW_DEMAND(F.cols() == F_.cols() && F.rows() == g.size() && F.rows() <= F_.rows());
  count_ = static_cast<int>(F.rows());
  F_.topRows(count_) = F;
  scale_.setOnes();
  length_.setOnes();
  matrix_finite_ = F_.topRows(count_).allFinite();
  if (matrix_finite_) {
    choose_scale();
    for (Eigen::Index j = 0; j < F_.cols(); ++j) F_.col(j).head(count_) *= scale_[j];
    for (int i = 0; i < count_; ++i) {
      length_[i] = F_.row(i).stableNorm();
      if (length_[i] > 0.0) F_.row(i) /= length_[i];
    }
  }
  for (int i = 0; i < count_; ++i) set_limit(i, g[i]);
}

void Rows::set_limit(int row, double g) {
  VINEROW_DEMAND(row >= 0 && row < count_);
  g_[row] = length_[row] > 0.0 ? g / length_[row] : g;
}

void Rows::choose_scale() {
  constexpr int kSweeps = 3;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int i = 0; i < count_; ++i) {
      largest_[i] = 0.0;
      for (Eigen::Index j = 0; j < F_.cols(); ++j) {
        largest_[i] = std::max(largest_[i], std::abs(F_(i, j)) * scale_[j]);
      }
    }
    for (Eigen::Index j = 0; j < F_.cols(); ++j) {
      double max_entry = 0.0, min_entry = std::numeric_limits<double>::infinity();
      for (int i = 0; i < count_; ++i) {
        const double entry = std::abs(F_(i, j)) / largest_[i];
        // Entries below a millionth of their row's largest count as rounding and are ignored.
        if (!(entry * scale_[j] > 1e-6)) continue;
        max_entry = std::max(max_entry, entry);
        min_entry = std::min(min_entry, entry);
      }
      if (max_entry > 0.0)
        scale_[j] = std::exp2(std::round(-0.5 * (std::log2(max_entry) + std::log2(min_entry))));
    }
  }
}

void Rows::multiply(const Eigen::VectorXd& z, Eigen::VectorXd& product) const {
  product.head(count_) = z[0] * F_.col(0).head(count_);
  for (Eigen::Index j = 1; j < z.size(); ++j) {
    product.head(count_) += z[j] * F_.col(j).head(count_);
  }
}

bool Rows::valid() const {
  if (!matrix_finite_) return false;
  for (int i = 0; i < count_; ++i) {
    if (!(g_[i] > -std::numeric_limits<double>::infinity())) return false;
  }
  return true;
}

int Rows::contradiction() const {
  for (int i = 0; i < count_; ++i) {
    if (length_[i] == 0.0 && g_[i] < 0.0) return i;
  }
  return -1;
}

}  // namespace vinerow::controllers::lp

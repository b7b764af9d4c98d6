#include "controllers/parts/solvers/qp_form.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"

namespace vinerow::controllers::qp {
namespace {

using Eigen::Index;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ConstRows = Eigen::Map<const RowMajor, 0, Eigen::OuterStride<>>;

// Rows of one matrix-vector product: enough to fill Eigen's kernel (8 rows at once).
constexpr int kBlockRows = 8;
// Largest difference in length between rows of a block: the added zeros cost less than another
// product.
constexpr int kPaddedColumns = 4;
// Shorter rows count as zero: their inverse length would overflow.
constexpr double kShortestRow = 1e-100;

/// Even, so that every row starts on 16 bytes, and no multiple of 512 bytes, which would map all
/// rows of a block to the same few cache lines.
Index padded(int n) {
  const Index even = (n + 1) / 2 * 2;
  return even % 64 == 0 ? even + 8 : even;
}

/// out[0, length) = T' in for a lower triangular T of `length` rows.
void transposed_product(const double* T, Index stride, const double* in, int length, double* out) {
  Vector(out, length).setZero();
  for (int first = 0; first < length; first += kBlockRows) {
    const int count = std::min(kBlockRows, length - first), columns = first + count;
    const ConstVector part(in + first, count);
    if ((part.array() == 0.0).all()) continue;
    const ConstRows block(T + first * stride, count, columns, Eigen::OuterStride<>(stride));
    Vector(out, columns).noalias() += block.transpose() * part;
  }
}

}  // namespace

Form::Form(int variables, int rows, double tolerance)
    : n_(variables), m_(rows), stride_(padded(variables)), tolerance_(tolerance) {
  VINEROW_DEMAND(variables >= 1 && rows >= 0);
  const Index count = n_ + m_;
  G_.setZero(count * stride_);
  A_.setZero(m_ * stride_);
  factor_.setZero(n_ * stride_);
  inverse_.setZero(n_ * stride_);
  end_.assign(static_cast<std::size_t>(count), 0);
  blocks_.reserve(static_cast<std::size_t>(count));
  squared_.setZero(count);
  inverse_length_.setOnes(count);
  scaled_tolerance_.setConstant(count, tolerance);
}

bool Form::set_hessian(const Eigen::Ref<const Eigen::MatrixXd>& H) {
  VINEROW_DEMAND(H.rows() == n_ && H.cols() == n_);
  hessian_changed_ = true;
  // Reversed order makes K lower triangular: P H P = L L' gives H^-1 = (P L^-T P) (P L^-T P)'.
  const double smallest = 4.0 * n_ * std::numeric_limits<double>::epsilon();
  for (int i = 0; i < n_; ++i) {
    double* L_i = factor_.data() + i * stride_;
    for (int j = 0; j <= i; ++j) {
      const double* L_j = factor_.data() + j * stride_;
      const double entry = H(n_ - 1 - j, n_ - 1 - i);
      const double rest = entry - ConstVector(L_i, j).dot(ConstVector(L_j, j));
      if (j < i) {
        L_i[j] = rest / L_j[j];
      } else {
        if (!(rest > smallest * entry) || !std::isfinite(rest)) return false;
        L_i[i] = std::sqrt(rest);
      }
    }
    double* inverse_i = inverse_.data() + i * stride_;
    transposed_product(inverse_.data(), stride_, L_i, i, inverse_i);
    Vector(inverse_i, i) *= -1.0 / L_i[i];
    inverse_i[i] = 1.0 / L_i[i];
  }
  for (int i = 0; i < n_; ++i) {
    double* K_i = G_.data() + i * stride_;
    const double* column = inverse_.data() + (n_ - 1 - i);
    for (int j = 0; j <= i; ++j) K_i[j] = column[(n_ - 1 - j) * stride_];
    end_[static_cast<std::size_t>(i)] = i + 1;
    describe_row(i, 1.0);
  }
  return true;
}

bool Form::set_rows(const Eigen::Ref<const Eigen::MatrixXd>& A) {
  VINEROW_DEMAND(A.rows() == m_ && A.cols() == n_);
  rows_changed_ = true;
  if (m_ == 0) return true;
  Eigen::Map<RowMajor, 0, Eigen::OuterStride<>>(A_.data(), m_, n_, Eigen::OuterStride<>(stride_)) =
      A;
  for (int r = 0; r < m_; ++r) {
    const double* A_r = A_.data() + r * stride_;
    int end = n_;
    while (end > 0 && A_r[end - 1] == 0.0) --end;
    end_[static_cast<std::size_t>(n_ + r)] = end;
  }
  return A_.allFinite();
}

bool Form::refresh() {
  if (!hessian_changed_ && !rows_changed_) return false;
  hessian_changed_ = rows_changed_ = false;
  blocks_.clear();
  for (int first = 0; first < n_; first += kBlockRows) {
    const int count = std::min(kBlockRows, n_ - first);
    add_block(first, count, first + count);
  }
  for (int r = 0; r < m_; ++r) {
    const int i = n_ + r, length = end(i);
    const double* A_r = A_.data() + r * stride_;
    double* G_i = G_.data() + i * stride_;
    transposed_product(G_.data(), stride_, A_r, length, G_i);
    Vector(G_i + length, stride_ - length).setZero();
    describe_row(i, ConstVector(A_r, n_).norm());
    if (r > 0) {
      Block& last = blocks_.back();
      const bool near = std::abs(length - last.columns) <= kPaddedColumns;
      if (near || last.count < kBlockRows / 2) {
        ++last.count;
        last.columns = std::max(last.columns, length);
        continue;
      }
    }
    add_block(i, 1, length);
  }
  return true;
}

void Form::describe_row(int i, double length) {
  squared_[i] = ConstVector(row(i), end(i)).squaredNorm();
  const double scaled_length = std::sqrt(squared_[i]);
  const bool zero = scaled_length < kShortestRow;
  inverse_length_[i] = zero ? 1.0 : 1.0 / scaled_length;
  scaled_tolerance_[i] = tolerance_ * (zero ? 1.0 : length / scaled_length);
}

void Form::add_block(int first, int count, int columns) {
  blocks_.push_back({first, count, columns});
}

void Form::to_gradient(const Eigen::Ref<const Eigen::VectorXd>& f, Eigen::VectorXd& v) const {
  transposed_product(G_.data(), stride_, f.data(), n_, v.data());
}

double Form::value_at(int i, const Eigen::VectorXd& y) const {
  return ConstVector(row(i), end(i)).dot(ConstVector(y.data(), end(i)));
}

void Form::values_at(const Eigen::VectorXd& y, Eigen::VectorXd& values) const {
  for (const Block& block : blocks_) {
    const ConstRows rows(row(block.first), block.count, block.columns,
                         Eigen::OuterStride<>(stride_));
    values.segment(block.first, block.count).noalias() = rows * y.head(block.columns);
  }
}

}  // namespace vinerow::controllers::qp

#include "controllers/parts/solvers/tube_form.h"

#include "controllers/parts/solvers/riccati.h"

namespace vinerow::controllers {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// List of rows and their meanings.
class RowList {
 public:
  RowList(TubeForm& form, Index max_rows) : form_(&form) {
    form.rows.setZero(max_rows, form.H.cols());
    form.about.reserve(static_cast<std::size_t>(max_rows));
  }
  /// @param map  from y to the quantity of the row
  void add(const MatrixXd& map, const TubeRow& about) {
    form_->rows.row(static_cast<Index>(form_->about.size())) = map.row(0);
    form_->about.push_back(about);
  }

 private:
  TubeForm* form_;
};

}  // namespace

Result<MatrixXd> make_tube_weight(const TubeModel& model, const TubeCost& cost) {
  return solve_discrete_lyapunov(model.A + model.B * model.K,
                                 cost.Q + model.K.transpose() * cost.R * model.K);
}

TubeForm make_tube_form(const TubeModel& model, const TubeSets& sets, const TubeCost& cost,
                        const MatrixXd& P, bool with_tube) {
  const Index n = model.A.rows(), m = model.B.cols(), N = cost.horizon, size = n + N * m;
  const MatrixXd weight = cost.R + model.B.transpose() * P * model.B;
  const MatrixXd cross = cost.R * model.K + model.B.transpose() * P * sets.A_K;
  constexpr double kNoCoupling = 1e-9;

  TubeForm form;
  const MatrixXd scale = weight.diagonal() * P.diagonal().transpose();
  form.is_decoupled = (cross.array().square() <= kNoCoupling * kNoCoupling * scale.array()).all();
  form.H.setZero(size, size);
  form.H.topLeftCorner(n, n) = 2.0 * P;
  const Index tube = with_tube ? sets.tube_rows.rows() : 0;
  RowList rows(form, tube + N * (n + m) + sets.terminal_rows.rows());
  MatrixXd z = MatrixXd::Zero(n, size);  // z_i = z y
  z.leftCols(n).setIdentity();
  for (Index k = 0; k < tube; ++k) {
    rows.add(sets.tube_rows.row(k) * z, {TubeRow::Kind::kTube, 0, static_cast<int>(k)});
  }
  for (Index i = 0; i < N; ++i) {
    const int step = static_cast<int>(i);
    const Index at = n + i * m;
    form.H.middleRows(at, m) += 2.0 * cross * z;
    form.H.middleCols(at, m) += 2.0 * (cross * z).transpose();
    form.H.block(at, at, m, m) += 2.0 * weight;
    for (Index j = 0; j < n; ++j) {
      rows.add(z.row(j) / sets.state_limit[j], {TubeRow::Kind::kState, step, static_cast<int>(j)});
    }
    MatrixXd v = model.K * z;
    v.middleCols(at, m) += MatrixXd::Identity(m, m);
    for (Index j = 0; j < m; ++j) {
      rows.add(v.row(j) / sets.input_limit[j], {TubeRow::Kind::kInput, step, static_cast<int>(j)});
    }
    z = (sets.A_K * z).eval();
    z.middleCols(at, m) += model.B;
  }
  for (Index k = 0; k < sets.terminal_rows.rows(); ++k) {
    rows.add(sets.terminal_rows.row(k) * z,
             {TubeRow::Kind::kTerminal, static_cast<int>(N), static_cast<int>(k)});
  }
  return form;
}

}  // namespace vinerow::controllers

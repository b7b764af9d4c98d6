#include "controllers/parts/solvers/tube_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "controllers/parts/solvers/invariant_set.h"
#include "controllers/parts/solvers/series_support.h"
#include "controllers/parts/solvers/zonotope.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Plan, with the symbols of tube_sets.h:
//   1. Half widths of S along each state and each row of K: reach_i = h_S(e_i), h_S(K_j).
//   2. S scales with the gusts, so these may grow by factor = min(limit / reach). If factor <= 1,
//      no nominal state keeps the limits: the tube is empty.
//   3. R: the box |e_i| <= reach_i, |K_j e| <= reach_j (kBox), or the largest robust invariant set
//      inside that box widened by 1 + margin, margin = min(kMargin, (factor - 1) / 2), which keeps
//      the tightened limits > 0 (kInvariant).
//   4. Tightened limits: limit - (1 + margin) reach.
//   5. Terminal set: the largest invariant set of z+ = A_K z within the tightened limits.

// Margin of kInvariant. Chosen: without a margin the gusts fill the box exactly, and the iteration
// for the invariant set does not end (invariant_set.cpp).
constexpr double kMargin = 0.01;
// Smallest half width of R, as a share of the limit, for states that gusts do not reach. Chosen: R
// needs an interior, and the limits shrink by this share only.
constexpr double kThinnest = 1e-6;
// Distance of two rows, as a share of their length, below which they are equal: above the rounding
// of the linear programmes.
constexpr double kSameRow = 1e-9;

void check_shape(const char* name, const MatrixXd& matrix, Index rows, Index columns) {
  if (matrix.rows() != rows || matrix.cols() != columns) {
    throw ConfigError(fmt::format("{} of a tube is {} x {}, must be {} x {}", name, matrix.rows(),
                                  matrix.cols(), rows, columns));
  }
  if (!matrix.allFinite()) {
    throw ConfigError(fmt::format("{} of a tube contains a number that is not finite", name));
  }
}

void check(const TubeModel& model) {
  const Index n = model.A.rows(), m = model.B.cols(), g = model.E.cols();
  check_shape("A", model.A, n, n);
  check_shape("B", model.B, n, m);
  check_shape("E", model.E, n, g);
  check_shape("K", model.K, m, n);
  check_shape("the gust", model.gust, g, 1);
  check_shape("the state limit", model.state_limit, n, 1);
  check_shape("the input limit", model.input_limit, m, 1);
  if ((model.gust.array() < 0.0).any()) throw ConfigError("a gust of a tube is negative");
  if ((model.state_limit.array() <= 0.0).any() || (model.input_limit.array() <= 0.0).any()) {
    throw ConfigError("a limit of a tube is not > 0");
  }
}

std::string name_at(const std::vector<std::string>& names, Index i, const char* kind) {
  const auto index = static_cast<std::size_t>(i);
  return index < names.size() ? names[index] : fmt::format("{} {}", kind, i);
}

Zonotope gust_set(const TubeModel& model) {
  return Zonotope(MatrixXd(model.E * model.gust.asDiagonal()));
}

Result<SeriesSupport> make_tube(const TubeModel& model) {
  return SeriesSupport::make(model.A + model.B * model.K, gust_set(model));
}

/// The smallest ratio of limit and reach, and the limit that it belongs to.
GustMargin gust_margin_of(const TubeModel& model, const SeriesSupport& S) {
  GustMargin gust_margin;
  gust_margin.factor = std::numeric_limits<double>::infinity();
  const auto look = [&gust_margin](double limit, double reach, const std::string& name) {
    if (reach > 0.0 && limit / reach < gust_margin.factor) {
      gust_margin.factor = limit / reach;
      gust_margin.binding = name;
    }
  };
  const Index n = model.A.rows(), m = model.B.cols();
  gust_margin.reach.state.resize(n);
  gust_margin.reach.input.resize(m);
  // Without gusts S is the origin, but the bound of the series' remainder is not exactly zero.
  const bool calm = (model.E * model.gust.asDiagonal()).isZero(0.0);
  for (Index i = 0; i < n; ++i) {
    gust_margin.reach.state[i] = calm ? 0.0 : S(VectorXd::Unit(n, i));
    look(model.state_limit[i], gust_margin.reach.state[i], name_at(model.state_names, i, "state"));
  }
  for (Index j = 0; j < m; ++j) {
    gust_margin.reach.input[j] = calm ? 0.0 : S(model.K.row(j));
    look(model.input_limit[j], gust_margin.reach.input[j], name_at(model.input_names, j, "input"));
  }
  return gust_margin;
}

/// Largest set that stays within limits of x and K x forever under x+ = A_K x (+ w, w in W).
struct StayingSet {
  MatrixXd rows;  // of x: |row x| <= 1
  int steps = 0;
};

/// Rows of a set that is symmetric about the origin, one of each pair, divided by their limits. If
/// rounding has dropped one of a pair as redundant, its mirror image represents both.
MatrixXd paired_rows(const Polytope& set) {
  MatrixXd rows(set.rows(), set.dimension());
  Index kept = 0;
  for (Index i = 0; i < set.rows(); ++i) {
    const Eigen::RowVectorXd row = set.F().row(i) / set.g()[i];
    bool is_new = true;
    for (Index k = 0; k < kept && is_new; ++k) {
      const double near = kSameRow * row.norm();
      is_new = (rows.row(k) + row).norm() > near && (rows.row(k) - row).norm() > near;
    }
    if (is_new) rows.row(kept++) = row;
  }
  rows.conservativeResize(kept, Eigen::NoChange);
  return rows;
}

/// Computed for x / limits, so that rows of all units have the same weight.
Result<StayingSet> make_staying_set(const TubeModel& model, const MatrixXd& A_K,
                                    const TubeReach& limits, const Zonotope* W) {
  const MatrixXd scale = limits.state.asDiagonal();
  const MatrixXd unscale = limits.state.cwiseInverse().asDiagonal();
  const MatrixXd A = unscale * A_K * scale;
  const MatrixXd K = limits.input.cwiseInverse().asDiagonal() * model.K * scale;
  const Polytope allowed =
      Polytope::box(VectorXd::Ones(A.rows()))
          .intersection(Polytope::box(VectorXd::Ones(K.rows())).linear_preimage(K));
  const Result<InvariantSet> set =
      W == nullptr ? maximal_invariant_set(A, allowed)
                   : maximal_robust_invariant_set(A, allowed, W->linear_image(unscale));
  if (!set) return Failure{set.reason()};
  return StayingSet{paired_rows(set->set) * unscale, set->steps};
}

/// Rows |e_i| <= reach_i and |K_j e| <= reach_j, divided by their limits.
MatrixXd box_rows(const TubeModel& model, const TubeReach& reach) {
  const Index n = model.A.rows(), m = model.B.cols();
  MatrixXd rows(n + m, n);
  rows.topRows(n) = reach.state.cwiseInverse().asDiagonal();
  rows.bottomRows(m) = reach.input.cwiseInverse().asDiagonal() * model.K;
  return rows;
}

}  // namespace

Result<GustMargin> calc_gust_margin(const TubeModel& model) {
  check(model);
  const Result<SeriesSupport> S = make_tube(model);
  if (!S) return Failure{S.reason()};
  return gust_margin_of(model, *S);
}

Result<TubeSets> make_tube_sets(const TubeModel& model, TubeShape shape) {
  check(model);
  const Result<SeriesSupport> S = make_tube(model);
  if (!S) return Failure{S.reason()};
  TubeSets sets;
  sets.A_K = model.A + model.B * model.K;
  sets.gust_margin = gust_margin_of(model, *S);
  const double factor = sets.gust_margin.factor;
  if (!(factor > 1.0)) {
    return Failure{fmt::format(
        "the tube is empty: gusts alone take {:.3g} times the limit of {}; at most {:.3g} of them "
        "are feasible",
        1.0 / factor, sets.gust_margin.binding, factor)};
  }
  const bool calm = std::isinf(factor);
  TubeReach reach = sets.gust_margin.reach;
  if (!calm) {  // R needs an interior, because its rows are divided by their limits.
    reach.state = reach.state.cwiseMax(kThinnest * model.state_limit);
    reach.input = reach.input.cwiseMax(kThinnest * model.input_limit);
  }
  sets.tube_rows.resize(0, model.A.rows());
  if (!calm && shape == TubeShape::kBox) sets.tube_rows = box_rows(model, reach);
  if (!calm && shape == TubeShape::kInvariant) {
    sets.margin = std::min(kMargin, 0.5 * (factor - 1.0));
    reach.state *= 1.0 + sets.margin;
    reach.input *= 1.0 + sets.margin;
    const Zonotope W = gust_set(model);
    const Result<StayingSet> R = make_staying_set(model, sets.A_K, reach, &W);
    if (!R) return Failure{R.reason()};
    sets.tube_rows = R->rows;
  }
  sets.state_limit = model.state_limit - reach.state;
  sets.input_limit = model.input_limit - reach.input;
  const Result<StayingSet> terminal =
      make_staying_set(model, sets.A_K, {sets.state_limit, sets.input_limit}, nullptr);
  if (!terminal) return Failure{terminal.reason()};
  sets.terminal_rows = terminal->rows;
  sets.terminal_steps = terminal->steps;
  return sets;
}

}  // namespace vinerow::controllers

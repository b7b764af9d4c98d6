/// The sets of tube MPC on the flying wing of wing_models.h: figures of a prototype in other code,
/// simulations, and the definitions themselves.

#include "controllers/parts/solvers/tube_sets.h"

#include <gtest/gtest.h>

#include "controllers/parts/solvers/invariant_set.h"
#include "controllers/parts/solvers/series_support.h"
#include "controllers/parts/solvers/zonotope.h"
#include "engine/core/random.h"
#include "tests/controllers/parts/aircraft/wing_models.h"
#include "tests/controllers/parts/solvers/invariance.h"
#include "tests/controllers/parts/solvers/random_sets.h"

namespace vinerow::test::tube_sets_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd with_feedback_rows(const Wing& wing) {
  MatrixXd rows(5 + wing.K.rows(), 5);
  rows << MatrixXd::Identity(5, 5), wing.K;
  return rows;
}

VectorXd joined(const VectorXd& states, const VectorXd& inputs) {
  VectorXd both(states.size() + inputs.size());
  both << states, inputs;
  return both;
}

/// {x : |F x| <= 1}
controllers::Polytope between(const MatrixXd& F) {
  MatrixXd both(2 * F.rows(), F.cols());
  both << F, -F;
  return controllers::Polytope(both, VectorXd::Ones(both.rows()));
}

TEST(TubeSets, HalfWidthsAndLargestGustsAreThePrototypes) {
  struct Case {
    Wing wing;
    VectorXd reach;
    double gust;
    const char* binding;
  };
  VectorXd lon(7), lat(6);
  lon << .684, 1.438, 1.048, .1387, 1.893, .1030, .0696;
  lat << 1.997, 2.117, .592, .2915, .1203, .1172;
  for (const Case& expected : {Case{longitudinal_wing(), lon, 2.09, "speed along z"},
                               Case{lateral_wing(), lat, 1.79, "aileron"}}) {
    const Result<controllers::GustMargin> gust_margin =
        controllers::calc_gust_margin(expected.wing);
    ASSERT_TRUE(gust_margin) << gust_margin.reason();
    const VectorXd reach = joined(gust_margin->reach.state, gust_margin->reach.input);
    for (int i = 0; i < reach.size(); ++i) {
      EXPECT_NEAR(reach[i], expected.reach[i], 0.01 * expected.reach[i]);
    }
    EXPECT_NEAR(gust_margin->factor, expected.gust, 0.01);
    EXPECT_EQ(gust_margin->binding, expected.binding);
    // What is reached grows with the gust, so the factor is what is left of it.
    const Result<controllers::GustMargin> strong =
        controllers::calc_gust_margin(expected.wing.in_gusts(1.5));
    ASSERT_TRUE(strong);
    EXPECT_NEAR(strong->factor, gust_margin->factor / 1.5, 1e-9);
    EXPECT_NEAR(strong->reach.state[2], 1.5 * gust_margin->reach.state[2], 1e-9);
  }
}

TEST(TubeSets, WorstGustsReachTheHalfWidthsToTheLastMillionth) {
  for (const Wing& wing : {longitudinal_wing(), lateral_wing()}) {
    const Result<controllers::GustMargin> gust_margin = controllers::calc_gust_margin(wing);
    ASSERT_TRUE(gust_margin);
    const VectorXd reach = joined(gust_margin->reach.state, gust_margin->reach.input);
    const MatrixXd rows = with_feedback_rows(wing), A = wing.closed();
    for (int i = 0; i < rows.rows(); ++i) {
      // Gusts of +-1 m/s with the signs that push this row most, 1200 steps long.
      constexpr int kSteps = 1200;
      MatrixXd push(5, kSteps);
      push.col(kSteps - 1) = rows.row(i);
      for (int k = kSteps - 1; k > 0; --k) push.col(k - 1) = A.transpose() * push.col(k);
      VectorXd e = VectorXd::Zero(5);
      for (int k = 0; k < kSteps; ++k) {
        e = A * e + wing.E * (wing.E.transpose() * push.col(k)).cwiseSign();
      }
      EXPECT_NEAR(rows.row(i).dot(e) / reach[i], 1.0, 1e-6);
    }
  }
}

TEST(TubeSets, GustsOfChanceStayInTheTube) {
  RandomStream random(3, "", "gust");
  for (const Wing& wing : {longitudinal_wing(), lateral_wing()}) {
    for (const controllers::TubeShape shape :
         {controllers::TubeShape::kBox, controllers::TubeShape::kInvariant}) {
      const Result<controllers::TubeSets> sets = controllers::make_tube_sets(wing, shape);
      ASSERT_TRUE(sets) << sets.reason();
      VectorXd e = VectorXd::Zero(5), gust(wing.E.cols());
      double max_ratio = 0.0;
      for (int k = 0; k < 10'000; ++k) {
        for (double& d : gust) d = random.uniform() < 0.5 ? -1.0 : 1.0;
        e = sets->A_K * e + wing.E * gust;
        max_ratio = std::max(max_ratio, (sets->tube_rows * e).cwiseAbs().maxCoeff());
      }
      EXPECT_LE(max_ratio, 1.0);
      EXPECT_GT(max_ratio, 0.5);  // and they do come far
    }
  }
}

TEST(TubeSets, InvariantTubeHoldsTheSmallestOneAndIsLittleLarger) {
  for (const Wing& wing : {longitudinal_wing(), lateral_wing().with_lmi_gain()}) {
    const Result<controllers::TubeSets> sets = controllers::make_tube_sets(wing);
    ASSERT_TRUE(sets) << sets.reason();
    const controllers::Zonotope W(wing.E);
    const controllers::Polytope R = between(sets->tube_rows);
    EXPECT_LE(invariance_excess(sets->A_K, R, W), 1e-8);
    const Result<controllers::SeriesSupport> S = controllers::SeriesSupport::make(sets->A_K, W);
    ASSERT_TRUE(S);
    for (int i = 0; i < sets->tube_rows.rows(); ++i) {
      EXPECT_LE((*S)(sets->tube_rows.row(i)), 1.0 + 1e-9);
    }
    EXPECT_DOUBLE_EQ(sets->margin, 0.01);
    const VectorXd reach = joined(sets->gust_margin.reach.state, sets->gust_margin.reach.input);
    const VectorXd tightened = joined(sets->state_limit, sets->input_limit);
    const VectorXd limit = joined(wing.state_limit, wing.input_limit);
    const MatrixXd rows = with_feedback_rows(wing);
    for (int i = 0; i < rows.rows(); ++i) {
      const double width = R.support(rows.row(i));
      EXPECT_GE(width, reach[i]);
      EXPECT_LE(width, 1.01 * reach[i] * (1.0 + 1e-9));
      // Never tightened by more than the tube is wide.
      EXPECT_NEAR(tightened[i], limit[i] - 1.01 * reach[i], 1e-12);
    }
  }
}

TEST(TubeSets, BoxIsNotInvariantWhichIsWhyThereIsTheOther) {
  const Result<controllers::TubeSets> box =
      controllers::make_tube_sets(longitudinal_wing(), controllers::TubeShape::kBox);
  ASSERT_TRUE(box);
  EXPECT_EQ(box->tube_rows.rows(), 7);
  EXPECT_EQ(box->margin, 0.0);
  EXPECT_GT(invariance_excess(box->A_K, between(box->tube_rows),
                              controllers::Zonotope(longitudinal_wing().E)),
            0.1);
}

TEST(TubeSets, TerminalSetKeepsTheTightenedLimitsForEver) {
  for (const auto& [wing, steps] :
       {std::pair{longitudinal_wing(), 13}, std::pair{lateral_wing(), 16}}) {
    const Result<controllers::TubeSets> sets =
        controllers::make_tube_sets(wing, controllers::TubeShape::kBox);
    ASSERT_TRUE(sets);
    EXPECT_EQ(sets->terminal_steps, steps);
    const controllers::Polytope terminal = between(sets->terminal_rows);
    EXPECT_LE(invariance_excess(sets->A_K, terminal, controllers::Zonotope(MatrixXd(5, 0))), 1e-8);
    const controllers::Polytope limits =
        controllers::Polytope::box(sets->state_limit)
            .intersection(controllers::Polytope::box(sets->input_limit).linear_preimage(wing.K));
    EXPECT_TRUE(limits.contains(terminal));
    // Maximal: any point of the limits that stays inside them is in it.
    RandomStream random(4, "", "start");
    int inside = 0;
    for (int i = 0; i < 3000; ++i) {
      VectorXd z(5);
      for (int j = 0; j < 5; ++j) z[j] = random.uniform(-1.0, 1.0) * sets->state_limit[j];
      VectorXd moved = z;
      bool stays = true;
      for (int k = 0; k < 100 && stays; ++k, moved = sets->A_K * moved) {
        stays = limits.contains(moved);
      }
      inside += stays;
      EXPECT_EQ(stays, terminal.contains(z, 1e-9));
    }
    EXPECT_GT(inside, 20);
  }
}

TEST(TubeSets, GustsUpToTheLargestAreFeasibleAndBeyondRefused) {
  for (const Wing& wing : {longitudinal_wing(), lateral_wing()}) {
    const Result<controllers::GustMargin> gust_margin = controllers::calc_gust_margin(wing);
    ASSERT_TRUE(gust_margin);
    for (const double share : {0.998, 0.9999}) {
      const Result<controllers::TubeSets> close =
          controllers::make_tube_sets(wing.in_gusts(share * gust_margin->factor));
      ASSERT_TRUE(close) << close.reason();
      EXPECT_LT(close->margin, 1.0 / share - 1.0);
      EXPECT_GT(joined(close->state_limit, close->input_limit).minCoeff(), 0.0);
      EXPECT_LE(
          invariance_excess(close->A_K, between(close->tube_rows),
                            controllers::Zonotope(MatrixXd(share * gust_margin->factor * wing.E))),
          1e-8);
    }
    EXPECT_FALSE(controllers::make_tube_sets(wing.in_gusts(1.0001 * gust_margin->factor)));
  }
  EXPECT_EQ(controllers::make_tube_sets(lateral_wing().with_tight_limits()).reason(),
            "the tube is empty: gusts alone take 1.34 times the limit of aileron; at most 0.745 of "
            "them are feasible");
}

TEST(TubeSets, WithoutGustsThereIsNoTubeAndNoTightening) {
  const Wing wing = lateral_wing();
  const Result<controllers::TubeSets> sets = controllers::make_tube_sets(wing.in_gusts(0.0));
  ASSERT_TRUE(sets) << sets.reason();
  EXPECT_EQ(sets->tube_rows.rows(), 0);
  EXPECT_EQ(sets->state_limit, wing.state_limit);
  EXPECT_EQ(sets->input_limit, wing.input_limit);
  EXPECT_TRUE(std::isinf(sets->gust_margin.factor));
}

TEST(TubeSets, GustsThatMissAStateLeaveAThinTube) {
  // Two integrators with feedback, of which one feels the gust: S is a segment.
  controllers::TubeModel model;
  model.A = MatrixXd::Identity(2, 2);
  model.B = MatrixXd::Identity(2, 2);
  model.E = Eigen::Vector2d(1.0, 0.0);
  model.K = -0.5 * MatrixXd::Identity(2, 2);
  model.gust = VectorXd::Ones(1);
  model.state_limit = VectorXd::Constant(2, 10.0);
  model.input_limit = VectorXd::Constant(2, 10.0);
  const Result<controllers::TubeSets> sets = controllers::make_tube_sets(model);
  ASSERT_TRUE(sets) << sets.reason();
  // 1 + 1/2 + 1/4 + ... = 2, of which the feedback takes half.
  EXPECT_NEAR(sets->gust_margin.reach.state[0], 2.0, 1e-11);
  EXPECT_NEAR(sets->gust_margin.reach.input[0], 1.0, 1e-11);
  EXPECT_NEAR(sets->state_limit[0], 10.0 - 2.02, 1e-9);
  EXPECT_NEAR(sets->state_limit[1], 10.0, 1e-4);
}

TEST(TubeSets, BadInputIsToldApart) {
  Wing wing = longitudinal_wing();
  wing.K.setZero();
  EXPECT_EQ(controllers::calc_gust_margin(wing).reason().rfind(
                "A is not Schur stable: its spectral radius", 0),
            0u);
  EXPECT_EQ(controllers::make_tube_sets(wing).reason(),
            controllers::calc_gust_margin(wing).reason());
  wing = longitudinal_wing();
  wing.gust.setOnes(1);
  EXPECT_EQ(complaint([&] { (void)controllers::calc_gust_margin(wing); }),
            "the gust of a tube is 1 x 1, must be 2 x 1");
  wing = longitudinal_wing();
  wing.input_limit[1] = 0.0;
  EXPECT_EQ(complaint([&] { (void)controllers::make_tube_sets(wing); }),
            "a limit of a tube is not > 0");
  wing = longitudinal_wing();
  wing.E(0, 0) = std::nan("");
  EXPECT_EQ(complaint([&] { (void)controllers::make_tube_sets(wing); }),
            "E of a tube contains a number that is not finite");
}

}  // namespace
}  // namespace vinerow::test::tube_sets_test

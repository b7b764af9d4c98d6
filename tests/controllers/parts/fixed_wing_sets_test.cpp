/// Tightening of a small flying wing's tube MPC in gusts: figures of a prototype in other code.
/// Models: 12 m/s, sampled at 0.05 s. The matrices are printed to four decimals, the prototype had
/// them in full: putting random digits in place of those rounded off moves the half widths by up to
/// 2 % (altitude) and 1 % (others), and the prototype's lie within; ours are within 0.3 %.

#include <gtest/gtest.h>

#include <numbers>

#include "controllers/parts/invariant_set.h"
#include "controllers/parts/outer_minimal_set.h"
#include "controllers/parts/series_support.h"
#include "controllers/parts/zonotope.h"
#include "engine/core/random.h"

namespace vinerow::test {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

struct Wing {
  Eigen::MatrixXd A, B, E, K;                  // u = K x; E: per 1 m/s of gust
  Eigen::VectorXd states, inputs;              // largest allowed ("relaxed" reading)
  Eigen::VectorXd tight_states, tight_inputs;  // "full scale" reading

  Eigen::MatrixXd closed() const { return A + B * K; }
  Polytope constraints() const {
    return Polytope::box(states).intersection(Polytope::box(inputs).linear_preimage(K));
  }
};

/// States u m/s, w m/s, q rad/s, theta rad, h m; inputs throttle and elevator rad.
Wing longitudinal() {
  Wing wing{Eigen::MatrixXd(5, 5), Eigen::MatrixXd(5, 2), Eigen::MatrixXd(5, 2),
            Eigen::MatrixXd(2, 5), Eigen::VectorXd(5),    Eigen::VectorXd(2),
            Eigen::VectorXd(5),    Eigen::VectorXd(2)};
  // clang-format off
  wing.A << .9739,  .0496, -.0649, -.4818, 0,
           -.0215,  .6433,  .3848, -.0451, 0,
            .0614, -.3532,  .6485, -.0027, 0,
            .0016, -.0100,  .0416,  1,     0,
            .0073, -.0431,  .0023,  .5997, 1;
  wing.B << .5764, .2057, -.0082, -2.0268, .0183, -5.0291, .0003, -.1361, .0021, .0138;
  wing.E << .0261, -.0496, .0215, .3567, -.0614, .3532, -.0016, .0100, -.0009, -.0065;
  wing.K << -.1192, -.0085, .0047, -.0048, -.0243,
            -.0101, -.0418, .0597,  .7366,  .0246;
  // clang-format on
  wing.states << 2.4, 3.0, 150.0 * kDeg, 20.0 * kDeg, 15.0;
  wing.inputs << 0.25, 10.0 * kDeg;
  wing.tight_states << 1.2, 2.4, 90.0 * kDeg, 15.0 * kDeg, 15.0;
  wing.tight_inputs << 0.2, 5.0 * kDeg;
  return wing;
}

/// States v m/s, p rad/s, r rad/s, phi rad, psi rad; input aileron rad.
Wing lateral() {
  Wing wing{Eigen::MatrixXd(5, 5), Eigen::MatrixXd(5, 1), Eigen::MatrixXd(5, 1),
            Eigen::MatrixXd(1, 5), Eigen::VectorXd(5),    Eigen::VectorXd(1),
            Eigen::VectorXd(5),    Eigen::VectorXd(1)};
  // clang-format off
  wing.A << .9398,  .0756, -.5548,  .4745, 0,
           -.4098,  .5872,  .2817, -.1097, 0,
            .0564, -.0325,  .9531,  .0132, 0,
           -.0111,  .0389,  .0127,  .9981, 0,
            .0014, -.0009,  .0494,  .0002, 1;
  wing.B << .2902, 5.2140, -.2609, .1413, -.0057;
  wing.E << .0602, .4098, -.0564, .0111, -.0014;
  wing.K << -.0290, -.0429, -.1258, -.5042, -.4278;
  // clang-format on
  wing.states << 5.0, 250.0 * kDeg, 120.0 * kDeg, 45.0 * kDeg, 30.0 * kDeg;
  wing.inputs << 12.0 * kDeg;
  wing.tight_states << 3.0, 120.0 * kDeg, 60.0 * kDeg, 30.0 * kDeg, 18.0 * kDeg;
  wing.tight_inputs << 5.0 * kDeg;
  return wing;
}

Eigen::VectorXd supports(const Support& S, const Eigen::MatrixXd& rows) {
  Eigen::VectorXd values(rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) values[i] = S(rows.row(i));
  return values;
}

/// How many m/s of gust the limits leave room for.
double largest_gust(const Support& S, const Wing& wing, const Eigen::VectorXd& states,
                    const Eigen::VectorXd& inputs) {
  const Eigen::VectorXd x = supports(S, Eigen::MatrixXd::Identity(5, 5));
  return std::min(states.cwiseQuotient(x).minCoeff(),
                  inputs.cwiseQuotient(supports(S, wing.K)).minCoeff());
}

void expect_within(const Eigen::VectorXd& values, const Eigen::VectorXd& expected,
                   double relative) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i], expected[i], relative * expected[i]) << "entry " << i;
  }
}

TEST(FixedWingSets, HalfWidthsOfTheTubeAreThePrototypes) {
  const Wing lon = longitudinal(), lat = lateral();
  const Result<SeriesSupport> S_lon = SeriesSupport::make(lon.closed(), Zonotope(lon.E));
  const Result<SeriesSupport> S_lat = SeriesSupport::make(lat.closed(), Zonotope(lat.E));
  ASSERT_TRUE(S_lon && S_lat);
  const Eigen::MatrixXd axes = Eigen::MatrixXd::Identity(5, 5);
  Eigen::VectorXd x_lon(5), x_lat(5);
  x_lon << .684, 1.438, 1.048, .1387, 1.893;
  x_lat << 1.997, 2.117, .592, .2915, .1203;
  expect_within(supports(*S_lon, axes), x_lon, 3e-3);
  expect_within(supports(*S_lon, lon.K), Eigen::Vector2d(.1030, .0696), 3e-3);
  expect_within(supports(*S_lat, axes), x_lat, 3e-3);
  expect_within(supports(*S_lat, lat.K), Eigen::VectorXd::Constant(1, .1172), 3e-3);
  EXPECT_NEAR(largest_gust(*S_lon, lon, lon.states, lon.inputs), 2.09, 0.01);
  EXPECT_NEAR(largest_gust(*S_lat, lat, lat.states, lat.inputs), 1.79, 0.005);
  EXPECT_NEAR(largest_gust(*S_lon, lon, lon.tight_states, lon.tight_inputs), 1.25, 0.005);
  EXPECT_NEAR(largest_gust(*S_lat, lat, lat.tight_states, lat.tight_inputs), .745, 0.001);
}

TEST(FixedWingSets, AdversaryReachesTheHalfWidthsAndChanceDoesNot) {
  // Simulated: 600 gusts of +-1 m/s with the signs that push one output most.
  for (const Wing& wing : {longitudinal(), lateral()}) {
    const Eigen::MatrixXd A = wing.closed();
    const Result<SeriesSupport> S = SeriesSupport::make(A, Zonotope(wing.E));
    ASSERT_TRUE(S);
    Eigen::MatrixXd rows(5 + wing.K.rows(), 5);
    rows << Eigen::MatrixXd::Identity(5, 5), wing.K;
    RandomStream random(1, "", "gust");
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      constexpr int kSteps = 600;
      Eigen::MatrixXd reach(5, kSteps);
      reach.col(kSteps - 1) = rows.row(i);
      for (int k = kSteps - 1; k > 0; --k) reach.col(k - 1) = A.transpose() * reach.col(k);
      Eigen::VectorXd worst = Eigen::VectorXd::Zero(5), chance = worst;
      for (int k = 0; k < kSteps; ++k) {
        const Eigen::VectorXd push = wing.E.transpose() * reach.col(k);
        worst = A * worst + wing.E * push.cwiseSign();
        Eigen::VectorXd gust(wing.E.cols());
        for (double& d : gust) d = random.uniform() < 0.5 ? -1.0 : 1.0;
        chance = A * chance + wing.E * gust;
      }
      const double limit = (*S)(rows.row(i));
      EXPECT_NEAR(rows.row(i).dot(worst) / limit, 1.0, 1e-5);
      EXPECT_LT(std::abs(rows.row(i).dot(chance)), 0.95 * limit);
    }
  }
}

TEST(FixedWingSets, BoxAroundTheGustsIsSeveralTimesAsLarge) {
  struct Case {
    Wing wing;
    double gust, tight_gust;
    int steps;
  };
  for (const Case& expected :
       {Case{longitudinal(), .55, .27, 321}, Case{lateral(), .52, .22, 125}}) {
    const Wing& wing = expected.wing;
    const Eigen::VectorXd half = Zonotope(wing.E).half_widths();
    const Result<SeriesSupport> S = SeriesSupport::make(wing.closed(), Zonotope::box(half));
    ASSERT_TRUE(S);
    EXPECT_NEAR(largest_gust(*S, wing, wing.states, wing.inputs), expected.gust, 0.006);
    EXPECT_NEAR(largest_gust(*S, wing, wing.tight_states, wing.tight_inputs), expected.tight_gust,
                0.005);
    const Result<OuterMinimalSet> outer =
        OuterMinimalSet::make(wing.closed(), Polytope::box(half), {});
    ASSERT_TRUE(outer);
    EXPECT_EQ(outer->steps(), expected.steps);
    for (int i = 0; i < 5; ++i) {
      const double ratio =
          (*outer)(Eigen::VectorXd::Unit(5, i)) / (*S)(Eigen::VectorXd::Unit(5, i));
      EXPECT_GT(ratio, 1.0);
      EXPECT_LT(ratio, 1.0 / (1.0 - 0.02));
    }
  }
}

TEST(FixedWingSets, TerminalSetsNeedThePrototypesNumberOfSteps) {
  for (const auto& [wing, steps] : {std::pair{longitudinal(), 13}, std::pair{lateral(), 16}}) {
    const Eigen::MatrixXd A = wing.closed();
    const Zonotope W(wing.E);
    const Result<SeriesSupport> S = SeriesSupport::make(A, W);
    ASSERT_TRUE(S);
    const Polytope tightened = wing.constraints().pontryagin_difference(*S);
    const Result<InvariantSet> terminal = maximal_invariant_set(A, tightened);
    ASSERT_TRUE(terminal) << terminal.reason();
    EXPECT_EQ(terminal->steps, steps);
    EXPECT_LE(invariance_excess(A, terminal->set, Zonotope(Eigen::MatrixXd(5, 0))), 1e-8);
    // What an error in S and a nominal state in the terminal set add up to stays in the limits, and
    // so is part of the maximal robust set.
    const Result<InvariantSet> robust = maximal_robust_invariant_set(A, wing.constraints(), W);
    ASSERT_TRUE(robust) << robust.reason();
    EXPECT_LE(invariance_excess(A, robust->set, W), 1e-8);
    const Polytope& R = robust->set;
    for (int i = 0; i < R.rows(); ++i) {
      EXPECT_LE(terminal->set.support(R.F().row(i)) + (*S)(R.F().row(i)), R.g()[i] * (1.0 + 1e-8));
    }
  }
}

TEST(FixedWingSets, RobustSetIsWhatRandomAndWorstGustsStayIn) {
  const Wing wing = lateral();
  const Eigen::MatrixXd A = wing.closed();
  const Polytope X = wing.constraints();
  const Result<InvariantSet> robust = maximal_robust_invariant_set(A, X, Zonotope(wing.E));
  ASSERT_TRUE(robust);
  RandomStream random(2, "", "gust");
  int inside = 0, steps_outside = 0;
  while (inside < 300) {
    Eigen::VectorXd x(5);
    for (int j = 0; j < 5; ++j) x[j] = random.uniform(-1.0, 1.0) * wing.states[j];
    if (!robust->set.contains(x)) continue;
    ++inside;
    for (int k = 0; k < 100; ++k) {
      x = A * x + wing.E * (random.uniform() < 0.5 ? -1.0 : 1.0);
      steps_outside += !robust->set.contains(x, 1e-9) || !X.contains(x, 1e-9);
    }
  }
  EXPECT_EQ(steps_outside, 0);
}

TEST(FixedWingSets, LateralGustBeyondTheLimitIsRefusedWithBothNumbers) {
  Wing wing = lateral();
  wing.states = wing.tight_states;
  wing.inputs = wing.tight_inputs;
  const Result<InvariantSet> set =
      maximal_robust_invariant_set(wing.closed(), wing.constraints(), Zonotope(wing.E));
  ASSERT_FALSE(set);
  EXPECT_EQ(set.reason(),
            "the disturbance is too large: alone it brings row 2 of the constraints to 2.11866, "
            "the limit "
            "is 2.0944");
}

}  // namespace
}  // namespace vinerow::test

/// Tube MPC on the flying wing of wing_models.h: what must be exact (no correction while nothing is
/// active, inputs within their limits), what is promised (the next problem is feasible if this one
/// is, whatever the gusts), and the laws that do worse. Optima are judged by cvxopt in
/// tube_mpc_check.py.

#include "controllers/parts/solvers/tube_mpc.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "engine/core/random.h"
#include "tests/controllers/parts/aircraft/wing_models.h"
#include "tests/controllers/parts/solvers/random_sets.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::tube_mpc_test {
namespace {

using Eigen::VectorXd;

constexpr double kNone = 1e-6;  // violation as a share of a limit: what softness leaves

controllers::TubeSets sets_of(const Wing& wing,
                              controllers::TubeShape shape = controllers::TubeShape::kInvariant) {
  Result<controllers::TubeSets> sets = controllers::make_tube_sets(wing, shape);
  EXPECT_TRUE(sets) << sets.reason();
  return std::move(sets).value();
}

controllers::TubeMpc make_mpc(const Wing& wing,
                              controllers::TubeLaw law = controllers::TubeLaw::kTube,
                              controllers::TubeShape shape = controllers::TubeShape::kInvariant) {
  return controllers::TubeMpc(wing, sets_of(wing, shape), wing.cost, {.law = law}, "wing");
}

double share(const VectorXd& values, const VectorXd& limits) {
  return values.cwiseAbs().cwiseQuotient(limits).maxCoeff();
}

VectorXd random_state(const Wing& wing, RandomStream& random, double size) {
  VectorXd x(5);
  for (int j = 0; j < 5; ++j) x[j] = size * random.uniform(-1.0, 1.0) * wing.state_limit[j];
  return x;
}

VectorXd random_gust(const Wing& wing, RandomStream& random) {
  VectorXd gust = wing.gust;
  for (double& d : gust) d *= random.uniform() < 0.5 ? -1.0 : 1.0;
  return gust;
}

/// The farthest state along `direction` with a problem that is feasible without softness.
VectorXd farthest_feasible(controllers::TubeMpc& mpc, const VectorXd& direction) {
  double good = 0.0, bad = 1.0;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (good + bad);
    EXPECT_EQ(mpc.solve(middle * direction), controllers::QpStatus::kSolved);
    (mpc.soft_violation() < kNone ? good : bad) = middle;
  }
  mpc.cold_start();
  return good * direction;
}

struct Flight {
  int steps_outside_states = 0, steps_outside_inputs = 0;
  double largest_input = 0.0;      // share of the limit
  double largest_violation = 0.0;  // of soft rows
  int active_steps = 0;
  VectorXd end;
};

using Gusts = std::function<VectorXd(int step, const VectorXd& x)>;

Flight fly(const Wing& wing, controllers::TubeMpc& mpc, VectorXd x, int steps, const Gusts& gusts) {
  Flight flight;
  for (int k = 0; k < steps; ++k) {
    EXPECT_EQ(mpc.solve(x), controllers::QpStatus::kSolved);
    const double input = share(mpc.u(), wing.input_limit);
    flight.largest_input = std::max(flight.largest_input, input);
    flight.largest_violation = std::max(flight.largest_violation, mpc.soft_violation());
    flight.steps_outside_inputs += input > 1.0 + 1e-9;
    flight.steps_outside_states += share(x, wing.state_limit) > 1.0 + kNone;
    flight.active_steps += mpc.active_rows() > 0;
    x = wing.A * x + wing.B * mpc.u() + wing.E * gusts(k, x);
  }
  flight.end = x;
  return flight;
}

TEST(TubeMpc, IsTheLqrWhileNothingIsActive) {
  RandomStream random(1, "", "state");
  for (const Wing& wing : {longitudinal_wing(), lateral_wing(), longitudinal_wing().with_lmi_gain(),
                           lateral_wing().with_lmi_gain()}) {
    controllers::TubeMpc mpc = make_mpc(wing);
    int beyond_tube = 0;
    for (int i = 0; i < 300; ++i) {
      const VectorXd x = random_state(wing, random, random.uniform(0.0, 0.2));
      ASSERT_EQ(mpc.solve(x), controllers::QpStatus::kSolved);
      // u = K x + c_0 with the LQR's cost, whatever z_0 is: so without limits on z and v the law is
      // the LQR's even where z_0 is not zero.
      EXPECT_LT((mpc.u() - wing.K * x - mpc.corrections().head(wing.K.rows())).norm(), 1e-12);
      if (mpc.tube_share() < 1.0 - 1e-9) {
        EXPECT_EQ(mpc.z0(), VectorXd::Zero(5));
        EXPECT_LT((mpc.u() - wing.K * x).norm(), 1e-15);
        EXPECT_EQ(mpc.iterations(), 0);
      }
      beyond_tube += mpc.tube_share() >= 1.0 - 1e-9;
    }
    EXPECT_GT(beyond_tube, 30);
    EXPECT_LT(beyond_tube, 270);
  }
}

TEST(TubeMpc, OutsideItsTubeButWithinLimitsIsStillTheLqr) {
  // The gain is the LQR's to four decimals, so the cost hardly couples z_0 and c.
  for (const Wing& wing : {longitudinal_wing(), lateral_wing()}) {
    controllers::TubeMpc mpc = make_mpc(wing),
                         fixed = make_mpc(wing, controllers::TubeLaw::kFixedStart);
    RandomStream random(2, "", "state");
    int outside = 0;
    for (int i = 0; i < 300; ++i) {
      const VectorXd x = random_state(wing, random, 0.12);
      ASSERT_EQ(mpc.solve(x), controllers::QpStatus::kSolved);
      if (mpc.iterations() == 0) continue;
      ASSERT_EQ(fixed.solve(x), controllers::QpStatus::kSolved);
      if (fixed.active_rows() > 0) continue;  // z_0 = x and c = 0 keep all limits
      ++outside;
      EXPECT_LT((fixed.u() - wing.K * x).cwiseQuotient(wing.input_limit).norm(), 2e-3);
      EXPECT_LT((mpc.u() - wing.K * x).cwiseQuotient(wing.input_limit).norm(), 2e-3);
    }
    EXPECT_GT(outside, 5);
  }
}

TEST(TubeMpc, ShortCutAndProgrammeMeet) {
  for (const Wing& wing : {longitudinal_wing(), lateral_wing()}) {
    controllers::TubeMpc mpc = make_mpc(wing);
    const controllers::TubeSets sets = sets_of(wing);
    RandomStream random(3, "", "direction");
    for (int i = 0; i < 50; ++i) {
      const VectorXd direction = random_state(wing, random, 1.0);
      const VectorXd edge = direction / (sets.tube_rows * direction).cwiseAbs().maxCoeff();
      ASSERT_EQ(mpc.solve((1.0 - 1e-5) * edge), controllers::QpStatus::kSolved);
      EXPECT_EQ(mpc.active_rows(), 0);
      const VectorXd inside = mpc.u();
      ASSERT_EQ(mpc.solve((1.0 + 1e-5) * edge), controllers::QpStatus::kSolved);
      EXPECT_GT(mpc.active_rows(), 0);
      EXPECT_LT((mpc.u() - inside).cwiseQuotient(wing.input_limit).norm(), 1e-4);
    }
  }
}

TEST(TubeMpc, InputsKeepTheirLimitsWhereverTheStateIs) {
  for (const Wing& wing : {longitudinal_wing(), lateral_wing()}) {
    for (const controllers::TubeLaw law :
         {controllers::TubeLaw::kTube, controllers::TubeLaw::kFixedStart,
          controllers::TubeLaw::kPropagated}) {
      controllers::TubeMpc mpc = make_mpc(wing, law);
      RandomStream random(4, "", "state");
      int outside = 0;
      double max_share = 0.0;
      for (int i = 0; i < 40; ++i) {
        ASSERT_EQ(mpc.solve(random_state(wing, random, random.uniform(0.0, 4.0))),
                  controllers::QpStatus::kSolved);
        max_share = std::max(max_share, share(mpc.u(), wing.input_limit));
        outside += mpc.soft_violation() > kNone;
      }
      EXPECT_LE(max_share, 1.0 + 1e-7);
      EXPECT_GT(outside, 15);
    }
  }
}

TEST(TubeMpc, FiftySeedsOfWorstCaseGustsFromTheEdgeOfFeasibilityViolateNothing) {
  for (const Wing& wing : {longitudinal_wing(), lateral_wing()}) {
    for (const controllers::TubeLaw law :
         {controllers::TubeLaw::kTube, controllers::TubeLaw::kPropagated}) {
      controllers::TubeMpc mpc = make_mpc(wing, law);
      int active_steps = 0;
      for (std::uint64_t seed = 0; seed < 50; ++seed) {
        RandomStream random(seed, "", "gust");
        mpc.cold_start();
        const VectorXd start = farthest_feasible(mpc, random_state(wing, random, 2.0));
        const Flight flight = fly(wing, mpc, start, 60,
                                  [&](int, const VectorXd&) { return random_gust(wing, random); });
        EXPECT_EQ(flight.steps_outside_states, 0);
        EXPECT_EQ(flight.steps_outside_inputs, 0);
        EXPECT_LT(flight.largest_violation, 2.0 * kNone);  // feasible at every step
        active_steps += flight.active_steps;
      }
      EXPECT_GT(active_steps, 100);
    }
  }
}

TEST(TubeMpc, AdversaryViolatesNothing) {
  // At every step the gust that pushes one row most, seen over the steps that the loop remembers.
  for (const Wing& wing : {longitudinal_wing(), lateral_wing()}) {
    controllers::TubeMpc mpc = make_mpc(wing);
    const Result<controllers::GustMargin> gust_margin = controllers::calc_gust_margin(wing);
    ASSERT_TRUE(gust_margin);
    Eigen::MatrixXd rows(5 + wing.K.rows(), 5);
    rows << Eigen::MatrixXd::Identity(5, 5), wing.K;
    for (int i = 0; i < rows.rows(); ++i) {
      for (const double sign : {-1.0, 1.0}) {
        mpc.cold_start();
        VectorXd ahead(5);
        ahead = sign * rows.row(i).transpose();
        const VectorXd start = farthest_feasible(mpc, 4.0 * ahead);
        constexpr int kSteps = 200;
        Eigen::MatrixXd push(5, kSteps);
        push.col(kSteps - 1) = ahead;
        for (int k = kSteps - 1; k > 0; --k)
          push.col(k - 1) = wing.closed().transpose() * push.col(k);
        const Flight flight =
            fly(wing, mpc, start, kSteps, [&](int k, const VectorXd&) -> VectorXd {
              return (wing.E.transpose() * push.col(k)).cwiseSign().cwiseProduct(wing.gust);
            });
        EXPECT_EQ(flight.steps_outside_states, 0);
        EXPECT_EQ(flight.steps_outside_inputs, 0);
        EXPECT_LT(flight.largest_violation, 2.0 * kNone);
        // It is the worst case: at its end the error fills its tube.
        const double reach = i < 5 ? gust_margin->reach.state[i] : gust_margin->reach.input[i - 5];
        EXPECT_GT(ahead.dot(flight.end), 0.95 * reach);
      }
    }
  }
}

TEST(TubeMpc, StrongestFeasibleGustViolatesNothing) {
  for (Wing wing : {longitudinal_wing(), lateral_wing()}) {
    const Result<controllers::GustMargin> gust_margin = controllers::calc_gust_margin(wing);
    ASSERT_TRUE(gust_margin);
    wing = wing.in_gusts(0.99 * gust_margin->factor);
    controllers::TubeMpc mpc = make_mpc(wing);
    RandomStream random(5, "", "gust");
    const Flight flight = fly(wing, mpc, VectorXd::Zero(5), 2000,
                              [&](int, const VectorXd&) { return random_gust(wing, random); });
    EXPECT_EQ(flight.steps_outside_states, 0);
    EXPECT_EQ(flight.steps_outside_inputs, 0);
    EXPECT_EQ(flight.active_steps, 0);  // from the origin the error never leaves its tube
  }
}

TEST(TubeMpc, OrdinaryMpcOnTheSameModelLosesItsFeasibilityInGusts) {
  // Untightened limits and z_0 = x: the nominal problem. The lateral axis at the edge of what it
  // calls feasible is carried out of its limits; the tube's own edge is not.
  const Wing wing = lateral_wing();
  const Wing calm = wing.in_gusts(0.0);
  controllers::TubeMpc nominal = make_mpc(calm);
  int outside = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    RandomStream random(seed, "", "gust");
    nominal.cold_start();
    const VectorXd start = farthest_feasible(nominal, random_state(wing, random, 2.0));
    const Flight flight = fly(wing, nominal, start, 60,
                              [&](int, const VectorXd&) { return random_gust(wing, random); });
    EXPECT_EQ(flight.steps_outside_inputs, 0);
    outside += flight.largest_violation > 1e-3;
  }
  EXPECT_GT(outside, 10);
}

TEST(TubeMpc, LawAsPrintedLeavesTheInputLimits) {
  // 14 m low: the printed law counts K x twice.
  const Wing wing = longitudinal_wing();
  VectorXd low = VectorXd::Zero(5);
  low[4] = -14.0;
  const auto calm = [&](int, const VectorXd&) -> VectorXd { return VectorXd::Zero(2); };
  controllers::TubeMpc printed = make_mpc(wing, controllers::TubeLaw::kPrinted),
                       right = make_mpc(wing);
  const Flight flown = fly(wing, printed, low, 240, calm);
  EXPECT_GT(flown.largest_input, 2.0);
  EXPECT_GT(flown.steps_outside_inputs, 20);
  const Flight good = fly(wing, right, low, 240, calm);
  EXPECT_LE(good.largest_input, 1.0 + 1e-7);
  EXPECT_EQ(good.steps_outside_states, 0);
  // In the middle it is u = 2 K x.
  const VectorXd near = 1e-3 * low;
  ASSERT_EQ(printed.solve(near), controllers::QpStatus::kSolved);
  EXPECT_LT((printed.u() - 2.0 * wing.K * near).norm(), 2e-3 * (wing.K * near).norm());
}

TEST(TubeMpc, FixedStartIsLostWhereTheTightenedHeadingEnds) {
  const Wing wing = lateral_wing();
  const controllers::TubeSets sets = sets_of(wing, controllers::TubeShape::kBox);
  EXPECT_NEAR(sets.state_limit[4] / kDeg, 23.1, 0.02);  // 30 deg less 6.9: the prototype's figure
  VectorXd off = VectorXd::Zero(5);
  off[4] = 30.0 * kDeg;
  controllers::TubeMpc fixed(wing, sets, wing.cost, {.law = controllers::TubeLaw::kFixedStart},
                             "wing");
  // Ailerons yaw the wrong way at first, so a little less than that is feasible.
  const double farthest_deg = farthest_feasible(fixed, off)[4] / kDeg;
  EXPECT_GT(farthest_deg, 22.5);
  EXPECT_LT(farthest_deg, 23.1);
  off[4] = 20.0 * kDeg;
  ASSERT_EQ(fixed.solve(off), controllers::QpStatus::kSolved);
  EXPECT_LT(fixed.soft_violation(), kNone);
  off[4] = 24.0 * kDeg;
  ASSERT_EQ(fixed.solve(off), controllers::QpStatus::kSolved);
  EXPECT_GT(fixed.soft_violation(), 24.0 / 23.1 - 1.001);
  EXPECT_EQ(fixed.worst_row().kind, controllers::TubeRow::Kind::kState);
  EXPECT_EQ(fixed.worst_row().index, 4);
  for (const controllers::TubeShape shape :
       {controllers::TubeShape::kBox, controllers::TubeShape::kInvariant}) {
    controllers::TubeMpc free = make_mpc(wing, controllers::TubeLaw::kTube, shape);
    ASSERT_EQ(free.solve(off), controllers::QpStatus::kSolved);
    EXPECT_LT(free.soft_violation(), kNone);
  }
}

TEST(TubeMpc, PropagatedStateFollowsItsOwnModelAndStartsAnewWhenLost) {
  const Wing wing = lateral_wing();
  controllers::TubeMpc mpc = make_mpc(wing, controllers::TubeLaw::kPropagated);
  VectorXd x = VectorXd::Zero(5);
  x[4] = 20.0 * kDeg;
  RandomStream random(6, "", "gust");
  VectorXd expected;
  for (int k = 0; k < 40; ++k) {
    ASSERT_EQ(mpc.solve(x), controllers::QpStatus::kSolved);
    if (k > 0) {
      EXPECT_LT((mpc.z0() - expected).norm(), 1e-12);
    }
    EXPECT_LE(mpc.tube_share(), 1.0 + 1e-8);
    expected = wing.A * mpc.z0() + wing.B * mpc.v0();
    x = wing.A * x + wing.B * mpc.u() + wing.E * random_gust(wing, random);
  }
  x[4] = -25.0 * kDeg;  // no gust does that
  ASSERT_EQ(mpc.solve(x), controllers::QpStatus::kSolved);
  EXPECT_GT((mpc.z0() - expected).norm(), 0.1);
  EXPECT_LE(mpc.tube_share(), 1.0 + 1e-8);
}

TEST(TubeMpc, HardLimitsHaveNoSolutionFarOutAndTheLawFallsBack) {
  const Wing wing = longitudinal_wing();
  controllers::TubeMpcSettings settings;
  settings.soft_weight = std::numeric_limits<double>::infinity();
  controllers::TubeMpc mpc(wing, sets_of(wing), wing.cost, settings, "wing");
  VectorXd x = VectorXd::Zero(5);
  x[4] = -40.0;
  EXPECT_EQ(mpc.solve(x), controllers::QpStatus::kInfeasible);
  EXPECT_EQ(mpc.u(), (wing.K * x).cwiseMin(wing.input_limit).cwiseMax(-wing.input_limit));
  x[4] = std::nan("");
  EXPECT_EQ(mpc.solve(x), controllers::QpStatus::kInvalidInput);
  EXPECT_EQ(mpc.u(), VectorXd::Zero(2));
  x[4] = -3.0;
  EXPECT_EQ(mpc.solve(x), controllers::QpStatus::kSolved);
  EXPECT_TRUE(mpc.u().allFinite());
}

TEST(TubeMpc, SameCallsSameBitsAndNoHeap) {
  const Wing wing = longitudinal_wing();
  const controllers::TubeSets sets = sets_of(wing);
  for (const controllers::TubeLaw law :
       {controllers::TubeLaw::kTube, controllers::TubeLaw::kFixedStart,
        controllers::TubeLaw::kPropagated}) {
    controllers::TubeMpc first(wing, sets, wing.cost, {.law = law}, "wing"),
        second(wing, sets, wing.cost, {.law = law}, "wing");
    RandomStream random(7, "", "gust");
    VectorXd x = VectorXd::Zero(5);
    x[4] = -14.0;
    for (int k = 0; k < 100; ++k) {
      {
        AllocationCounter counter;
        first.solve(x);
        EXPECT_EQ(counter.count(), 0u) << "step " << k;
      }
      second.solve(x);
      ASSERT_EQ(first.u(), second.u());
      ASSERT_EQ(first.cost(), second.cost());
      x = wing.A * x + wing.B * first.u() + wing.E * random_gust(wing, random);
    }
  }
}

TEST(TubeMpc, RefusesWhatDoesNotFit) {
  const Wing wing = lateral_wing();
  const controllers::TubeSets sets = sets_of(wing);
  controllers::TubeCost cost = wing.cost;
  cost.Q.resize(4, 4);
  EXPECT_EQ(complaint([&] { controllers::TubeMpc(wing, sets, cost, {}, "p.c (trmpc)"); }),
            "p.c (trmpc): Q, R or the horizon do not fit the model");
  cost = wing.cost;
  cost.R *= -1.0;
  EXPECT_EQ(complaint([&] { controllers::TubeMpc(wing, sets, cost, {}, "p.c (trmpc)"); }),
            "p.c (trmpc): the Hessian of Q and R is not positive definite: weights are too far "
            "apart in size");
}

}  // namespace
}  // namespace vinerow::test::tube_mpc_test

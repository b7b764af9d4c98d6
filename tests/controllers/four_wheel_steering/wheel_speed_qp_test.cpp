// The velocity QP, corrected and as printed: reference cases, KKT conditions, what the print
// admits.

#include "controllers/four_wheel_steering/wheel_speed_qp.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "controllers/four_wheel_steering/wheel_speeds.h"
#include "engine/core/random.h"
#include "tests/controllers/four_wheel_steering/oracle.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::wheel_speed_qp_test {
namespace {

constexpr double kLimit_rad = 0.4014257279586958;  // 23 deg

TEST(WheelSpeedQp, GivesTheWheelSpeedsOfEveryReferenceCase) {
  controllers::WheelSpeedQp qp({});
  for (const OracleCase& row : kOracle) {
    ASSERT_EQ(qp.solve(controllers::calc_rolling({}, row.axles()), row.speed_mps),
              controllers::QpStatus::kSolved);
    for (int i = 0; i < controllers::kWheels; ++i) {
      EXPECT_NEAR(qp.rim_mps()[i] / 0.2, row.wheel_radps[i], 1e-4)
          << row.front_deg << " wheel " << i;
    }
  }
}

TEST(WheelSpeedQp, ChoosesTheRollingSpeedsWhereTheyAreAllowed) {
  RandomStream random(1, "test", "wheel_speed_qp");
  controllers::WheelSpeedQp qp({});
  int unsaturated = 0;
  for (int n = 0; n < 1000; ++n) {
    const AxleAngles axles{random.uniform(-kLimit_rad, kLimit_rad),
                           random.uniform(-kLimit_rad, kLimit_rad)};
    const double requested = random.uniform(-1.6, 1.6);
    const controllers::Rolling rolling = controllers::calc_rolling({}, axles);
    const double speed = controllers::limit_speed(rolling, requested, 1.6);
    unsaturated += speed == requested;
    ASSERT_EQ(qp.solve(rolling, speed), controllers::QpStatus::kSolved);
    const Eigen::Vector4d v = qp.rim_mps();
    EXPECT_LT((v - rolling.rim_mps(speed)).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_LT(qp.cost(v), 1e-15);
    EXPECT_LE(qp.slip_mps(v).cwiseAbs().maxCoeff(), 5e-3);
    EXPECT_LE(v.cwiseAbs().maxCoeff(), 1.6 + 1e-9);
  }
  EXPECT_GT(unsaturated, 700);
  EXPECT_LT(unsaturated, 1000);
}

/// Residuals of the optimality conditions, worked out from the statement of the problem with rows
/// and bounds written as eight two-sided limits; multipliers by least squares over the tight ones.
struct Kkt {
  double stationarity, sign, violation;
};
Kkt check_kkt(const controllers::Rolling& rolling, double speed, const Eigen::Vector4d& lower,
              const Eigen::Vector4d& upper, const Eigen::Vector4d& v) {
  const double eps = 5e-3, rho = 1e-3;
  const Eigen::Array4d c = rolling.wheel_rad.array().cos(), s = rolling.wheel_rad.array().sin();
  Eigen::Matrix<double, 8, 4> G;
  G << Eigen::Matrix4d::Identity(), Eigen::Matrix4d::Zero();
  G.row(4) << c[0], 0, -c[2], 0;
  G.row(5) << 0, c[1], 0, -c[3];
  G.row(6) << s[0], -s[1], 0, 0;
  G.row(7) << 0, 0, s[2], -s[3];
  Eigen::Matrix<double, 8, 1> low, high;
  low << lower, Eigen::Vector4d::Constant(-eps);
  high << upper, Eigen::Vector4d::Constant(eps);
  const Eigen::Vector4d alpha = rolling.reach.cwiseInverse(), v_rb = rolling.rim_mps(speed);
  const Eigen::Vector4d gradient =
      2.0 * (alpha.dot(v) - 4.0 * rolling.forward_mps(speed)) * alpha + 2.0 * rho * (v - v_rb);
  const Eigen::Matrix<double, 8, 1> value = G * v;
  // Non-negative least squares of gradient = -sum m_i g_i over the tight limits, by trying all
  // subsets of them: at most 2^8.
  std::vector<Eigen::Vector4d> tight;
  double violation = 0.0;
  for (int i = 0; i < 8; ++i) {
    violation = std::max({violation, low[i] - value[i], value[i] - high[i]});
    if (value[i] > high[i] - 1e-7) tight.push_back(G.row(i).transpose());
    if (value[i] < low[i] + 1e-7) tight.push_back(-G.row(i).transpose());
  }
  Kkt best{gradient.norm(), 0.0, violation};
  for (unsigned subset = 1; subset < (1u << tight.size()); ++subset) {
    Eigen::MatrixXd normals(4, 0);
    for (std::size_t i = 0; i < tight.size(); ++i) {
      if (!(subset >> i & 1u)) continue;
      normals.conservativeResize(4, normals.cols() + 1);
      normals.rightCols(1) = tight[i];
    }
    if (normals.cols() > 4) continue;
    const Eigen::VectorXd m = normals.colPivHouseholderQr().solve(-gradient);
    if (m.minCoeff() < -1e-9) continue;
    best.stationarity = std::min(best.stationarity, (gradient + normals * m).norm());
  }
  return best;
}

TEST(WheelSpeedQp, MeetsTheOptimalityConditionsWhereLimitsBind) {
  RandomStream random(2, "test", "wheel_speed_qp");
  controllers::WheelSpeedParams params;
  params.rim_change_max_mps = 0.04;
  controllers::WheelSpeedQp qp(params);
  int solved = 0, infeasible = 0, bound = 0;
  for (int n = 0; n < 2000; ++n) {
    const AxleAngles before{random.uniform(-kLimit_rad, kLimit_rad),
                            random.uniform(-kLimit_rad, kLimit_rad)};
    const AxleAngles axles{before.front_rad + random.uniform(-0.04, 0.04),
                           before.rear_rad + random.uniform(-0.04, 0.04)};
    const double speed_before = random.uniform(-1.2, 1.2);
    const double speed = speed_before + random.uniform(-0.1, 0.1);
    const Eigen::Vector4d last = controllers::calc_rolling({}, before).rim_mps(speed_before);
    const controllers::Rolling rolling = controllers::calc_rolling({}, axles);
    qp.set_last(last);
    const controllers::QpStatus status = qp.solve(rolling, speed);
    if (status == controllers::QpStatus::kInfeasible) {
      ++infeasible;
      continue;
    }
    ASSERT_EQ(status, controllers::QpStatus::kSolved);
    ++solved;
    const Eigen::Vector4d lower = (last.array() - 0.04).max(-1.6);
    const Eigen::Vector4d upper = (last.array() + 0.04).min(1.6);
    bound += (qp.rim_mps() - rolling.rim_mps(speed)).norm() > 1e-6;
    const Kkt kkt = check_kkt(rolling, speed, lower, upper, qp.rim_mps());
    EXPECT_LT(kkt.violation, 1e-8) << n;
    EXPECT_LT(kkt.stationarity, 1e-6) << n;
  }
  // The draw covers all three: free, at a limit, without solution.
  EXPECT_GT(solved - bound, 300);
  EXPECT_GT(bound, 300);
  RecordProperty("infeasible", infeasible);
}

TEST(WheelSpeedQp, AsPrintedAdmitsWheelsThatFightEachOther) {
  controllers::WheelSpeedParams params;
  params.form = controllers::WheelSpeedForm::kPrinted;
  controllers::WheelSpeedQp printed(params), right({});
  struct Case {
    AxleAngles axles;
    Eigen::Vector4d rim_mps;
    double cost;
  };
  // Section 3 of the reference page; the second case is given there to two digits.
  const Case cases[] = {{{0.0, 0.0}, {0.4, 0.4, 1.6, 1.6}, 1e-20},
                        {{rad_from_deg(15), 0.0}, {-0.62, 1.6, 1.6, 1.55}, 1e-4}};
  for (const Case& c : cases) {
    const controllers::Rolling rolling = controllers::calc_rolling({}, c.axles);
    ASSERT_EQ(printed.solve(rolling, 1.0), controllers::QpStatus::kSolved);
    EXPECT_LT(printed.cost(c.rim_mps), c.cost);
    // A v <= eps and |v_i| <= rim_max, as printed; two-sided it is refused.
    EXPECT_LE(printed.slip_mps(c.rim_mps).maxCoeff(), params.slip_mps);
    EXPECT_LE(c.rim_mps.cwiseAbs().maxCoeff(), params.rim_max_mps);
    ASSERT_EQ(right.solve(rolling, 1.0), controllers::QpStatus::kSolved);
    EXPECT_GT(right.slip_mps(c.rim_mps).cwiseAbs().maxCoeff(), params.slip_mps + 1e-3);
  }
}

TEST(WheelSpeedQp, AsPrintedSlipsInATurn) {
  controllers::WheelSpeedParams params;
  params.form = controllers::WheelSpeedForm::kPrinted;
  controllers::WheelSpeedQp qp(params);
  for (const double side : {1.0, -1.0}) {
    const controllers::Rolling rolling =
        controllers::calc_rolling({}, {side * kLimit_rad, -side * kLimit_rad});
    ASSERT_EQ(qp.solve(rolling, 0.8), controllers::QpStatus::kSolved);
    EXPECT_LT(qp.cost(qp.rim_mps()), 1e-8);
    // The commands of the inner wheels are as fast as those of the outer ones, or faster.
    EXPECT_GT(qp.slip_mps(qp.rim_mps()).cwiseAbs().maxCoeff(), 0.1);
  }
}

TEST(WheelSpeedQp, TellsWhenAJumpOfTheAxlesLeavesNoSolution) {
  controllers::WheelSpeedParams params;
  params.rim_change_max_mps = 0.01;
  controllers::WheelSpeedQp qp(params);
  qp.set_last(Eigen::Vector4d::Ones());
  ASSERT_EQ(qp.solve(controllers::calc_rolling({}, {0.0, 0.0}), 1.0),
            controllers::QpStatus::kSolved);
  // sin(29.2 deg) v_l - sin(18.9 deg) v_r = 0 wants v_r = 1.51 v_l; +-0.01 around 1 cannot.
  EXPECT_EQ(qp.solve(controllers::calc_rolling({}, {kLimit_rad, -kLimit_rad}), 0.8),
            controllers::QpStatus::kInfeasible);
}

TEST(WheelSpeedQp, AllocatesNothing) {
  controllers::WheelSpeedParams params;
  params.rim_change_max_mps = 0.02;
  controllers::WheelSpeedQp qp(params);
  std::size_t allocations = 1;
  {
    AllocationCounter counter;
    for (int i = 0; i < 200; ++i) {
      const double angle = kLimit_rad * std::sin(0.05 * i);
      qp.set_last(controllers::calc_rolling({}, {angle, -angle}).rim_mps(0.5));
      qp.solve(controllers::calc_rolling({}, {angle + 0.01, -angle}), 0.6);
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

TEST(WheelSpeeds, StopsSafelyWithoutASolutionAndStaysStopped) {
  controllers::WheelSpeedsParams params;
  params.qp.rim_change_max_mps = 0.01;
  controllers::WheelSpeeds wheels(params);
  const controllers::Rolling straight = controllers::calc_rolling({}, {}),
                             bent = controllers::calc_rolling({}, {kLimit_rad, -kLimit_rad});
  for (int i = 1; i <= 100; ++i) wheels.update(straight, 0.01 * i);
  ASSERT_FALSE(wheels.has_failed());
  ASSERT_NEAR(wheels.rim_mps()[0], 1.0, 1e-6);
  wheels.update(bent, 0.8);
  EXPECT_EQ(wheels.status(), controllers::QpStatus::kInfeasible);
  double last = 1.0;
  for (int i = 0; i < 99; ++i) {
    const double rim = wheels.rim_mps()[0];
    EXPECT_NEAR(last - rim, 0.5 * 0.02, 1e-9);  // stop_mps2 over one cycle
    EXPECT_NEAR(wheels.rim_mps()[3], rim, 1e-9);
    last = rim;
    wheels.update(straight, 1.0);
  }
  wheels.update(straight, 1.0);
  EXPECT_TRUE(wheels.rim_mps().isZero(0.0));
  wheels.update(straight, 1.0);
  EXPECT_TRUE(wheels.rim_mps().isZero(0.0));
  EXPECT_TRUE(wheels.has_failed());
}

TEST(WheelSpeeds, TurnEveryWheelAlikeWhenAskedTo) {
  controllers::WheelSpeedsParams params;
  params.rule = controllers::SpeedRule::kEqual;
  controllers::WheelSpeeds wheels(params);
  wheels.update(controllers::calc_rolling({}, {kLimit_rad, -kLimit_rad}), 0.8);
  EXPECT_EQ(wheels.rim_mps(), Eigen::Vector4d::Constant(0.8));
}

}  // namespace
}  // namespace vinerow::test::wheel_speed_qp_test

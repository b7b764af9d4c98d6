// The law of the error-state filter: closed forms, gradients by differences, late and bad data.

#include "controllers/estimation/inertial/error_state_kalman.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "controllers/estimation/inertial/navigation_measurements.h"
#include "tests/controllers/estimation/inertial/imu_course.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::error_state_kalman_test {
namespace {

using I = controllers::ErrorIndex;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t k10ms = 10'000'000;

controllers::ErrorStateKalmanParams noiseless() {
  controllers::ErrorStateKalmanParams params;
  params.imu = {0, 0, 0, 0};
  return params;
}

controllers::ErrorCovariance diagonal(double position, double velocity, double attitude,
                                      double gyro, double accel) {
  controllers::ErrorVector std;
  std << Vector3d::Constant(position), Vector3d::Constant(velocity), Vector3d::Constant(attitude),
      Vector3d::Constant(gyro), Vector3d::Constant(accel);
  return std.cwiseAbs2().asDiagonal();
}

/// Follows a course without noise from its own state to `to_s`.
void follow(controllers::ErrorStateKalman& filter, const ImuCourse& course, double to_s,
            std::int64_t period_ns) {
  for (std::int64_t i = filter.time().ns / period_ns; tick_at(i, period_ns).s() <= to_s + 1e-9;
       ++i) {
    const Time now = tick_at(i, period_ns);
    if (now < filter.time()) continue;
    const CoursePoint point = course.at(now.s());
    filter.predict(now, point.w_B, point.f_B);
  }
}

double integration_error_m(std::int64_t period_ns) {
  controllers::ErrorStateKalman filter(noiseless());
  filter.start(Time{}, circle().at(0.0).state, diagonal(1, 1, 1, 1, 1));
  follow(filter, circle(), 20.0, period_ns);
  EXPECT_NEAR(filter.time().s(), 20.0, 1e-9);
  return (filter.state().p_WI - circle().at(20.0).state.p_WI).norm();
}

TEST(ErrorStateKalman, KeepsToACircleWithAPerfectUnitToTheSecondOrder) {
  const double coarse = integration_error_m(2 * k10ms), fine = integration_error_m(k10ms);
  EXPECT_LT(fine, 0.01);
  EXPECT_GT(fine, 1e-7) << "too good to tell an order";
  EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

TEST(ErrorStateKalman, RestsForEver) {
  controllers::ErrorStateKalman filter(noiseless());
  controllers::NavState state;
  state.q_WB = quaternion_from_rpy({0.2, -0.3, 1.0});
  filter.start(Time{}, state, diagonal(1, 1, 1, 1, 1));
  const Vector3d f_B = state.q_WB.conjugate() * Vector3d(0, 0, kGravity_mps2);
  for (int i = 0; i <= 60'000; ++i) filter.predict(tick_at(i, k10ms), Vector3d::Zero(), f_B);
  EXPECT_LT(filter.state().p_WI.norm(), 1e-6);
}

TEST(ErrorStateKalman, PropagatesErrorsAsDifferencesOfItsOwnMotionDo) {
  const ImuCourse course = lively_course();
  const auto run = [&](const controllers::NavState& start, const controllers::ErrorCovariance& P) {
    controllers::ErrorStateKalman filter(noiseless());
    filter.start(Time{}, start, P);
    follow(filter, course, 1.0, k10ms);
    return filter;
  };
  const controllers::NavState start = course.at(0.0).state;
  const controllers::ErrorStateKalman nominal =
      run(start, controllers::ErrorCovariance::Identity());
  controllers::ErrorCovariance F;
  const double step = 1e-5;
  for (int i = 0; i < I::kCount; ++i) {
    const controllers::ErrorVector dx = step * controllers::ErrorVector::Unit(i);
    F.col(i) =
        (run(start.plus(dx), controllers::ErrorCovariance::Identity())
             .state()
             .minus(run(start.plus(-dx), controllers::ErrorCovariance::Identity()).state())) /
        (2.0 * step);
  }
  const controllers::ErrorCovariance expected = F * F.transpose();
  for (int i = 0; i < I::kCount; ++i) {
    for (int j = 0; j < I::kCount; ++j) {
      const double scale = std::sqrt(expected(i, i) * expected(j, j));
      EXPECT_NEAR(nominal.covariance()(i, j), expected(i, j), 1e-4 * scale) << i << ' ' << j;
    }
  }
}

TEST(ErrorTransition, BackAndForthIsNothing) {
  const Matrix3d R = quaternion_from_rpy({0.3, 0.2, -1}).toRotationMatrix();
  const Vector3d f(1, -2, 9);
  const controllers::ErrorCovariance both = controllers::ErrorTransition(R, f, 0.3).matrix() *
                                            controllers::ErrorTransition(R, f, -0.3).matrix();
  EXPECT_LT((both - controllers::ErrorCovariance::Identity()).cwiseAbs().maxCoeff(), 1e-14);
}

/// Rest, level: heights are a chain of three (height, speed, accelerometer bias), fixes every 0.2
/// s.
TEST(ErrorStateKalman, SettlesAtTheRiccatiEquationsCovariance) {
  controllers::ErrorStateKalmanParams params;
  params.imu = {1e-3, 0.02, 1e-5, 0.01};
  const double sigma_m = 0.5, T = 0.2;
  controllers::ErrorStateKalman filter(params);
  filter.start(Time{}, {}, diagonal(1, 0.5, 0.02, 0.001, 0.05));
  for (int i = 0; i <= 40'000; ++i) {
    filter.predict(tick_at(i, k10ms / 2), Vector3d::Zero(), {0, 0, kGravity_mps2});
    if (i % 40 == 0 && i > 0) {
      const controllers::VectorMeasurement fix = controllers::place_measurement(
          filter.past(filter.time()), Vector3d::Zero(), filter.state().p_WI);
      ASSERT_TRUE(
          filter.correct_vector(fix.innovation, fix.H, Vector3d::Constant(sigma_m * sigma_m), 5)
              .used());
    }
  }
  // An independent way: exact noise over a period, structure-preserving doubling for the equation
  // (E. Chu et al., "A structure-preserving doubling algorithm for periodic discrete-time algebraic
  // Riccati equations", 2004).
  const double q = 0.02 * 0.02, s = 0.01 * 0.01;
  Matrix3d F, Q;
  F << 1, T, -0.5 * T * T, 0, 1, -T, 0, 0, 1;
  Q << q * T * T * T / 3 + s * std::pow(T, 5) / 20, q * T * T / 2 + s * std::pow(T, 4) / 8,
      -s * T * T * T / 6, 0, q * T + s * T * T * T / 3, -s * T * T / 2, 0, 0, s * T;
  Q = Matrix3d(Q.selfadjointView<Eigen::Upper>());
  Matrix3d A = F.transpose(), G = Matrix3d::Zero(), X = Q;
  G(0, 0) = 1.0 / (sigma_m * sigma_m);
  for (int i = 0; i < 30; ++i) {
    const Matrix3d W = (Matrix3d::Identity() + G * X).inverse();
    const Matrix3d A_next = A * W * A;
    const Matrix3d G_next = G + A * W * G * A.transpose();
    X += A.transpose() * X * W * A;
    A = A_next;
    G = G_next;
  }
  const Vector3d h(1, 0, 0);
  const Matrix3d after = X - X * h * h.transpose() * X / (h.dot(X * h) + sigma_m * sigma_m);
  const int rows[] = {I::kPosition + 2, I::kVelocity + 2, I::kAccelBias + 2};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(filter.covariance()(rows[i], rows[j]), after(i, j),
                  1e-3 * std::sqrt(after(i, i) * after(j, j)))
          << i << ' ' << j;
    }
  }
}

TEST(ErrorStateKalman, LosesItsHeadingAtRestAsTheGyroTells) {
  controllers::ErrorStateKalmanParams params;
  params.imu = {2e-3, 0, 1e-4, 0};
  controllers::ErrorStateKalman filter(params);
  filter.start(Time{}, {}, diagonal(1, 1, 0.05, 0.003, 0.1));
  for (int i = 0; i <= 6000; ++i) {
    filter.predict(tick_at(i, k10ms), Vector3d::Zero(), {0, 0, kGravity_mps2});
  }
  const double t = 60.0;
  const double expected =
      0.05 * 0.05 + std::pow(0.003 * t, 2) + 2e-3 * 2e-3 * t + 1e-4 * 1e-4 * t * t * t / 3;
  EXPECT_NEAR(filter.covariance()(8, 8), expected, 1e-3 * expected);
}

/// What a function of the state measures less what it should, at a state with error dx.
template <class Measure>
void check_gradient(const Measure& measure, double tolerance) {
  controllers::NavState state;
  state.p_WI = {3, -2, 1};
  state.v_WI = {1.2, -0.4, 0.3};
  state.q_WB = quaternion_from_rpy({0.2, -0.1, 0.8});
  const Vector3d reading_B(0.3, -0.2, 0.5);
  const auto at = [&](const controllers::ErrorVector& dx) {
    const controllers::NavState s = state.plus(dx);
    controllers::PastState past;
    past.p_WI = s.p_WI;
    past.v_WI = s.v_WI;
    past.q_WB = s.q_WB;
    past.w_B = reading_B - s.gyro_bias_B;
    return measure(past, reading_B, s);
  };
  const auto nominal = at(controllers::ErrorVector::Zero());
  const double step = 1e-6;
  for (int i = 0; i < I::kCount; ++i) {
    const controllers::ErrorVector dx = step * controllers::ErrorVector::Unit(i);
    const decltype(nominal.innovation) gradient =
        (at(dx).innovation - at(-dx).innovation) / (-2.0 * step);
    if constexpr (std::is_same_v<decltype(nominal), const controllers::ScalarMeasurement>) {
      EXPECT_NEAR(gradient, nominal.H[i], tolerance) << i;
    } else {
      EXPECT_LT((gradient - nominal.H.col(i)).norm(), tolerance) << i;
    }
  }
}

TEST(NavigationMeasurements, HaveTheGradientsOfTheirDifferences) {
  const Vector3d arm(0.4, -0.3, 0.2), z(1, 2, 3);
  check_gradient(
      [&](const controllers::PastState& p, const Vector3d&, const controllers::NavState&) {
        return controllers::place_measurement(p, arm, z);
      },
      1e-8);
  check_gradient(
      [&](const controllers::PastState& p, const Vector3d&, const controllers::NavState&) {
        return controllers::velocity_measurement(p, arm, z);
      },
      1e-8);
  check_gradient(
      [&](const controllers::PastState& p, const Vector3d&, const controllers::NavState&) {
        return controllers::body_velocity_measurement(p, arm, z);
      },
      1e-8);
  check_gradient(
      [&](const controllers::PastState& p, const Vector3d&, const controllers::NavState&) {
        return controllers::height_measurement(p, arm, 2.0);
      },
      1e-8);
  check_gradient(
      [&](const controllers::PastState& p, const Vector3d&, const controllers::NavState&) {
        return controllers::magnetic_measurement(p, Vector3d(2e-5, 1e-5, -4e-5), 1.2);
      },
      1e-8);
  check_gradient(
      [&](const controllers::PastState& p, const Vector3d&, const controllers::NavState&) {
        return controllers::direction_measurement(p, arm, z);
      },
      1e-8);
  check_gradient(
      [&](const controllers::PastState&, const Vector3d& w, const controllers::NavState& s) {
        return controllers::stationary_rate_measurement(w, s.gyro_bias_B);
      },
      1e-8);
}

TEST(NavigationMeasurements, TellHowAPlaceAndTheHeadingDependOnTheErrors) {
  controllers::NavState state;
  state.q_WB = quaternion_from_rpy({0.3, -0.4, 2.0});
  const Vector3d arm(0.5, 0.2, -0.1), g(0.3, -0.8, 0.5);
  const double step = 1e-6, turn = 0.7;
  const controllers::ErrorRow row = controllers::pose_row(state.q_WB, arm, g, turn),
                              heading = controllers::heading_row(state.q_WB);
  for (int i = 0; i < I::kCount; ++i) {
    const controllers::NavState more = state.plus(step * controllers::ErrorVector::Unit(i)),
                                less = state.plus(-step * controllers::ErrorVector::Unit(i));
    const double place = g.dot(more.p_WI + more.q_WB * arm - less.p_WI - less.q_WB * arm);
    const double turned = i == I::kAttitude + 2 ? turn : 0.0;
    EXPECT_NEAR(row[i], place / (2 * step) + turned, 1e-8) << i;
    EXPECT_NEAR(heading[i],
                (yaw_from_quaternion(more.q_WB) - yaw_from_quaternion(less.q_WB)) / (2 * step),
                1e-8)
        << i;
  }
}

TEST(ErrorStateKalman, ResetsTheCovarianceToTheCorrectedAttitude) {
  // A large correction of the attitude alone: afterwards errors are counted from the new attitude,
  // whose difference quotient gives the same matrix.
  controllers::ErrorStateKalman filter(noiseless());
  controllers::ErrorCovariance P = diagonal(1, 1, 0.3, 0.01, 0.01);
  P(6, 7) = P(7, 6) = 0.03;
  filter.start(Time{}, {}, P);
  controllers::ErrorStateKalman::Rows3 H = controllers::ErrorStateKalman::Rows3::Zero();
  H.middleCols<3>(I::kAttitude).setIdentity();
  const Vector3d innovation(0.1, -0.2, 0.15), R = Vector3d::Constant(0.04);
  ASSERT_TRUE(filter.correct_vector(innovation, H, R, 5).used());

  const Matrix3d prior = P.block<3, 3>(6, 6);
  const Matrix3d S = prior + Matrix3d(R.asDiagonal());
  const Matrix3d posterior = prior - prior * S.inverse() * prior;
  const Vector3d turn = prior * S.inverse() * innovation;
  EXPECT_LT((controllers::log_rotation(filter.state().q_WB) - turn).norm(), 1e-12);
  Matrix3d G;
  for (int i = 0; i < 3; ++i) {
    const double step = 1e-6;
    const auto error = [&](double e) {
      return controllers::log_rotation(controllers::exp_rotation(turn + e * Vector3d::Unit(i)) *
                                       controllers::exp_rotation(-turn));
    };
    G.col(i) = (error(step) - error(-step)) / (2 * step);
  }
  const Matrix3d expected = G * posterior * G.transpose();
  // The filter's G is of first order in the turn: what is left is |turn|^2 / 6.
  EXPECT_LT((filter.covariance().block<3, 3>(6, 6) - expected).norm() / expected.norm(),
            turn.squaredNorm() / 3.0);
  EXPECT_GT((posterior - expected).norm() / expected.norm(), turn.squaredNorm() / 3.0)
      << "a filter without reset would pass";
}

TEST(ErrorStateKalman, TakesThreeAtOnceAsTheTextbookDoes) {
  controllers::ErrorStateKalman filter(noiseless());
  RandomStream random(1, "test", "matrices");
  const auto draw = [&](Eigen::Index, Eigen::Index) { return random.uniform(-1, 1); };
  const controllers::ErrorCovariance A = controllers::ErrorCovariance::NullaryExpr(draw);
  const controllers::ErrorCovariance P = A * A.transpose() * 0.01;
  filter.start(Time{}, {}, P);
  controllers::ErrorStateKalman::Rows3 H = controllers::ErrorStateKalman::Rows3::NullaryExpr(draw);
  H.middleCols<3>(I::kAttitude).setZero();
  const Vector3d y(0.05, -0.03, 0.02), R(0.1, 0.2, 0.3);
  const Matrix3d S = H * P * H.transpose() + Matrix3d(R.asDiagonal());
  const controllers::ErrorCovariance posterior = P - P * H.transpose() * S.inverse() * H * P;
  const controllers::ErrorVector dx = P * H.transpose() * S.inverse() * y;
  const controllers::Correction correction = filter.correct_vector(y, H, R, 5);
  ASSERT_TRUE(correction.used());
  EXPECT_NEAR(correction.nis, y.dot(S.inverse() * y), 1e-12);
  EXPECT_LT((filter.state().minus({}) - dx).norm(), 1e-12);
  // All but the attitude's part, which the reset turns.
  const controllers::ErrorCovariance rest = filter.covariance() - posterior;
  const double corners =
      (rest.topLeftCorner<6, 6>().norm()) + (rest.bottomRightCorner<6, 6>().norm());
  EXPECT_LT(corners, 1e-12 * posterior.norm());
}

TEST(ErrorStateKalman, GatesWhatIsTooFar) {
  controllers::ErrorStateKalman filter(noiseless());
  filter.start(Time{}, {}, diagonal(0.3, 1, 1, 1, 1));
  const controllers::ErrorRow H = controllers::ErrorRow::Unit(0);
  // Variance 0.09 + 0.16: one sigma is 0.5 m.
  const controllers::Correction far = filter.correct_scalar(1.76, H, 0.16, 3.5);
  EXPECT_EQ(far.verdict, controllers::Correction::Verdict::kGated);
  EXPECT_NEAR(far.nis, 1.76 * 1.76 / 0.25, 1e-9);
  EXPECT_EQ(filter.state().p_WI, Vector3d::Zero().eval());
  EXPECT_EQ(filter.covariance()(0, 0), 0.09);
  const controllers::Correction near = filter.correct_scalar(1.74, H, 0.16, 3.5);
  EXPECT_TRUE(near.used());
  EXPECT_NEAR(filter.state().p_WI.x(), 1.74 * 0.09 / 0.25, 1e-12);
  EXPECT_NEAR(filter.covariance()(0, 0), 0.09 * 0.16 / 0.25, 1e-12);
}

/// Fixes every 50 ms that come `late_ticks` later; the estimate at the end.
controllers::ErrorStateKalman run_with_late_fixes(int late_ticks, bool compensated) {
  const ImuCourse course = lively_course();
  controllers::ErrorStateKalman filter{controllers::ErrorStateKalmanParams{}};
  controllers::NavState start = course.at(0.0).state;
  start.p_WI += Vector3d(0.5, -0.4, 0.3);
  start.v_WI += Vector3d(0.2, 0.1, -0.1);
  filter.start(Time{}, start, diagonal(0.5, 0.2, 0.02, 0.001, 0.02));
  RandomStream random(5, "test", "fixes");
  for (int i = 0; i <= 3000; ++i) {
    const Time now = tick_at(i, k10ms);
    const CoursePoint point = course.at(now.s());
    filter.predict(now, point.w_B, point.f_B);
    const Time measured = tick_at(i - late_ticks, k10ms);
    if (i % 5 != 0 || measured.ns < 0 || i > 2950 + late_ticks) continue;
    const Vector3d z = course.at(measured.s()).state.p_WI + 0.1 * normal3(random);
    const Time seen = compensated ? measured : now;
    const controllers::VectorMeasurement fix =
        controllers::place_measurement(filter.past(seen), Vector3d::Zero(), z);
    filter.correct_vector(fix.innovation, filter.at_age(fix.H, (now - seen).s()),
                          Vector3d::Constant(0.01), 50);
  }
  return filter;
}

TEST(ErrorStateKalman, TakesLateFixesAsIfTheyHadComeAtOnce) {
  const controllers::ErrorStateKalman prompt = run_with_late_fixes(0, true);
  const controllers::ErrorStateKalman late = run_with_late_fixes(20, true);
  const controllers::ErrorStateKalman naive = run_with_late_fixes(20, false);
  const double sigma = std::sqrt(prompt.covariance()(0, 0));
  EXPECT_LT((late.state().p_WI - prompt.state().p_WI).norm(), 0.3 * sigma);
  EXPECT_NEAR(std::sqrt(late.covariance()(0, 0)) / sigma, 1.0, 0.05);
  EXPECT_GT((naive.state().p_WI - prompt.state().p_WI).norm(), 5.0 * sigma);
}

TEST(ErrorStateKalman, RefusesBadReadingsAndCountsThem) {
  controllers::ErrorStateKalman filter(noiseless());
  const Vector3d none = Vector3d::Zero(), up(0, 0, kGravity_mps2);
  EXPECT_FALSE(filter.predict(Time{}, none, up)) << "not started";
  filter.start(Time{}, {}, diagonal(1, 1, 1, 1, 1));
  EXPECT_TRUE(filter.predict(Time{}, none, up));
  EXPECT_TRUE(filter.predict(Time{k10ms}, none, up));
  EXPECT_FALSE(filter.predict(Time{k10ms}, none, up)) << "twice";
  EXPECT_FALSE(filter.predict(Time{5}, none, up)) << "backwards";
  EXPECT_FALSE(filter.predict(Time{2 * k10ms}, {0, kNaN, 0}, up));
  EXPECT_FALSE(filter.predict(Time{2 * k10ms}, none, {0, 0, 1e30}));
  EXPECT_EQ(filter.refused_readings(), 5);
  EXPECT_EQ(filter.time(), Time{k10ms});
  EXPECT_TRUE(filter.predict(Time{3 * k10ms}, none, up));
  EXPECT_EQ(filter.gaps(), 0);
  EXPECT_TRUE(filter.predict(Time{103 * k10ms}, none, up));
  EXPECT_EQ(filter.gaps(), 1);

  const controllers::ErrorRow H = controllers::ErrorRow::Unit(0);
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(filter.correct_scalar(bad, H, 1, 5).verdict,
              controllers::Correction::Verdict::kInvalid);
    EXPECT_EQ(filter.correct_scalar(0.1, H, bad, 5).verdict,
              controllers::Correction::Verdict::kInvalid);
    EXPECT_EQ(filter.correct_scalar(0.1, bad * H, 1, 5).verdict,
              controllers::Correction::Verdict::kInvalid);
  }
  EXPECT_EQ(filter.correct_scalar(0.1, H, -1, 5).verdict,
            controllers::Correction::Verdict::kInvalid);
  EXPECT_TRUE(filter.state().is_finite());
}

TEST(ErrorStateKalman, GetsOverACovarianceThatIsNone) {
  const ImuCourse course = lively_course();
  for (const int kind : {0, 1, 2}) {
    controllers::ErrorCovariance P = diagonal(0.5, 0.2, 0.02, 0.001, 0.02);
    if (kind == 0) P(0, 1) = P(1, 0) = 0.3;  // correlation 1.2
    if (kind == 1) P(3, 3) = -0.1;
    if (kind == 2) P(7, 7) = kNaN;
    controllers::ErrorStateKalman filter{controllers::ErrorStateKalmanParams{}};
    controllers::NavState start = course.at(0.0).state;
    start.p_WI.x() += 0.4;
    filter.start(Time{}, start, P);
    for (int i = 0; i <= 6000; ++i) {
      const Time now = tick_at(i, k10ms);
      const CoursePoint point = course.at(now.s());
      filter.predict(now, point.w_B, point.f_B);
      if (i % 20 != 0) continue;
      const controllers::VectorMeasurement fix =
          controllers::place_measurement(filter.past(now), Vector3d::Zero(), point.state.p_WI);
      filter.correct_vector(fix.innovation, fix.H, Vector3d::Constant(0.01), 50);
    }
    EXPECT_GE(filter.repairs(), 1) << kind;
    EXPECT_LE(filter.repairs(), 3) << kind;
    ASSERT_TRUE(filter.state().is_finite()) << kind;
    EXPECT_LT((filter.state().p_WI - course.at(60.0).state.p_WI).norm(), 0.1) << kind;
    EXPECT_GT(controllers::ErrorCovariance(filter.covariance()).llt().matrixL().determinant(), 0.0);
  }
}

TEST(ErrorStateKalman, ComesBackAfterAMinuteWithoutReadings) {
  const ImuCourse course = circle();
  controllers::ErrorStateKalman filter{controllers::ErrorStateKalmanParams{}};
  filter.start(Time{}, course.at(0.0).state, diagonal(0.1, 0.05, 0.01, 0.001, 0.01));
  int used = 0;
  for (int i = 0; i <= 18'000; ++i) {
    const Time now = tick_at(i, k10ms);
    const CoursePoint point = course.at(now.s());
    const bool silent = i > 3000 && i < 9000;
    if (!silent) filter.predict(now, point.w_B, point.f_B);
    if (silent || i % 20 != 0) continue;
    const controllers::VectorMeasurement fix =
        controllers::place_measurement(filter.past(now), Vector3d::Zero(), point.state.p_WI);
    used += filter.correct_vector(fix.innovation, fix.H, Vector3d::Constant(0.01), 5).used();
  }
  EXPECT_EQ(filter.gaps(), 1);
  EXPECT_GT(used, 590);
  EXPECT_LT((filter.state().p_WI - course.at(180.0).state.p_WI).norm(), 0.2);
}

TEST(ErrorStateKalman, AllocatesNothing) {
  controllers::ErrorStateKalman filter{controllers::ErrorStateKalmanParams{}};
  const ImuCourse course = lively_course();
  std::size_t allocations = 0;
  {
    AllocationCounter counter;
    filter.start(Time{}, course.at(0.0).state, diagonal(0.5, 0.2, 0.02, 0.001, 0.02));
    follow(filter, course, 3.0, k10ms);
    const controllers::VectorMeasurement fix = controllers::place_measurement(
        filter.past(Time{290 * k10ms}), Vector3d::Ones(), Vector3d::Zero());
    filter.correct_vector(fix.innovation, filter.at_age(fix.H, 0.1), Vector3d::Ones(), 50);
    filter.correct_scalar(0.1, controllers::ErrorRow::Unit(3), 0.1, 5);
    filter.coast(Time{400 * k10ms});
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace vinerow::test::error_state_kalman_test

// A receiver whose fixes state how good they are, and change between centimetres and decimetres.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "controllers/estimation/row_localisation/map_localisation_law.h"
#include "engine/core/random.h"
#include "tests/controllers/estimation/row_localisation/wall_map.h"

namespace vinerow::test::receiver_modes_test {
namespace {

constexpr double kTick_s = 0.01, kShare = 0.8, kWalkTime_s = 60.0;
constexpr int kFixed = 4, kFloat = 3;

Time tick_time(int tick) {
  return Time{static_cast<std::int64_t>(tick) * 10'000'000};
}

/// What a receiver's mode does to its fixes: kShare of the variance is Gauss-Markov, the rest
/// white; each mode has a process of its own.
class Receiver {
 public:
  Receiver(double std_m, RandomStream& random) : std_m_(std_m) {
    for (int i = 0; i < 3; ++i) slow_[i] = random.normal();
  }
  double std_m() const { return std_m_; }
  Eigen::Vector3d error(double step_s, RandomStream& random) {
    const double decay = std::exp(-step_s / kWalkTime_s);
    Eigen::Vector3d error;
    for (int i = 0; i < 3; ++i) {
      slow_[i] = decay * slow_[i] + std::sqrt(1.0 - decay * decay) * random.normal();
      error[i] =
          std_m_ * (std::sqrt(kShare) * slow_[i] + std::sqrt(1.0 - kShare) * random.normal());
    }
    return error;
  }

 private:
  double std_m_;
  Eigen::Vector3d slow_;
};

struct Outcome {
  double nees = 0.0;  // of the horizontal error, expectation 2
  double error_m = 0.0;
};

Outcome judge(const controllers::MapLocalisationLaw& law) {
  const Eigen::Vector2d e = law.state().p_W().head<2>();
  const Eigen::Matrix2d P = law.position_covariance().topLeftCorner<2, 2>();
  return {e.dot(P.inverse() * e), e.norm()};
}

/// Standing at W's origin on fixes and a drifting velocity alone: 20 s fixed, 20 s float, 20 s
/// fixed. @returns how it is at the end of each
std::array<Outcome, 3> stand(const controllers::MapLocalisationParams& params, std::uint64_t seed) {
  const RowMap map = make_wall_map({});
  const controllers::RowMeshIndex index(map);
  controllers::MapLocalisationLaw law(params, map, index, {});
  RandomStream random(seed, "rover", "receiver");
  Receiver fixed(0.01, random), floating(0.3, random);
  const controllers::SlowError& drift = params.noise.velocity_mps;
  const double decay = std::exp(-kTick_s / drift.time_s);
  Eigen::Vector3d velocity_error = Eigen::Vector3d::Zero(), start = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    velocity_error[i] = drift.std * random.normal();
    start[i] = 0.1 * random.normal();
  }
  law.start(tick_time(0), start, 0.01 * Eigen::Matrix3d::Identity());
  std::array<Outcome, 3> outcomes;
  for (int tick = 0; tick < 6000; ++tick) {
    for (int i = 0; i < 3; ++i) {
      velocity_error[i] =
          decay * velocity_error[i] + std::sqrt(1.0 - decay * decay) * drift.std * random.normal();
    }
    law.predict(tick_time(tick), velocity_error, Eigen::Quaterniond::Identity());
    if (tick % 20 == 0) {
      const bool is_float = tick / 2000 == 1;
      Receiver& receiver = is_float ? floating : fixed;
      // Both run on while the other one rules.
      const Eigen::Vector3d of_fixed = fixed.error(20 * kTick_s, random),
                            of_float = floating.error(20 * kTick_s, random);
      law.correct_fix(tick_time(tick), is_float ? of_float : of_fixed,
                      Eigen::Vector3d::Constant(receiver.std_m()), Eigen::Vector3d::Zero(),
                      is_float ? kFloat : kFixed);
    }
    if (tick % 2000 == 1999) outcomes[tick / 2000] = judge(law);
  }
  return outcomes;
}

controllers::MapLocalisationParams stating() {
  controllers::MapLocalisationParams params;
  params.fix_slow_share = kShare;
  params.noise.velocity_density_m_rts = 1e-6;
  params.noise.fix_horizontal_m.time_s = params.noise.fix_vertical_m.time_s = kWalkTime_s;
  return params;
}

TEST(ReceiverModes, CentimetresAreTakenDecimetresAreNotBelieved) {
  constexpr int kSeeds = 200;
  // Means of 200 chi-squares of 2 degrees: standard deviation 2 / sqrt(200), four of them.
  const double spread = 4.0 * 2.0 / std::sqrt(static_cast<double>(kSeeds));
  std::array<double, 3> nees{}, squares{}, without{};
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto outcomes = stand(stating(), static_cast<std::uint64_t>(seed));
    // A receiver of 0.7 m of slow error, as without.
    controllers::MapLocalisationParams plain = stating();
    plain.fix_slow_share = 0.0;
    const auto others = stand(plain, static_cast<std::uint64_t>(seed));
    for (int i = 0; i < 3; ++i) {
      nees[i] += outcomes[i].nees / kSeeds;
      squares[i] += outcomes[i].error_m * outcomes[i].error_m / kSeeds;
      without[i] += others[i].error_m * others[i].error_m / kSeeds;
    }
  }
  std::printf(
      "rms fixed %.4f, float %.4f, fixed %.4f m (without %.4f, %.4f, %.4f), NEES %.2f, "
      "%.2f, %.2f\n",
      std::sqrt(squares[0]), std::sqrt(squares[1]), std::sqrt(squares[2]), std::sqrt(without[0]),
      std::sqrt(without[1]), std::sqrt(without[2]), nees[0], nees[1], nees[2]);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(nees[i], 2.0, spread) << "at the end of stretch " << i;
  // Fixed: no worse than the fixes' own two axes, but for four standard deviations of such an rms.
  const double fixes_m = 0.01 * std::sqrt(2.0) * (1.0 + 4.0 / std::sqrt(4.0 * kSeeds));
  EXPECT_LT(std::sqrt(squares[0]), fixes_m);
  EXPECT_LT(std::sqrt(squares[2]), fixes_m);
  // Float: dead reckoning from the last centimetre is better than the fix of 0.3 m for a while,
  // and no worse than it after that.
  EXPECT_LT(std::sqrt(squares[1]), 0.3 * std::sqrt(2.0));
}

TEST(ReceiverModes, TheSlowErrorGrowsWithTheDilution) {
  controllers::LocalisationState state;
  controllers::LocalisationNoise noise;
  noise.fix_horizontal_m = {0.01, 60.0};
  noise.fix_vertical_m = {0.02, 60.0};
  state.start(noise, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  controllers::LocalisationState::Vector h = controllers::LocalisationState::Vector::Zero();
  h[controllers::LocalisationState::kPosition] = h[controllers::LocalisationState::kFix] = 1.0;
  ASSERT_TRUE(state.correct(h, 0.02, 1e-4));
  const auto before = state;
  state.set_fix_error({0.03, 60.0}, {0.02, 60.0}, false);
  constexpr int kPosition = controllers::LocalisationState::kPosition,
                kFix = controllers::LocalisationState::kFix;
  EXPECT_NEAR(state.x()[kFix], 3.0 * before.x()[kFix], 1e-15);
  EXPECT_NEAR(state.covariance()(kFix, kFix), 9.0 * before.covariance()(kFix, kFix), 1e-15);
  EXPECT_NEAR(state.covariance()(kFix, kPosition), 3.0 * before.covariance()(kFix, kPosition),
              1e-15);
  EXPECT_EQ(state.x()[kPosition], before.x()[kPosition]);
  // Of another mode nothing is known but its size.
  state.set_fix_error({0.25, 60.0}, {0.4, 60.0}, true);
  EXPECT_EQ(state.x()[kFix], 0.0);
  EXPECT_EQ(state.covariance()(kFix, kPosition), 0.0);
  EXPECT_DOUBLE_EQ(state.covariance()(kFix, kFix), 0.25 * 0.25);
  EXPECT_DOUBLE_EQ(state.covariance()(kFix + 2, kFix + 2), 0.4 * 0.4);
}

}  // namespace
}  // namespace vinerow::test::receiver_modes_test

/// Main effects and interactions against textbook designs and least squares by numpy.

#include "tools/study/effects.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace vinerow::study::effects_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// NaN equals NaN.
void expect_matrix(const Eigen::MatrixXd& value, const Eigen::MatrixXd& expected,
                   double tolerance) {
  ASSERT_EQ(value.rows(), expected.rows());
  ASSERT_EQ(value.cols(), expected.cols());
  for (Eigen::Index i = 0; i < value.rows(); ++i) {
    for (Eigen::Index j = 0; j < value.cols(); ++j) {
      if (std::isnan(expected(i, j))) {
        EXPECT_TRUE(std::isnan(value(i, j))) << i << ", " << j;
      } else {
        EXPECT_NEAR(value(i, j), expected(i, j), tolerance) << i << ", " << j;
      }
    }
  }
}

void expect_vector(const std::vector<double>& value, const Eigen::VectorXd& expected,
                   double tolerance) {
  const auto size = static_cast<Eigen::Index>(value.size());
  expect_matrix(Eigen::Map<const Eigen::VectorXd>(value.data(), size), expected, tolerance);
}

double sum_of_shares(const Effects& effects) {
  double sum = 0.0;
  for (const MainEffect& factor : effects.factors) sum += factor.share;
  for (const Interaction& pair : effects.interactions) sum += pair.share;
  return sum;
}

// Life of batteries in hours, by material (3) and temperature (3): the means of four each
// (Montgomery, "Design and analysis of experiments", 8th ed., table 5.1).
const std::array<int, 2> kBatteryLevels{3, 3};
const std::vector<SettingMean> kBattery{{{0, 0}, 134.75}, {{0, 1}, 57.25},  {{0, 2}, 57.50},
                                        {{1, 0}, 155.75}, {{1, 1}, 119.75}, {{1, 2}, 49.50},
                                        {{2, 0}, 144.00}, {{2, 1}, 145.75}, {{2, 2}, 85.50}};

TEST(Effects, AreThoseOfTheBatteryExperiment) {
  const Effects effects = calc_effects(kBatteryLevels, kBattery);
  EXPECT_TRUE(effects.full_factorial);
  EXPECT_NEAR(effects.mean, 105.53, 0.005);
  ASSERT_EQ(effects.factors.size(), 2u);
  ASSERT_EQ(effects.interactions.size(), 1u);

  // Averages of table 5.4 of the book, to two digits there.
  expect_vector(effects.factors[0].means, Eigen::Vector3d(83.17, 108.33, 125.08), 0.005);
  expect_vector(effects.factors[1].means, Eigen::Vector3d(144.83, 107.58, 64.17), 0.005);
  expect_vector(effects.factors[0].effects,
                Eigen::Vector3d(83.17 - 105.53, 108.33 - 105.53, 125.08 - 105.53), 0.01);

  // Sums of squares of table 5.5, of which each counts four batteries. The error's is not between
  // settings.
  const double material = 10683.72, temperature = 39118.72, both = 9613.78;
  const double total = material + temperature + both;
  EXPECT_NEAR(effects.factors[0].share, material / total, 1e-6);
  EXPECT_NEAR(effects.factors[1].share, temperature / total, 1e-6);
  EXPECT_NEAR(effects.interactions[0].share, both / total, 1e-6);
}

TEST(Effects, OfABalancedTableAreCellMinusRowMinusColumnMinusMean) {
  const Effects effects = calc_effects(kBatteryLevels, kBattery);
  const Interaction& pair = effects.interactions[0];
  EXPECT_EQ(pair.first, 0);
  EXPECT_EQ(pair.second, 1);
  Eigen::Matrix3d cells;
  cells << 134.75, 57.25, 57.50, 155.75, 119.75, 49.50, 144.00, 145.75, 85.50;
  expect_matrix(pair.means, cells, 1e-12);
  Eigen::Matrix3d expected = cells;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      expected(i, j) += cells.mean() - cells.row(i).mean() - cells.col(j).mean();
    }
  }
  expect_matrix(pair.effects, expected, 1e-12);
  EXPECT_NEAR(pair.effects(0, 0), 12.2778, 1e-4);  // 134.75 - 83.1667 - 144.8333 + 105.5278
}

// Etch rate by gap, gas flow and power of a plasma, two levels each: sums of two runs (the same,
// table 6.4).
std::vector<SettingMean> etching() {
  const std::array<double, 8> totals{1154, 1319, 1234, 1277, 2089, 1617, 2138, 1589};
  std::vector<SettingMean> settings;
  for (int k = 0; k < 8; ++k) {
    settings.push_back({{k & 1, k >> 1 & 1, k >> 2}, totals[static_cast<std::size_t>(k)] / 2.0});
  }
  return settings;
}
const std::array<int, 3> kEtchingLevels{2, 2, 2};

TEST(Effects, AreThoseOfThePlasmaEtchingExperiment) {
  const Effects effects = calc_effects(kEtchingLevels, etching());
  EXPECT_TRUE(effects.full_factorial);
  // The book's effects are high minus low, twice ours: A, B, C of table 6.5.
  const std::array<double, 3> single{-101.625, 7.375, 306.125};
  // AB, AC, BC.
  const std::array<double, 3> pairs{-24.875, -153.625, -2.125};
  // Sums of squares of the table: A, B, C, AB, AC, BC, and ABC = 126.5625, which stays out.
  const std::array<double, 3> single_squares{41310.5625, 217.5625, 374850.0625};
  const std::array<double, 3> pair_squares{2475.0625, 94402.5625, 18.0625};
  const double total = 513400.4375;
  ASSERT_EQ(effects.interactions.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const double half = 0.5 * single[k];
    expect_vector(effects.factors[k].effects, Eigen::Vector2d(-half, half), 1e-10);
    EXPECT_NEAR(effects.factors[k].share, single_squares[k] / total, 1e-12);
    const double g = 0.5 * pairs[k];
    Eigen::Matrix2d expected;
    expected << g, -g, -g, g;
    expect_matrix(effects.interactions[k].effects, expected, 1e-10);
    EXPECT_NEAR(effects.interactions[k].share, pair_squares[k] / total, 1e-12);
  }
  EXPECT_NEAR(sum_of_shares(effects), 1.0 - 126.5625 / total, 1e-12);
  EXPECT_EQ(effects.interactions[1].first, 0);
  EXPECT_EQ(effects.interactions[1].second, 2);
  EXPECT_EQ(effects.interactions[2].first, 1);
  EXPECT_EQ(effects.interactions[2].second, 2);
}

TEST(Effects, AreTheSameInAnyOrderAndForADoubledDesign) {
  const Effects once = calc_effects(kEtchingLevels, etching());
  const std::vector<SettingMean> forward = etching();
  std::vector<SettingMean> settings(forward.rbegin(), forward.rend());
  settings.insert(settings.end(), forward.begin(), forward.end());
  const Effects twice = calc_effects(kEtchingLevels, settings);
  EXPECT_TRUE(twice.full_factorial);
  for (std::size_t k = 0; k < 3; ++k) {
    expect_vector(twice.factors[k].effects, Eigen::Vector2d(once.factors[k].effects.data()), 1e-10);
    EXPECT_NEAR(twice.factors[k].share, once.factors[k].share, 1e-12);
    expect_matrix(twice.interactions[k].effects, once.interactions[k].effects, 1e-10);
    EXPECT_NEAR(twice.interactions[k].share, once.interactions[k].share, 1e-12);
  }
}

// 2 x 3 levels, one cell twice and one missing.
const std::array<int, 2> kUnevenLevels{2, 3};
const std::vector<SettingMean> kUneven{{{0, 0}, 3.0}, {{0, 0}, 5.0}, {{0, 1}, 4.0},
                                       {{0, 2}, 9.0}, {{1, 0}, 8.0}, {{1, 1}, 6.0}};

TEST(Effects, OfAnUnevenDesignAreThoseOfLeastSquares) {
  const Effects effects = calc_effects(kUnevenLevels, kUneven);
  EXPECT_FALSE(effects.full_factorial);
  // Marginal means by hand.
  expect_vector(effects.factors[0].means, Eigen::Vector2d(5.25, 7.0), 1e-14);
  expect_vector(effects.factors[1].means, Eigen::Vector3d(16.0 / 3.0, 5.0, 9.0), 1e-14);
  EXPECT_NEAR(effects.factors[1].effects[2], 9.0 - 35.0 / 6.0, 1e-14);
  // With A, B, AB the dummy columns of the levels and of the cells, rss(X) the residual sum of
  // squares of numpy.linalg.lstsq(X, y), S = ((y - y.mean())**2).sum():
  // (S - rss(A)) / S, (S - rss(B)) / S, (rss(hstack([A, B])) - rss(AB)) / S.
  EXPECT_NEAR(effects.factors[0].share, 0.15217391304347844, 1e-13);
  EXPECT_NEAR(effects.factors[1].share, 0.4534161490683231, 1e-13);
  EXPECT_NEAR(effects.interactions[0].share, 0.04259094942324753, 1e-13);
  // Mean residuals of [A, B] in the cells: multiples of 1/7.
  Eigen::MatrixXd expected(2, 3);
  expected << -2.0, 4.0, 0.0, 4.0, -4.0, kNaN;
  expect_matrix(effects.interactions[0].effects, expected / 7.0, 1e-13);
  Eigen::MatrixXd means(2, 3);
  means << 4.0, 4.0, 9.0, 8.0, 6.0, kNaN;
  expect_matrix(effects.interactions[0].means, means, 1e-14);
}

TEST(Effects, FindNoInteractionInASumWhateverIsMissing) {
  // y = a_i + b_j + c_k on 3 x 3 x 2 levels, without a third of the cells, unevenly.
  std::vector<SettingMean> settings;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 2; ++k) {
        if (j == 2 && i > 0) continue;
        settings.push_back({{i, j, k}, 1.5 * i * i + 4.0 * j - 0.3 * k});
      }
    }
  }
  const Effects effects = calc_effects(std::array{3, 3, 2}, settings);
  EXPECT_FALSE(effects.full_factorial);
  for (const Interaction& pair : effects.interactions) EXPECT_NEAR(pair.share, 0.0, 1e-25);
  EXPECT_GT(effects.factors[1].share, 0.3);
}

TEST(Effects, OfCellsOfUnequalCountAreOfNoFullFactorial) {
  std::vector<SettingMean> settings = etching();
  settings.push_back({{0, 1, 1}, 1069.0});
  EXPECT_FALSE(calc_effects(kEtchingLevels, settings).full_factorial);
  settings.erase(settings.begin());
  EXPECT_FALSE(calc_effects(kEtchingLevels, settings).full_factorial) << "as many, one missing";
}

TEST(Effects, OfOneFactorExplainAll) {
  const std::vector<SettingMean> settings{{{0}, 1.0}, {{1}, 2.0}, {{2}, 6.0}};
  const Effects effects = calc_effects(std::array{3}, settings);
  EXPECT_TRUE(effects.full_factorial);
  EXPECT_DOUBLE_EQ(effects.factors[0].share, 1.0);
  expect_vector(effects.factors[0].effects, Eigen::Vector3d(-2.0, -1.0, 3.0), 1e-14);
  EXPECT_TRUE(effects.interactions.empty());
}

TEST(Effects, OfADifferenceOfSignsAreInteractionAlone) {
  const std::vector<SettingMean> settings{
      {{0, 0}, 11.0}, {{0, 1}, 9.0}, {{1, 0}, 9.0}, {{1, 1}, 11.0}};
  const Effects effects = calc_effects(std::array{2, 2}, settings);
  EXPECT_NEAR(effects.factors[0].share, 0.0, 1e-15);
  EXPECT_NEAR(effects.factors[1].share, 0.0, 1e-15);
  EXPECT_NEAR(effects.interactions[0].share, 1.0, 1e-15);
  EXPECT_NEAR(effects.interactions[0].effects(0, 0), 1.0, 1e-15);
  EXPECT_NEAR(effects.interactions[0].effects(0, 1), -1.0, 1e-15);
}

TEST(Effects, OfEqualMeansAreZero) {
  std::vector<SettingMean> settings = etching();
  for (SettingMean& setting : settings) setting.mean = 0.1;
  const Effects effects = calc_effects(kEtchingLevels, settings);
  EXPECT_EQ(effects.mean, 0.1);
  EXPECT_EQ(sum_of_shares(effects), 0.0);
  expect_vector(effects.factors[2].effects, Eigen::Vector2d::Zero(), 0.0);
}

TEST(Effects, AreNaNWhereThereIsNoSetting) {
  const std::vector<SettingMean> settings{{{0, 0}, 1.0}, {{2, 0}, 3.0}};
  const Effects effects = calc_effects(std::array{3, 2}, settings);
  EXPECT_FALSE(effects.full_factorial);
  expect_vector(effects.factors[0].means, Eigen::Vector3d(1.0, kNaN, 3.0), 1e-15);
  expect_vector(effects.factors[1].effects, Eigen::Vector2d(0.0, kNaN), 1e-15);
  EXPECT_DOUBLE_EQ(effects.factors[0].share, 1.0);
  EXPECT_EQ(effects.factors[1].share, 0.0);

  const Effects none = calc_effects(std::array{2, 2}, {});
  EXPECT_TRUE(std::isnan(none.mean));
  EXPECT_FALSE(none.full_factorial);
  expect_vector(none.factors[1].means, Eigen::Vector2d(kNaN, kNaN), 0.0);
  expect_matrix(none.interactions[0].effects, Eigen::Matrix2d::Constant(kNaN), 0.0);
  EXPECT_EQ(sum_of_shares(none), 0.0);
}

TEST(EffectsDeathTest, RefuseWhatIsNoDesign) {
  const std::array<int, 2> levels{2, 2};
  const auto one = [&](std::vector<int> chosen, double mean) {
    return calc_effects(levels, std::vector<SettingMean>{{std::move(chosen), mean}});
  };
  EXPECT_DEATH(one({0, 2}, 1.0), "check failed");
  EXPECT_DEATH(one({-1, 0}, 1.0), "check failed");
  EXPECT_DEATH(one({0}, 1.0), "check failed");
  EXPECT_DEATH(one({0, 0}, kNaN), "check failed");
  EXPECT_DEATH(calc_effects(std::array{2, 0}, {}), "check failed");
}

}  // namespace
}  // namespace vinerow::study::effects_test

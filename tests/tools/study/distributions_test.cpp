/// Normal and Student distributions against mpmath 1.4.1 with 30 digits.

#include <gtest/gtest.h>

#include <limits>

#include "tools/study/distributions.h"

namespace vinerow::study::distributions_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_relative(double value, double expected) {
  EXPECT_NEAR(value / expected, 1.0, 1e-13) << value << " for " << expected;
}

TEST(Distributions, NormalIsThatOfMpmath) {
  // ncdf(z)
  expect_relative(normal_probability(-8.0), 6.22096057427178412e-16);
  expect_relative(normal_probability(-1.5), 0.066807201268858066);
  expect_relative(normal_probability(0.3), 0.617911422188952637);
  // sqrt(2) * erfinv(2 * p - 1)
  expect_relative(normal_quantile(1e-10), -6.3613409024040562);
  expect_relative(normal_quantile(0.025), -1.95996398454005424);
  expect_relative(normal_quantile(0.9), 1.28155156554460047);
  EXPECT_EQ(normal_quantile(0.5), 0.0);
  EXPECT_EQ(normal_probability(kInfinity), 1.0);
  EXPECT_EQ(normal_probability(-kInfinity), 0.0);
}

TEST(Distributions, StudentIsThatOfMpmath) {
  // For t < 0: P(T <= t) = betainc(v / 2, 0.5, 0, v / (v + t**2), regularized=True) / 2; quantiles
  // by findroot. scipy 1.10's t.ppf is right to nine digits only.
  expect_relative(student_quantile(0.975, 1.0), 12.7062047361747046);
  expect_relative(student_quantile(0.975, 9.0), 2.26215716279820554);
  expect_relative(student_quantile(1e-6, 3.0), -103.299467780419343);
  expect_relative(student_quantile(0.6, 2.5), 0.281459512748547657);
  expect_relative(student_quantile(0.025, 6.0), -2.44691185114496997);
  expect_relative(student_two_sided(4.0621276833, 9.0), 0.00283289019773288483);
  expect_relative(student_two_sided(-30.0, 20.0), 4.19522532399965816e-18);
  expect_relative(student_two_sided(1e5, 5.0), 1.89803344707886489e-24);
  EXPECT_EQ(student_two_sided(0.0, 4.0), 1.0);
  EXPECT_EQ(student_two_sided(kInfinity, 4.0), 0.0);
}

TEST(Distributions, StudentOfOneDegreeIsCauchysDistribution) {
  // P(|T| >= 1) = 1/2, for which t = tan(π (p - 1/2)).
  EXPECT_NEAR(student_two_sided(1.0, 1.0), 0.5, 1e-15);
  EXPECT_NEAR(student_quantile(0.75, 1.0), 1.0, 1e-15);
}

}  // namespace
}  // namespace vinerow::study::distributions_test

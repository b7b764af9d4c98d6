#include "vehicles/parts/moments_of_inertia.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vinerow::vehicles::moments_of_inertia_test {
namespace {

/// x rounded to three digits, away from zero or towards it: the worst that a file does.
double round_up(double x) {
  const double step = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
  return std::ceil(x / step) * step;
}
double round_down(double x) {
  const double step = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
  return std::floor(x / step) * step;
}

/// Of a thin plate of m kg, a by b: m b^2 / 12, m a^2 / 12 and their sum.
Eigen::Vector3d plate(double a_m, double b_m) {
  const double m = 3.0;
  return {m * b_m * b_m / 12.0, m * a_m * a_m / 12.0, m * (a_m * a_m + b_m * b_m) / 12.0};
}

TEST(MomentsOfInertia, ThinPlatesAndRodsAreBodiesAndKeepTheirRounding) {
  for (double a_m = 0.05; a_m < 3.0; a_m *= 1.07) {
    const Eigen::Vector3d exact = plate(a_m, 0.31);
    EXPECT_EQ(find_fault_in_moments("inertia", exact), "");
    // Rounded to the nearest digit, up or down by half a step: the sum's worst is the mean.
    const Eigen::Vector3d worst(0.5 * (exact.x() + round_down(exact.x())),
                                0.5 * (exact.y() + round_down(exact.y())),
                                0.5 * (exact.z() + round_up(exact.z())));
    EXPECT_EQ(find_fault_in_moments("inertia", worst), "") << worst.transpose();
  }
  EXPECT_EQ(find_fault_in_moments("inertia", {0.0, 0.25, 0.25}), "");  // a rod
  EXPECT_EQ(find_fault_in_moments("inertia", {0.0, 0.0, 0.0}), "");    // a point
}

TEST(MomentsOfInertia, AnExcessThatIsNoRoundingIsAFaultAboutAnyAxis) {
  const char* said =
      " is not possible for a rigid body: one moment is larger than the sum of the other two";
  EXPECT_EQ(find_fault_in_moments("inertia", {1.0, 1.0, 2.05}),
            std::string("inertia = [1, 1, 2.05]") + said);
  EXPECT_EQ(find_fault_in_moments("inertia", {0.6, 0.1, 0.3}),
            std::string("inertia = [0.6, 0.1, 0.3]") + said);
  EXPECT_EQ(find_fault_in_moments("inertia", {-0.1, 1.0, 1.0}),
            std::string("inertia = [-0.1, 1, 1]") + said);
}

}  // namespace
}  // namespace vinerow::vehicles::moments_of_inertia_test

// Filters between rows if the true noise is half or twice the stated noise: the table of
// docs/papers/localisation.md. The stated noise comes from the filter's settings, from receivers
// and from maps; no vineyard matches it exactly.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <vector>

#include "tests/controllers/estimation/inertial/linear_theory.h"
#include "tests/controllers/estimation/row_localisation/localisation_lab.h"
#include "tests/controllers/estimation/row_localisation/map_localisation_lab.h"

namespace vinerow::test::mismatch_test {
namespace {

constexpr int kSeeds = 10;

/// Hands on a standard deviation of the fixes that is not theirs.
class Misinformed final : public LabFilter {
 public:
  Misinformed(std::unique_ptr<LabFilter> filter, double stated_share)
      : filter_(std::move(filter)), stated_share_(stated_share) {}
  void start(Time now, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance) override {
    filter_->start(now, p_W, covariance);
  }
  void inertial(Time now, const Eigen::Vector3d& v_W, const Eigen::Quaterniond& q_WB,
                const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m) override {
    filter_->inertial(now, v_W, q_WB, p_W, std_m);
  }
  void fix(Time measured, const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m) override {
    filter_->fix(measured, p_W, stated_share_ * std_m);
  }
  void height(Time measured, double z_m, double std_m) override {
    filter_->height(measured, z_m, std_m);
  }
  void ranges(Time measured, std::span<const controllers::RangeReading> readings) override {
    filter_->ranges(measured, readings);
  }
  Eigen::Vector3d p_W() const override { return filter_->p_W(); }
  Eigen::Matrix3d covariance() const override { return filter_->covariance(); }

 private:
  std::unique_ptr<LabFilter> filter_;
  double stated_share_;
};

enum class Noise { kFixes, kVelocity, kHeading, kMap, kAll };
const char* name_of(Noise noise) {
  switch (noise) {
    case Noise::kFixes:
      return "fixes";
    case Noise::kVelocity:
      return "velocity";
    case Noise::kHeading:
      return "heading";
    case Noise::kMap:
      return "map";
    case Noise::kAll:
      return "all";
  }
  return "?";
}

/// Score in a world with `factor` times the noise stated to the filter.
LabScore score_of(const LabFilterMaker& make, Noise noise, double factor, int seeds = kSeeds) {
  LabSetup setup;
  const auto is = [&](Noise one) { return noise == one || noise == Noise::kAll; };
  if (is(Noise::kFixes)) setup.fix_std_m *= factor;
  if (is(Noise::kVelocity)) setup.velocity_std_mps *= factor;
  if (is(Noise::kHeading)) setup.heading_std_rad *= factor;
  if (is(Noise::kMap)) {
    setup.world.stated_surface_std_m = setup.world.surface_std_m;
    setup.world.surface_std_m *= factor;
  }
  const double stated_share = is(Noise::kFixes) ? 1.0 / factor : 1.0;
  return study(setup, seeds, [&](const LabContext& context) {
    return std::make_unique<Misinformed>(make(context), stated_share);
  });
}

struct TheoryCase {
  Noise noise;
  double factor;
  LinearTheory::Share share;
};

TEST(MismatchOfALinearFilter, IsWhatTheRiccatiRecursionWithTheTrueNoiseSays) {
  constexpr int kFlights = 20;
  controllers::DistanceFilterParams open;  // a gate is not linear
  open.fix_gate_sigma = 0.0;
  const LabFilterMaker make = distance_filter(open, false);
  for (const TheoryCase& one : {TheoryCase{Noise::kAll, 1.0, {1.0, 1.0}},
                                {Noise::kFixes, 0.5, {0.5, 1.0}},
                                {Noise::kFixes, 2.0, {2.0, 1.0}},
                                {Noise::kVelocity, 0.5, {1.0, 0.5}},
                                {Noise::kVelocity, 2.0, {1.0, 2.0}},
                                {Noise::kAll, 0.5, {0.5, 0.5}},
                                {Noise::kAll, 2.0, {2.0, 2.0}}}) {
    SCOPED_TRACE(fmt::format("{} x {}", name_of(one.noise), one.factor));
    const LinearTheory theory(one.share);
    const LabScore score = score_of(make, one.noise, one.factor, kFlights);
    std::printf("%-8s x %.1f %.3f / %.3f m, NEES %.2f; theory %.3f m, %.2f\n", name_of(one.noise),
                one.factor, score.lateral_m, score.longitudinal_m, score.nees,
                std::sqrt(theory.mean_square_m2()), theory.nees());
    // Four standard deviations by the theory, not by how the figures scatter.
    const double share = 4.0 / std::sqrt(static_cast<double>(kFlights));
    const double square_margin = share * theory.mean_square_std_m2();
    EXPECT_NEAR(score.lateral_m * score.lateral_m, theory.mean_square_m2(), square_margin);
    EXPECT_NEAR(score.longitudinal_m * score.longitudinal_m, theory.mean_square_m2(),
                square_margin);
    EXPECT_NEAR(score.nees, theory.nees(), share * theory.nees_std());
  }
}

struct Named {
  const char* name;
  LabFilterMaker make;
  bool has_map = true;
};

void PrintTo(const Named& filter, std::ostream* out) {
  *out << filter.name;
}

class Mismatch : public ::testing::TestWithParam<Named> {};

TEST_P(Mismatch, HalfAndTwiceTheNoiseLeaveItInItsRow) {
  const LabScore nominal = score_of(GetParam().make, Noise::kAll, 1.0);
  std::printf("%-17s %-8s      %.4f / %.4f m, NEES %.2f, %.3f inside\n", GetParam().name, "nominal",
              nominal.lateral_m, nominal.longitudinal_m, nominal.nees, nominal.coverage);
  // Across the rows the walls make a filter all but linear: its variance is then the sum of one
  // share for each source of noise, and each share is found both from half and from twice of it.
  double from_half_m2 = 0.0, from_twice_m2 = 0.0;
  const double nominal_m2 = nominal.lateral_m * nominal.lateral_m;
  for (const Noise noise :
       {Noise::kFixes, Noise::kVelocity, Noise::kHeading, Noise::kMap, Noise::kAll}) {
    for (const double factor : {0.5, 2.0}) {
      SCOPED_TRACE(std::string(name_of(noise)) + (factor < 1.0 ? " by half" : " twice"));
      const LabScore score = score_of(GetParam().make, noise, factor);
      std::printf("%-17s %-8s x %.1f %.4f / %.4f m, NEES %.2f, %.3f inside\n", GetParam().name,
                  name_of(noise), factor, score.lateral_m, score.longitudinal_m, score.nees,
                  score.coverage);
      EXPECT_EQ(score.lost, 0);
      const double square_m2 = score.lateral_m * score.lateral_m;
      if (noise != Noise::kAll) {
        (factor < 1.0 ? from_half_m2 : from_twice_m2) +=
            (square_m2 - nominal_m2) / (factor * factor - 1.0);
      }
      if (factor < 1.0) {
        // Less noise than stated never increases the errors; the filter is then too careful.
        EXPECT_LE(score.lateral_m, 1.05 * nominal.lateral_m);
        EXPECT_LE(score.longitudinal_m, 1.05 * nominal.longitudinal_m);
        EXPECT_LE(score.nees, 1.1 * nominal.nees);
        EXPECT_GE(score.nees, 0.2 * nominal.nees);
      } else {
        // A linear filter scales with its noise: twice the error, four times the NEES where all
        // noise is twice as large. A gate of 3.5 sigma then refuses 8 % of what is good. If every
        // reading counts alike, that costs 1 / sqrt(0.92): the bound across the rows. Along them
        // only the walls' roughness gives the place, which is not linear in an error as long as its
        // bumps, and a gate of 5 sigma for three coordinates refuses 10 % of the fixes. No theory
        // bounds that: 2.4 and 5.2 are just above the 2.34 and 4.7 that are reached.
        if (GetParam().has_map) {
          EXPECT_LE(score.lateral_m, 2.0 / std::sqrt(0.92) * nominal.lateral_m);
        } else {
          EXPECT_LE(score.lateral_m, 2.4 * nominal.lateral_m);
        }
        EXPECT_LE(score.longitudinal_m, 2.4 * nominal.longitudinal_m);
        EXPECT_LE(score.nees, 5.2 * nominal.nees);
        EXPECT_GE(score.nees, 0.9 * nominal.nees);
      }
    }
  }
  if (GetParam().has_map) {
    // If errors across the rows forget within half a second (assumed, not measured), ten flights
    // hold some 1100 independent ones, and products of two shares average to 3 %: four times that.
    EXPECT_NEAR(from_half_m2, nominal_m2, 0.12 * nominal_m2);
    EXPECT_NEAR(from_twice_m2, nominal_m2, 0.12 * nominal_m2);
  }
}

INSTANTIATE_TEST_SUITE_P(Filters, Mismatch,
                         ::testing::Values(Named{"range_ekf", distance_filter({})},
                                           Named{"map_localisation", map_localisation()},
                                           Named{"no_map", distance_filter({}, false), false}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace vinerow::test::mismatch_test

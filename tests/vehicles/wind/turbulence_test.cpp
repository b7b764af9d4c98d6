/// Turbulence against the closed forms of MIL-F-8785C: scales, variance, correlation, spectrum.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/vehicles/wind/spectrum.h"
#include "tests/vehicles/wind/wind_rig.h"

namespace vinerow::vehicles::turbulence_test {
namespace {

using namespace test;
using vinerow::test::Spectrum;
using vinerow::test::welch;

constexpr double kHalfHour_s = 1800.0;

/// Turbulence alone of 8 m/s at 20 ft, carried past by a uniform wind.
Wind turbulent(double airspeed_mps) {
  Wind wind = west_wind(airspeed_mps);
  wind.turbulence = 1.0;
  wind.turbulence_wind_mps = 8.0;
  return wind;
}

/// Samples of u, v, w at a place.
std::array<std::vector<double>, 3> record(const Wind& wind, std::uint64_t seed, double height_m,
                                          double time_s, Duration dt) {
  WindRig rig(wind, seed);
  std::array<std::vector<double>, 3> uvw;
  const auto count = static_cast<std::size_t>(time_s / dt.s());
  for (auto& samples : uvw) samples.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    rig.sample(dt, {0, 0, height_m});
    for (std::size_t k = 0; k < 3; ++k) {
      uvw[k].push_back(rig.probe->turbulence_W()[static_cast<Eigen::Index>(k)]);
    }
  }
  return uvw;
}

double mean_square(const std::vector<double>& samples) {
  double sum = 0.0;
  for (const double x : samples) sum += x * x;
  return sum / static_cast<double>(samples.size());
}

double length_of(const DrydenScales& scales, std::size_t k) {
  return k < 2 ? scales.length_uv_m : scales.length_w_m;
}
double variance_of(const DrydenScales& scales, std::size_t k) {
  return std::pow(k < 2 ? scales.sigma_uv_mps : scales.sigma_w_mps, 2);
}

/// Relative deviation of a mean square over time T: sqrt(4 / T times the integral of rho^2), which
/// is L / 2V for exp(-x) and 5 L / 16 V for exp(-x) (1 - x / 2), x = V t / L.
double expected_deviation(double length_m, std::size_t k, double airspeed_mps, double time_s) {
  return std::sqrt((k == 0 ? 2.0 : 1.25) * length_m / (airspeed_mps * time_s));
}

/// MIL-F-8785C, one-sided.
double closed_spectrum(const DrydenScales& scales, std::size_t k, double wave_radpm) {
  const double L = length_of(scales, k), x2 = std::pow(L * wave_radpm, 2);
  return variance_of(scales, k) * L / std::numbers::pi *
         (k == 0 ? 2.0 / (1.0 + x2) : (1.0 + 3.0 * x2) / ((1.0 + x2) * (1.0 + x2)));
}

TEST(DrydenScales, AreThoseOfTheSpecification) {
  // 20 ft: L_w = 20 ft, L_u = 20 / 0.19346^1.2 ft; sigma_w = 0.1 W20, sigma_u = that / 0.19346^0.4.
  const DrydenScales low = calc_dryden_scales(6.096, 10.0);
  EXPECT_NEAR(low.length_w_m, 6.096, 1e-12);
  EXPECT_NEAR(low.length_uv_m, 6.096 / std::pow(0.19346, 1.2), 1e-9);
  EXPECT_NEAR(low.sigma_w_mps, 1.0, 1e-12);
  EXPECT_NEAR(low.sigma_uv_mps, 1.0 / std::pow(0.19346, 0.4), 1e-12);
  // 1000 ft: 0.177 + 0.823 = 1, so all lengths and deviations agree.
  const DrydenScales high = calc_dryden_scales(304.8, 10.0);
  EXPECT_NEAR(high.length_uv_m, high.length_w_m, 1e-9);
  EXPECT_NEAR(high.sigma_uv_mps, high.sigma_w_mps, 1e-12);
}

TEST(DrydenScales, AreClippedTo10And1000Feet) {
  EXPECT_EQ(calc_dryden_scales(0.0, 5.0).length_w_m, calc_dryden_scales(3.048, 5.0).length_w_m);
  EXPECT_EQ(calc_dryden_scales(-4.0, 5.0).sigma_uv_mps,
            calc_dryden_scales(3.048, 5.0).sigma_uv_mps);
  EXPECT_EQ(calc_dryden_scales(999.0, 5.0).length_uv_m, calc_dryden_scales(304.8, 5.0).length_uv_m);
}

TEST(Turbulence, HalfHourVarianceLiesWhereItsCorrelationLetsIt) {
  // One half hour holds some 200 eddies of u at 2 m: 4 standard deviations of the estimate itself
  // are the honest limit. Where they are below 5 %, 5 % is what is asked.
  for (const double height_m : {2.0, 30.0}) {
    for (const double airspeed_mps : {4.0, 12.0}) {
      const DrydenScales scales = calc_dryden_scales(height_m, 8.0);
      for (const std::uint64_t seed : {1, 2, 3}) {
        const auto uvw = record(turbulent(airspeed_mps), seed, height_m, kHalfHour_s, {10'000'000});
        for (std::size_t k = 0; k < 3; ++k) {
          const double sd = expected_deviation(length_of(scales, k), k, airspeed_mps, kHalfHour_s);
          EXPECT_NEAR(mean_square(uvw[k]) / variance_of(scales, k), 1.0, std::max(0.05, 4.0 * sd))
              << "component " << k << ", " << height_m << " m, " << airspeed_mps << " m/s, seed "
              << seed << ", expected deviation " << sd;
        }
      }
    }
  }
}

TEST(Turbulence, VarianceOverManyHalfHoursIsWithinFivePercent) {
  // As many half hours as bring the estimate's own deviation to 1.4 %.
  for (const double height_m : {2.0, 30.0}) {
    for (const double airspeed_mps : {4.0, 12.0}) {
      const DrydenScales scales = calc_dryden_scales(height_m, 8.0);
      const double sd = expected_deviation(scales.length_uv_m, 0, airspeed_mps, kHalfHour_s);
      const int runs = static_cast<int>(std::ceil(std::pow(sd / 0.014, 2)));
      std::array<double, 3> sum{};
      for (int run = 0; run < runs; ++run) {
        const auto seed = static_cast<std::uint64_t>(100 + run);
        const auto uvw =
            record(turbulent(airspeed_mps), seed, height_m, kHalfHour_s, {200'000'000});
        for (std::size_t k = 0; k < 3; ++k) sum[k] += mean_square(uvw[k]) / runs;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double ratio = sum[k] / variance_of(scales, k);
        EXPECT_NEAR(ratio, 1.0, 0.05);
        RecordProperty("ratio_" + std::to_string(k) + "_" +
                           std::to_string(static_cast<int>(height_m)) + "m_" +
                           std::to_string(static_cast<int>(airspeed_mps)) + "mps",
                       std::to_string(ratio) + " of " + std::to_string(runs));
      }
    }
  }
}

TEST(Turbulence, CorrelationFollowsTheClosedForm) {
  DrydenTurbulence turbulence(RandomStream(5, "drone", "wind"));
  DrydenScales scales;
  scales.length_uv_m = scales.length_w_m = 1.0;
  constexpr int kLag = 4, kCount = 400'000;
  constexpr double kStep = 0.25;  // in lengths: the fourth lag is one length
  std::array<std::vector<double>, 3> x;
  for (int i = 0; i < kCount; ++i) {
    turbulence.advance(kStep, scales);
    const Eigen::Vector3d unit = turbulence.unit();
    for (std::size_t k = 0; k < 3; ++k) x[k].push_back(unit[static_cast<Eigen::Index>(k)]);
  }
  for (int lag = 0; lag <= kLag; ++lag) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        double sum = 0.0;
        for (int i = lag; i < kCount; ++i) {
          sum += x[a][static_cast<std::size_t>(i)] * x[b][static_cast<std::size_t>(i - lag)];
        }
        const double s = lag * kStep;
        const double own = a == 0 ? std::exp(-s) : std::exp(-s) * (1.0 - 0.5 * s);
        // 100,000 lengths: the deviation is at most sqrt(2 / 100000) = 0.45 %.
        EXPECT_NEAR(sum / (kCount - lag), a == b ? own : 0.0, 0.018) << a << b << lag;
      }
    }
  }
}

TEST(Turbulence, ManySmallStepsAreOneLargeStep) {
  // The same process whatever the step: variance and correlation over one length.
  for (const double step : {1e-4, 0.05, 0.049, 0.5}) {
    DrydenScales scales;
    scales.length_uv_m = scales.length_w_m = 1.0;
    const int steps = static_cast<int>(std::lround(1.0 / step / 2.0));  // half a length
    const int count = step < 0.01 ? 400 : 40'000;
    DrydenTurbulence turbulence(RandomStream(9, "drone", "wind"));
    Eigen::Vector3d square = Eigen::Vector3d::Zero();
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < steps; ++j) turbulence.advance(step, scales);
      square += turbulence.unit().cwiseAbs2() / count;
    }
    const double limit = 4.0 * std::sqrt(2.0 / (0.25 * count));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(square[k], 1.0, limit) << step;
  }
}

/// Least-squares slope of ln density over ln wave number between two wave numbers, and that of the
/// closed form at the same places.
std::pair<double, double> slopes(const Spectrum& spectrum, const DrydenScales& scales,
                                 std::size_t k, double from_radpm, double to_radpm) {
  // Octave bands weigh alike.
  double n = 0, sx = 0, sy = 0, sc = 0, sxx = 0, sxy = 0, sxc = 0;
  for (double low = from_radpm; low < 0.99 * to_radpm; low *= 2.0) {
    double sum = 0.0, closed = 0.0;
    int bins = 0;
    for (std::size_t i = 1; i < spectrum.density.size(); ++i) {
      const double wave = static_cast<double>(i) * spectrum.spacing_radpm;
      if (wave < low || wave >= 2.0 * low) continue;
      sum += spectrum.density[i];
      closed += closed_spectrum(scales, k, wave);
      ++bins;
    }
    EXPECT_GT(bins, 0);
    // Each octave's level against the closed form: chi-square of `bins` times the segments, of
    // which half are as good as independent under Hann windows.
    const double sd = 1.0 / std::sqrt(0.5 * bins * spectrum.segments);
    EXPECT_NEAR(sum / closed, 1.0, 4.0 * sd + 0.02) << "component " << k << " at " << low;
    const double x = std::log(low), y = std::log(sum / bins), c = std::log(closed / bins);
    n += 1, sx += x, sy += y, sc += c, sxx += x * x, sxy += x * y, sxc += x * c;
  }
  const double det = n * sxx - sx * sx;
  return {(n * sxy - sx * sy) / det, (n * sxc - sx * sc) / det};
}

TEST(Turbulence, SpectrumFallsWithSlopeMinusTwo) {
  // Knots 5 ms apart at 10 m/s are 5 cm; an eighth of their limit pi / 0.05 m is free of folding.
  const auto uvw = record(turbulent(10.0), 4, 20.0, kHalfHour_s, {5'000'000});
  const DrydenScales scales = calc_dryden_scales(20.0, 8.0);
  for (std::size_t k = 0; k < 3; ++k) {
    const Spectrum spectrum = welch(uvw[k], 0.05, 8192);
    const auto [measured, closed] = slopes(spectrum, scales, k, 0.5, 8.0);
    EXPECT_NEAR(measured, -2.0, 0.05);
    EXPECT_NEAR(measured, closed, 0.03);
    RecordProperty("slope_" + std::to_string(k), std::to_string(measured));
  }
}

TEST(Turbulence, SpectrumIsLevelAtLongWaves) {
  // Samples a twelfth of L apart fold less than 1 % of the level back to long waves. There are
  // enough half hours to know the octaves' levels to 4 % and the slope to 0.025.
  const DrydenScales scales = calc_dryden_scales(2.0, 8.0);
  struct Case {
    std::vector<std::size_t> components;
    Duration dt;
    double half_hours;
  };
  for (const Case& c : {Case{{0, 1}, {100'000'000}, 100}, Case{{2}, {12'500'000}, 16}}) {
    const auto uvw = record(turbulent(20.0), 6, 2.0, c.half_hours * kHalfHour_s, c.dt);
    for (const std::size_t k : c.components) {
      const Spectrum spectrum = welch(uvw[k], 20.0 * c.dt.s(), 16384);
      const double corner = 1.0 / length_of(scales, k);
      const auto [measured, closed] = slopes(spectrum, scales, k, corner / 32.0, corner / 4.0);
      EXPECT_NEAR(measured, 0.0, 0.1) << k;
      EXPECT_NEAR(measured, closed, 0.08) << k;
    }
  }
}

TEST(Turbulence, DoesNotDependOnThePhysicsStep) {
  // Steps that meet every knot draw the same knots: the same wind to rounding.
  WindRig fine(turbulent(6.0), 3), coarse(turbulent(6.0), 3);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d a = fine.sample({1'000'000}, {0, 0, 5});
    if (i % 5 != 0) continue;
    const Eigen::Vector3d b = coarse.sample({5'000'000}, {0, 0, 5});
    ASSERT_NEAR((a - b).norm(), 0.0, 1e-9) << i;
  }
  // Steps of 10 ms draw others: the same variance and spectrum.
  const DrydenScales scales = calc_dryden_scales(5.0, 8.0);
  const auto fine_w = record(turbulent(6.0), 7, 5.0, kHalfHour_s, {1'000'000})[2];
  const auto coarse_w = record(turbulent(6.0), 8, 5.0, kHalfHour_s, {10'000'000})[2];
  const double sd = expected_deviation(scales.length_w_m, 2, 6.0, kHalfHour_s);
  EXPECT_NEAR(mean_square(fine_w) / mean_square(coarse_w), 1.0, 4.0 * std::sqrt(2.0) * sd);
  for (const auto& [samples, step_m, segment] : {std::tuple{&fine_w, 0.006, std::size_t{65536}},
                                                 std::tuple{&coarse_w, 0.06, std::size_t{8192}}}) {
    const Spectrum spectrum = welch(*samples, step_m, segment);
    const auto [measured, closed] = slopes(spectrum, scales, 2, 0.8, 6.4);
    EXPECT_NEAR(measured, closed, 0.05) << step_m;
  }
}

TEST(Turbulence, FollowsChangesOfHeightAndSpeedWithoutJumps) {
  // From the ground to 300 m and from rest to 30 m/s within a second. Between knots 5 ms apart the
  // wind runs straight; from knot to knot a component changes by sqrt(2 (1 - rho)) sigma, with
  // 1 - rho <= 3/2 of 0.175 m / 3.05 m: 0.42 of at most 1.57 m/s. Six times that, over three
  // components and five steps a knot, never comes; the deviations themselves halve on the way.
  const double limit_mps = 6.0 * std::sqrt(3.0) * 0.42 * 1.57 / 5.0;
  WindRig rig(turbulent(5.0), 2);
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  double largest_mps = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double share = std::clamp((i - 1000) / 1000.0, 0.0, 1.0);
    rig.probe->sample({i * std::int64_t{1'000'000}}, {0, 0, 300.0 * share}, {-30.0 * share, 0, 0},
                      {1'000'000});
    const Eigen::Vector3d turbulence = rig.probe->turbulence_W();
    if (i > 0) largest_mps = std::max(largest_mps, (turbulence - last).norm());
    last = turbulence;
  }
  EXPECT_LT(largest_mps, limit_mps);
  EXPECT_GT(largest_mps, 0.0);
}

TEST(Turbulence, DoesNotFreezeWhereAVehicleDriftsWithTheWind) {
  const Wind wind = turbulent(6.0);
  WindRig rig(wind, 2);
  const DrydenScales scales = calc_dryden_scales(3.0, 8.0);
  std::vector<double> u;
  const Duration dt{20'000'000};
  for (int i = 0; i < 500'000; ++i) {
    rig.probe->sample({i * dt.ns}, {0, 0, 3.0}, {6.0, 0, 0}, dt);
    u.push_back(rig.probe->turbulence_W().x());
  }
  // The documented speed is sigma_u: after L / sigma_u the correlation is 1 / e.
  const auto lag = static_cast<std::size_t>(scales.length_uv_m / scales.sigma_uv_mps / dt.s());
  double sum = 0.0;
  for (std::size_t i = lag; i < u.size(); ++i) sum += u[i] * u[i - lag];
  EXPECT_NEAR(sum / static_cast<double>(u.size() - lag) / variance_of(scales, 0), std::exp(-1.0),
              0.15);
}

}  // namespace
}  // namespace vinerow::vehicles::turbulence_test

#include "engine/sensors/bias_instability.h"

#include <algorithm>
#include <cmath>

namespace vinerow::sensors {
namespace {

constexpr std::array<double, BiasInstability::kCount> kTimes_s = {2.0,   12.0,   72.0,
                                                                  432.0, 2592.0, 15552.0};

/// Allan variance of a Gauss-Markov process of variance one at an averaging time of x correlation
/// times.
double calc_unit_allan_variance(double x) {
  if (x < 1e-3) return 2.0 * x / 3.0;  // first term of the series: the closed form loses digits
  return 2.0 / x * (1.0 - (3.0 - 4.0 * std::exp(-x) + std::exp(-2.0 * x)) / (2.0 * x));
}

}  // namespace

BiasInstability::BiasInstability(double std, double period_s) {
  for (int i = 0; i < kCount; ++i) processes_[i] = GaussMarkov(std, kTimes_s[i], period_s);
}

void BiasInstability::start(RandomStream& random) {
  for (GaussMarkov& process : processes_) process.start(random);
}

double BiasInstability::step(RandomStream& random) {
  double bias = 0.0;
  for (GaussMarkov& process : processes_) bias += process.step(random);
  return bias;
}

double calc_allan_deviation(const AllanFigures& figures, double process_std, double t_s) {
  double flicker = 0.0;
  for (const double time_s : kTimes_s) flicker += calc_unit_allan_variance(t_s / time_s);
  return std::sqrt(figures.white_u_rtHz * figures.white_u_rtHz / t_s +
                   process_std * process_std * flicker +
                   figures.walk_u_per_rts * figures.walk_u_per_rts * t_s / 3.0);
}

double calc_min_allan_deviation(const AllanFigures& figures, double process_std) {
  constexpr int kSteps = 100;
  double min_deviation = calc_allan_deviation(figures, process_std, kLongestAveraging_s);
  for (int i = 0; i < kSteps; ++i) {
    const double t_s =
        kFlatFrom_s * std::pow(kLongestAveraging_s / kFlatFrom_s, static_cast<double>(i) / kSteps);
    min_deviation = std::min(min_deviation, calc_allan_deviation(figures, process_std, t_s));
  }
  return min_deviation;
}

double calc_instability_std(const AllanFigures& figures) {
  if (figures.instability_u == 0.0) return 0.0;
  const double wanted = kInstabilityFactor * figures.instability_u;
  if (calc_min_allan_deviation(figures, 0.0) > wanted) return -1.0;
  // The minimum grows with the processes' standard deviation; without white noise and random walk
  // it is 0.84 times it.
  double low = 0.0, high = 2.0 * wanted;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (calc_min_allan_deviation(figures, middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace vinerow::sensors

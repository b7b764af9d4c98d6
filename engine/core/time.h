#pragma once
/// Simulated time: an integer count of nanoseconds, so that rates are exact and no sum of steps
/// drifts.

#include <compare>
#include <cstdint>

namespace vinerow {

/// A span of simulated time.
struct Duration {
  std::int64_t ns = 0;

  /// For computing. It is rounded twice, 2.5010000000000003 for 2.501 s; digests depend on it.
  constexpr double s() const { return static_cast<double>(ns) * 1e-9; }
  /// For people and other programs: the double nearest to the span, which prints as 2.501.
  constexpr double nearest_s() const { return static_cast<double>(ns) / 1e9; }
  constexpr auto operator<=>(const Duration&) const = default;
};

/// An instant of simulated time; zero is the start of the run.
struct Time {
  std::int64_t ns = 0;

  /// For computing, as of Duration.
  constexpr double s() const { return static_cast<double>(ns) * 1e-9; }
  /// For people and other programs, as of Duration.
  constexpr double nearest_s() const { return static_cast<double>(ns) / 1e9; }
  constexpr auto operator<=>(const Time&) const = default;
};

constexpr Time operator+(Time t, Duration d) {
  return {t.ns + d.ns};
}
constexpr Time operator-(Time t, Duration d) {
  return {t.ns - d.ns};
}
constexpr Duration operator-(Time a, Time b) {
  return {a.ns - b.ns};
}
constexpr Duration operator+(Duration a, Duration b) {
  return {a.ns + b.ns};
}
constexpr Duration operator*(Duration d, std::int64_t n) {
  return {d.ns * n};
}

/// Nearest whole nanosecond. @param seconds finite, |seconds| < 9e9.
Duration duration_from_s(double seconds);

/// Period of a rate. @param rate_Hz finite, > 0.
/// @returns the period rounded to the nearest nanosecond. A rate such as 30 Hz has no exact period;
/// the scheduler rejects it because no physics step divides it.
Duration period_of_rate(double rate_Hz);

}  // namespace vinerow

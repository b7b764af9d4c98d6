#pragma once
/// In-run bias instability of an inertial sensor, specified as in data sheets by the flat minimum
/// of the Allan deviation.
///
/// The flicker noise is a sum of Gauss-Markov processes of equal variance whose correlation times
/// grow by a factor of six, from 2 s to 4.3 h. The sum's Allan deviation is flat within 2 % from 20
/// s to half an hour, and smaller below 20 s, where white noise dominates in real devices. Its size
/// is chosen such that the minimum of the whole curve, white noise and random walk included, is
/// 0.664 B (IEEE Std 952-1997, equation C.5: sqrt(2 ln 2 / pi) B).

#include <array>

#include "engine/sensors/gauss_markov.h"

namespace vinerow::sensors {

/// Allan figures of one axis. The unit u is deg/s, m/s2 or another one; all figures use the same.
struct AllanFigures {
  double white_u_rtHz = 0.0;    ///< N: white noise density, Allan deviation N / sqrt(t)
  double instability_u = 0.0;   ///< B: bias instability, minimum Allan deviation 0.664 B
  double walk_u_per_rts = 0.0;  ///< K: random walk of the bias, Allan deviation K sqrt(t / 3)
};

/// sqrt(2 ln 2 / pi): minimum Allan deviation over bias instability.
inline constexpr double kInstabilityFactor = 0.66428247;
/// Upper end of the search for the minimum: a ninth of an hour. An hour's record, on which data
/// sheets are based, says little about longer averaging times.
inline constexpr double kLongestAveraging_s = 400.0;
/// Lower end of the search for the minimum: the flicker noise is flat from here.
inline constexpr double kFlatFrom_s = 20.0;

class BiasInstability {
 public:
  static constexpr int kCount = 6;

  BiasInstability() = default;
  /// @param std  of each process, see calc_instability_std
  BiasInstability(double std, double period_s);

  void start(RandomStream& random);
  /// One step. Draws kCount numbers. @returns the bias
  double step(RandomStream& random);

 private:
  std::array<GaussMarkov, kCount> processes_;
};

/// Allan deviation of white noise, processes of standard deviation `process_std` and random walk
/// together at averaging time t_s. Closed form: IEEE Std 952-1997, equations C.9, C.13, C.15.
double calc_allan_deviation(const AllanFigures& figures, double process_std, double t_s);

/// Minimum Allan deviation for averaging times from kFlatFrom_s to kLongestAveraging_s.
double calc_min_allan_deviation(const AllanFigures& figures, double process_std);

/// Standard deviation of each process that gives the specified minimum of the Allan deviation; 0 if
/// the bias instability is 0.
/// @returns -1 if white noise and random walk alone exceed that minimum
double calc_instability_std(const AllanFigures& figures);

}  // namespace vinerow::sensors

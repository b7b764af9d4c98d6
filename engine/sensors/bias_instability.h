#pragma once
/// The in-run wandering of an inertial sensor's bias, as data sheets state it: by the flat least
/// value of the Allan deviation.
///
/// Flicker noise, modelled by a sum of Gauss-Markov processes of one variance whose correlation
/// times grow by a factor of six, from 2 s to 4.3 h: the sum's Allan deviation is flat within 2 %
/// from 20 s to half an hour, and less below, where white noise rules in real devices. Its size is
/// found such that the whole curve, white noise and random walk included, has its least value at
/// 0.664 B (IEEE Std 952-1997, equation C.5: sqrt(2 ln 2 / pi) B).

#include <array>

#include "engine/sensors/gauss_markov.h"

namespace vinerow::sensors {

/// One axis. Units: u is deg/s, m/s2 or another one; only they need to agree.
struct AllanFigures {
  double white_u_rtHz = 0.0;    ///< N: white noise density, Allan deviation N / sqrt(t)
  double instability_u = 0.0;   ///< B: bias instability, least Allan deviation 0.664 B
  double walk_u_per_rts = 0.0;  ///< K: random walk of the bias, Allan deviation K sqrt(t / 3)
};

/// sqrt(2 ln 2 / pi): least Allan deviation over bias instability.
inline constexpr double kInstabilityFactor = 0.66428247;
/// The least Allan deviation is looked for up to here: a ninth of an hour, beyond which an hour's
/// record, what data sheets are made from, says little.
inline constexpr double kLongestAveraging_s = 400.0;
/// ... and from here: see above.
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

/// Least value of that for averaging times of kFlatFrom_s to kLongestAveraging_s.
double calc_least_allan_deviation(const AllanFigures& figures, double process_std);

/// Standard deviation of each process that gives the least Allan deviation asked for; 0 where no
/// instability is asked for.
/// @returns -1 if white noise and random walk alone are more than that
double calc_instability_std(const AllanFigures& figures);

}  // namespace vinerow::sensors

#pragma once
/// The plain aircraft of aircraft_sim.h in a loop (loop.h) under a registered controller. The
/// reference is a function of time.

#include <functional>
#include <optional>
#include <string>

#include "engine/api/messages/flight.h"
#include "engine/core/random.h"
#include "tests/controllers/support/aircraft_sim.h"
#include "tests/controllers/support/loop.h"

namespace vinerow::test {

using AirPhase = AirReference::Phase;
using AirCourse = std::function<AirReference(double time_s)>;

/// Straight ahead at 12 m/s. @param course_rad  from east to the left
AirCourse fly_straight(double course_rad, double height_m, double climb_angle_rad = 0.0);
/// A circle at a bank, in a steady climb.
AirCourse fly_circle(double course_rad, double height_m, double bank_rad,
                     double climb_angle_rad = 0.0);
/// Lanes of 260 m with a U-turn between them, to the right and to the left by turns, each turn two
/// corners of 90 deg with 24 m between them; heights of ramps with kinks. The reference's own bank
/// is at most `bank_rad`, with 60 deg/s and a lag of 0.45 s (reference of paper A, section 2).
AirCourse fly_lanes(int lanes, double bank_rad = 35.0 * M_PI / 180.0);

struct AircraftSetup {
  AircraftNumbers numbers;
  std::optional<AircraftNumbers> assumed;  ///< description for the controller; default: the truth
  PartChoice controller{"fixed_wing_pid", {}};
  double rate_Hz = 0.0;  ///< of the controller and of the loop; 0: its own
  Duration physics{5'000'000};
  AirCourse reference = fly_straight(0.0, 100.0);
  WindField wind;
  /// From where the reference is in steady flight, angles of aviation.
  double higher_m = 0.0, faster_mps = 0.0, roll_rad = 0.0, pitch_rad = 0.0, turned_rad = 0.0;
};

class AircraftLoop : public Loop {
 public:
  explicit AircraftLoop(const AircraftSetup& setup);

  const AircraftSim& sim() const { return sim_; }
  AircraftSim& sim() { return sim_; }
  /// An entry of "deviation" by its name.
  double deviation(const std::string& name) const { return value("deviation", name); }
  const AirReference& reference() const { return read<AirReference>("reference"); }

 private:
  AircraftSim sim_;
};

/// Mean wind and, along the fixed direction `along_rad` from east, a Gauss-Markov gust of sigma
/// bound / 2 with a length of 60 m at 12 m/s, cut at the bound (reference of paper A, section 1).
WindField markov_wind(const Eigen::Vector3d& mean_W, double bound_mps, double along_rad,
                      double longest_s, std::uint64_t seed);

/// Gusts along the body's axes (AircraftSim::set_body_gust()) of the reference of paper A:
/// Gauss-Markov (60 m at 12 m/s, sigma 0.5 m/s) along a fixed direction, clipped to 1 m/s, times
/// `strength`; drawn once a tick of 0.05 s.
class GaussMarkovGust {
 public:
  explicit GaussMarkovGust(std::uint64_t seed, double strength = 1.0);
  Eigen::Vector3d next();

 private:
  RandomStream random_;
  Eigen::Vector3d direction_;
  double strength_, value_;
};

}  // namespace vinerow::test

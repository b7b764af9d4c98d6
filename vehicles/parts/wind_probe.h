#pragma once
/// Wind and air density at one vehicle: mean wind by the world's height law, Dryden turbulence,
/// 1-cosine gusts and shelter between the rows. Formulae, sources and figures: docs/models/wind.md.
///
/// Every part that needs the wind has its own probe: turbulence is drawn along the vehicle's path
/// through the air (frozen field), so that neighbours do not share it. Mean wind and gusts belong
/// to the world and are the same for all probes.
///
/// Outside the terrain the height of its edge continues. Above a mesh ground with nothing below,
/// the last known height is used (0 at first).
///
/// Cost: below 0.3 us per step on a height field; a mesh ground adds one ray every kTurbulenceTick.
/// No heap after construction, no wall clock, no global state: the same world, stream and calls
/// give the same bits.

#include <Eigen/Core>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/api/wind_field.h"
#include "engine/core/random.h"
#include "engine/core/time.h"
#include "vehicles/parts/dryden.h"
#include "vehicles/parts/wind_gusts.h"
#include "vehicles/parts/wind_shelter.h"

namespace vinerow::vehicles {

/// Wind at 20 ft that sets the turbulence: the given one, else the mean wind there.
double turbulence_wind_mps(const Wind& wind);

/// Density before any sample: of a constant atmosphere everywhere, of the standard one
/// at a height of W, kg/m3.
double calc_air_density_kgm3(const WorldModel& world, double z_m);

class WindProbe {
 public:
  /// Interval of the turbulence's knots, between which it is linear, for any physics step.
  static constexpr Duration kTurbulenceTick{5'000'000};

  /// @throws ConfigError as validate(Wind)
  /// @param world,scene  must outlive the probe
  /// @param random  the vehicle's own stream, VehicleContext.random("wind")
  WindProbe(const WorldModel& world, const SceneQuery& scene, RandomStream random);

  /// Wind at the vehicle now. Turbulence advances by the distance through the air since the last
  /// call. Called once per physics step, with time that does not decrease. A vehicle that drifts
  /// with the mean wind still meets new eddies at the speed sigma_u (an eddy lives about
  /// L / sigma).
  /// @param p_W  position, m  @param v_W  velocity of the vehicle, m/s
  /// @param dt  time since the last call (the physics step)
  /// @returns in W, m/s; exactly zero where calm(). Valid until the next call
  const Eigen::Vector3d& sample(Time now, const Eigen::Vector3d& p_W, const Eigen::Vector3d& v_W,
                                Duration dt);

  /// True if there is never any wind and density is uniform: sample() need not be called.
  bool calm() const { return calm_ && wind_->atmosphere == Atmosphere::kConstant; }
  /// At the position of the last sample; before the first at W's origin.
  double air_density_kgm3() const { return density_kgm3_; }

  /// The last sample, in W, m/s.
  const Eigen::Vector3d& wind_W() const { return wind_W_; }
  /// Its components, after shelter; their sum is the sample.
  const Eigen::Vector3d& mean_W() const { return mean_W_; }
  const Eigen::Vector3d& gust_W() const { return gust_W_; }
  const Eigen::Vector3d& turbulence_W() const { return turbulence_W_; }

 private:
  void find_ground(const Eigen::Vector3d& p_W, bool tick);
  void move_knots(Time now, double height_m, double airspeed_mps);

  const Wind* wind_;
  double origin_altitude_m_;
  double density_kgm3_;
  const HeightField* terrain_;
  const SceneQuery* scene_;
  bool calm_;
  Eigen::Vector2d downwind_;  // unit, direction towards which the mean wind blows
  WindShelter shelter_;
  RandomGusts random_gusts_;
  DrydenTurbulence turbulence_;
  double wind_20ft_mps_;  // times Wind::turbulence; 0: no turbulence
  double ground_m_ = 0.0;

  // Turbulence along, left of and above the mean wind at two knots, m/s.
  Eigen::Vector3d knot_ = Eigen::Vector3d::Zero(), next_knot_ = Eigen::Vector3d::Zero();
  Time knot_time_, next_time_;
  bool started_ = false;
  double distance_m_ = 0.0;  // through the air since the last knot
  double slowest_mps_ = 0.0;

  Eigen::Vector3d mean_W_ = Eigen::Vector3d::Zero(), gust_W_ = Eigen::Vector3d::Zero(),
                  turbulence_W_ = Eigen::Vector3d::Zero(), wind_W_ = Eigen::Vector3d::Zero();
};

}  // namespace vinerow::vehicles

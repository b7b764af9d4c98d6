#include "vehicles/parts/wind_probe.h"

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/math/standard_atmosphere.h"

namespace vinerow::vehicles {
namespace {

constexpr double kTwentyFeet_m = 6.096;

const Wind* checked(const Wind& wind) {
  validate(wind);
  return &wind;
}

Eigen::Vector3d horizontal(double speed_mps, const Eigen::Vector2d& direction) {
  return {speed_mps * direction.x(), speed_mps * direction.y(), 0.0};
}

}  // namespace

double turbulence_wind_mps(const Wind& wind) {
  return wind.turbulence_wind_mps ? *wind.turbulence_wind_mps
                                  : std::abs(mean_wind_mps(wind, kTwentyFeet_m));
}

double calc_air_density_kgm3(const WorldModel& world, double z_m) {
  const double altitude_m = world.origin.altitude_m;
  if (world.wind.atmosphere == Atmosphere::kStandard76) {
    return calc_standard_density_kgm3(altitude_m + z_m);
  }
  if (world.wind.air_density_kgm3) return *world.wind.air_density_kgm3;
  // The standard's own number, which its formula meets to rounding.
  constexpr double kSeaLevelDensity_kgm3 = 1.225;
  return altitude_m == 0.0 ? kSeaLevelDensity_kgm3 : calc_standard_density_kgm3(altitude_m);
}

WindProbe::WindProbe(const WorldModel& world, const SceneQuery& scene, RandomStream random)
    : wind_(checked(world.wind)),
      origin_altitude_m_(world.origin.altitude_m),
      density_kgm3_(calc_air_density_kgm3(world, 0.0)),
      terrain_(world.terrain ? &*world.terrain : nullptr),
      scene_(&scene),
      calm_(wind_->calm()),
      downwind_(downwind_direction(wind_->from_azimuth_rad)),
      shelter_(world.rows, calm_ ? 0.0 : wind_->shelter_attenuation),
      random_gusts_(*wind_),
      turbulence_(random),
      wind_20ft_mps_(wind_->turbulence * turbulence_wind_mps(*wind_)) {}

void WindProbe::find_ground(const Eigen::Vector3d& p_W, bool tick) {
  if (terrain_) {
    ground_m_ = terrain_->height_m(p_W.x(), p_W.y());
  } else if (tick) {
    ground_m_ = scene_->ground_height_m(p_W.x(), p_W.y(), p_W.z()).value_or(ground_m_);
  }
}

void WindProbe::move_knots(Time now, double height_m, double airspeed_mps) {
  const DrydenScales scales = calc_dryden_scales(height_m, wind_20ft_mps_);
  const auto reach_next = [&](double distance_m) {
    knot_ = next_knot_;
    if (wind_20ft_mps_ <= 0.0) return;
    turbulence_.advance(distance_m, scales);
    next_knot_ = turbulence_.unit().cwiseProduct(
        Eigen::Vector3d(scales.sigma_uv_mps, scales.sigma_uv_mps, scales.sigma_w_mps));
  };
  slowest_mps_ = scales.sigma_uv_mps;
  airspeed_mps = std::max(airspeed_mps, slowest_mps_);
  if (!started_) {
    started_ = true;
    reach_next(0.0);  // the steady state it starts in
    reach_next(airspeed_mps * kTurbulenceTick.s());
    knot_time_ = now;
    next_time_ = now + kTurbulenceTick;
    distance_m_ = 0.0;
    return;
  }
  // What was flown beyond the knot counts for the next one.
  const double beyond_m = std::min(distance_m_, airspeed_mps * (now - next_time_).s());
  const bool skipped = now >= next_time_ + kTurbulenceTick;
  reach_next(skipped ? distance_m_ : distance_m_ - beyond_m);
  distance_m_ = skipped ? 0.0 : beyond_m;
  knot_time_ = skipped ? now : next_time_;
  next_time_ = knot_time_ + kTurbulenceTick;
}

const Eigen::Vector3d& WindProbe::sample(Time now, const Eigen::Vector3d& p_W,
                                         const Eigen::Vector3d& v_W, Duration dt) {
  if (wind_->atmosphere == Atmosphere::kStandard76) {
    density_kgm3_ = calc_standard_density_kgm3(origin_altitude_m_ + p_W.z());
  }
  if (calm_) return wind_W_;
  const bool tick = !started_ || now >= next_time_;
  find_ground(p_W, tick);
  const double height_m = p_W.z() - ground_m_;
  const Eigen::Vector2d place = p_W.head<2>();

  // Below the canopy's top the profile of the canopy takes the place of the height law.
  const ShelterSpot spot = shelter_.spot(place);
  double law_height_m = height_m;
  if (spot.inside > 0.0 && height_m < spot.top_m) {
    const double above_m = std::max(0.0, height_m);
    law_height_m = above_m + spot.inside * (spot.top_m - above_m);
  }
  const ShelterFactors left = shelter_.factors(spot, height_m);
  mean_W_ = left.apply(horizontal(mean_wind_mps(*wind_, law_height_m), downwind_), spot.axis);

  gust_W_.setZero();
  for (const WindGust& gust : wind_->gusts) gust_W_ += calc_gust_W(*wind_, gust, now.s(), place);
  if (!random_gusts_.none()) {
    gust_W_ += calc_gust_W(*wind_, random_gusts_.at(now.s()), now.s(), place);
  }

  const double airspeed_mps = (v_W - mean_W_).norm();
  distance_m_ += std::max(airspeed_mps, slowest_mps_) * dt.s();
  if (tick) move_knots(now, height_m, airspeed_mps);
  if (wind_20ft_mps_ > 0.0) {
    const double share = static_cast<double>((now - knot_time_).ns) /
                         static_cast<double>((next_time_ - knot_time_).ns);
    Eigen::Vector3d uvw = knot_ + share * (next_knot_ - knot_);
    const double longest_mps = wind_->turbulence_limit_mps, length_mps = uvw.norm();
    if (longest_mps > 0.0 && length_mps > longest_mps) uvw *= longest_mps / length_mps;
    turbulence_W_ = {uvw.x() * downwind_.x() - uvw.y() * downwind_.y(),
                     uvw.x() * downwind_.y() + uvw.y() * downwind_.x(), uvw.z()};
  }

  if (spot.inside > 0.0) {
    gust_W_ = left.apply(gust_W_, spot.axis);
    turbulence_W_ = left.apply(turbulence_W_, spot.axis);
  }
  wind_W_ = mean_W_ + gust_W_ + turbulence_W_;
  return wind_W_;
}

}  // namespace vinerow::vehicles

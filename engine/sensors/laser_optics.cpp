#include "engine/sensors/laser_optics.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "engine/core/constants.h"
#include "engine/core/random.h"

namespace vinerow::sensors {
namespace {

const ParameterTable<LaserReflectances>& laser_reflectance_table() {
  using P = LaserReflectances;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("canopy_reflectance", "", &P::canopy, between(0.0, 1.0),
                  "near-infrared reflectance of leaves")
          .number("ground_reflectance", "", &P::ground, between(0.0, 1.0),
                  "near-infrared reflectance of soil and grass")
          .number("stem_reflectance", "", &P::stem, between(0.0, 1.0),
                  "near-infrared reflectance of posts and trunks")
          .number("obstacle_reflectance", "", &P::obstacle, between(0.0, 1.0),
                  "near-infrared reflectance of everything else");
  return table;
}

std::string find_fault_in_laser_range(const LaserRanging& p) {
  if (p.min_range_m < p.max_range_m) return "";
  return fmt::format("min_range_m = {} m, must be < max_range_m = {} m", p.min_range_m,
                     p.max_range_m);
}

}  // namespace

const ParameterTable<LaserRanging>& laser_ranging_table() {
  using P = LaserRanging;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("min_range_m", "m", &P::min_range_m, above(0.0, 1e4),
                  "shortest distance it reports")
          .number("max_range_m", "m", &P::max_range_m, above(0.0, 1e4),
                  "longest distance it reports")
          .number("accuracy_m", "m", &P::accuracy_m, between(0.0, 10.0),
                  "largest constant error; the device's own is drawn once, uniformly")
          .number("noise_std_m", "m", &P::noise_std_m, between(0.0, 10.0),
                  "white noise of a range at 0 m")
          .number("noise_growth", "m/m", &P::noise_growth, between(0.0, 1.0),
                  "growth of that noise with distance")
          .number("dark_range_m", "m", &P::dark_range_m, kPositive,
                  "distance at which a surface of 10 % reflectance at normal incidence is detected "
                  "nine times in ten; large: nothing is lost")
          .number("beam_dropout_share", "", &P::beam_dropout_share, between(0.0, 1.0),
                  "share of the beams that are lost at random")
          .include(&P::reflectances, laser_reflectance_table())
          .rule(find_fault_in_laser_range);
  return table;
}

double draw_offset_m(const LaserRanging& ranging, const PartContext& context) {
  return context.random("offset").uniform(-ranging.accuracy_m, ranging.accuracy_m);
}

LaserOptics::LaserOptics(const LaserRanging& ranging, double offset_m)
    : ranging_(ranging), offset_m_(offset_m) {
  const LaserReflectances& reflectances = ranging.reflectances;
  reflectance_.fill(reflectances.obstacle);
  const auto of = [&](SurfaceClass surface) -> double& {
    return reflectance_[static_cast<std::size_t>(surface)];
  };
  of(SurfaceClass::kCanopy) = reflectances.canopy;
  of(SurfaceClass::kTerrain) = reflectances.ground;
  of(SurfaceClass::kPost) = reflectances.stem;
  of(SurfaceClass::kTrunk) = reflectances.stem;
}

double LaserOptics::power(const RayHit& hit, const Eigen::Vector3d& dir_W) const {
  const double ratio = ranging_.dark_range_m / std::max(hit.distance_m, ranging_.min_range_m);
  const double reflectance = reflectance_[static_cast<std::size_t>(hit.surface)];
  return 10.0 * reflectance * std::max(0.0, -hit.normal_W.dot(dir_W)) * ratio * ratio;
}

double LaserOptics::apparent_reflectance(double power, double distance_m) const {
  const double ratio = std::max(distance_m, ranging_.min_range_m) / ranging_.dark_range_m;
  return 0.1 * power * ratio * ratio;
}

double LaserOptics::reading_m(double distance_m, double noise) const {
  const double std_m = ranging_.noise_std_m + ranging_.noise_growth * distance_m;
  const double reading_m = distance_m + offset_m_ + std_m * noise;
  const bool is_outside = reading_m < ranging_.min_range_m || reading_m > ranging_.max_range_m;
  return is_outside ? kInfinity : reading_m;
}

double LaserOptics::detection_probability(double power) {
  const double fourth = power * power * power * power;
  return fourth / (fourth + 1.0 / 9.0);
}

}  // namespace vinerow::sensors

#include "engine/sensors/ultrasound.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "engine/api/messages/sensors.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/sensors/echo.h"
#include "engine/sensors/mounted_sensor.h"
#include "engine/sensors/resolution.h"
#include "engine/sensors/sound_cone.h"

// Plan of one tick, with r the true distance of a return:
//
//   draw_fate     noise n, missed and false echoes: always the same count of random numbers
//   turn_         does the sensor fire at this tick?
//   shortest_m    without a threshold: r = smallest hit of the rays
//   listen        with a threshold: r = first return that is strong enough (echo.h); of ray i
//                   strength_i = share_i spreading(r_i) surface_echo_i
//                   share_i    = solid angle_i pattern_i / sum_k (solid angle_k pattern_k)
//   reading_of    reading = round(scale r + n)
//
// The sensor measures the travel time 2 r / c_air and multiplies it by c_assumed / 2. The speed of
// sound c grows with the square root of the absolute temperature T, so
//   scale = c_assumed / c_air = sqrt(T_assumed / T_air).

namespace vinerow::sensors {
namespace {

constexpr double kFreezing_K = 273.15;  // 0 degC

/// Defaults: HC-SR04 data sheet (2 cm to 4 m, 3 mm, 15 degrees effective cone); other errors are
/// zero. assets/sensors/hc_sr04.yaml has a realistic sensor.
struct UltrasoundParams {
  double half_angle_rad = rad_from_deg(15.0);
  int rings = 2;
  double min_range_m = 0.02;
  double max_range_m = 4.0;
  bool is_uniform = false;
  double accuracy_m = 0.003;
  double noise_std_m = 0.003;
  double resolution_m = 0.0;
  double air_temperature_degC = 20.0;
  double assumed_temperature_degC = 20.0;
  double missed_share = 0.0;
  double false_share = 0.0;
  EchoParams echo;
  double cycle_s = 0.0;
  double phase_s = 0.0;
};

std::string find_fault_in_sound_range(const UltrasoundParams& p) {
  if (p.min_range_m < p.max_range_m) return "";
  return fmt::format("min_range_m = {} m, must be < max_range_m = {} m", p.min_range_m,
                     p.max_range_m);
}

const ParameterTable<UltrasoundParams>& ultrasound_table() {
  using P = UltrasoundParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .degrees("half_angle_deg", &P::half_angle_rad, between(0.0, 80.0),
                   "half angle of the cone; 0 = a single ray")
          .integer("rings", &P::rings, between(0, 64), "rings of rays around the axis")
          .number("min_range_m", "m", &P::min_range_m, above(0.0, 1e4),
                  "shortest distance it reports")
          .number("max_range_m", "m", &P::max_range_m, above(0.0, 1e4),
                  "longest distance it reports")
          .choice("error", &P::is_uniform, {{"uniform", true}, {"gaussian", false}},
                  "distribution of the noise; paper C's accuracy is uniform")
          .number("accuracy_m", "m", &P::accuracy_m, between(0.0, 10.0), "uniform: largest error")
          .number("noise_std_m", "m", &P::noise_std_m, between(0.0, 10.0),
                  "gaussian: white noise of the reading")
          .number("resolution_m", "m", &P::resolution_m, between(0.0, 1.0),
                  "readings are multiples of it; 0: all values")
          .number("air_temperature_degC", "degC", &P::air_temperature_degC, between(-60.0, 80.0),
                  "temperature of the true air")
          .number("assumed_temperature_degC", "degC", &P::assumed_temperature_degC,
                  between(-60.0, 80.0), "temperature for which the sensor's speed of sound holds")
          .number("missed_share", "", &P::missed_share, between(0.0, 1.0),
                  "share of the echoes that are missed")
          .number("false_share", "", &P::false_share, between(0.0, 1.0),
                  "share of the readings that are a false echo, uniform between the shortest "
                  "range and the true echo")
          .include(&P::echo, echo_table())
          .number("cycle_s", "s", &P::cycle_s, between(0.0, 10.0),
                  "time between pulses, a multiple of the period; 0: one at every tick")
          .number("phase_s", "s", &P::phase_s, between(0.0, 10.0),
                  "time of the first pulse, a multiple of the period below cycle_s, for rangers "
                  "that fire in turn")
          .rule(find_fault_in_sound_range);
  return table;
}

/// Firing schedule: phase, phase + cycle, phase + 2 cycle ... after the sensor's first tick. Ticks
/// need not be at multiples of the period: vehicles tick one after the other, from the start of
/// their phase of a mission.
struct Turn {
  Duration cycle;
  Duration phase;
  Duration period;
  std::int64_t ticks = 0;

  /// True if the sensor fires at this tick. Call it exactly once per tick.
  bool is_now() {
    const std::int64_t since_first_ns = ticks++ * period.ns;
    return cycle.ns == 0 || since_first_ns % cycle.ns == phase.ns;
  }
};

Turn make_turn(const UltrasoundParams& params, const std::string& who, Duration period) {
  const double cycle_s = params.cycle_s, phase_s = params.phase_s;
  const Turn turn{duration_from_s(cycle_s), duration_from_s(phase_s), period};
  const auto check_ticks = [&](const char* name, Duration value, double value_s) {
    if (value.ns % period.ns == 0) return;
    throw ConfigError(
        fmt::format("{}: {} = {} s, must be a multiple of the sensor's period of {} s", who, name,
                    value_s, period.s()));
  };
  check_ticks("cycle_s", turn.cycle, cycle_s);
  check_ticks("phase_s", turn.phase, phase_s);
  if (turn.phase.ns > 0 && turn.phase.ns >= turn.cycle.ns) {
    throw ConfigError(
        fmt::format("{}: phase_s = {} s, must be < cycle_s = {} s", who, phase_s, cycle_s));
  }
  return turn;
}

class Ultrasound final : public MountedSensor<RangeSample> {
 public:
  Ultrasound(const ParameterSet& parameters, const SensorContext& context)
      : Ultrasound(ultrasound_table().read(parameters, ""), parameters, context) {}
  Ultrasound(const UltrasoundParams& params, const ParameterSet& parameters,
             const SensorContext& context)
      : MountedSensor(parameters, context),
        scene_(context.scene),
        turn_(make_turn(params, context.part, context.period)),
        noise_(context.random()),
        faults_(context.random("faults")),
        half_angle_rad_(params.half_angle_rad),
        min_range_m_(params.min_range_m),
        max_range_m_(params.max_range_m),
        is_uniform_(params.is_uniform),
        accuracy_m_(params.accuracy_m),
        noise_std_m_(params.noise_std_m),
        resolution_m_(params.resolution_m),
        // scale = sqrt(T_assumed / T_air), see above.
        scale_(std::sqrt((kFreezing_K + params.assumed_temperature_degC) /
                         (kFreezing_K + params.air_temperature_degC))),
        missed_share_(params.missed_share),
        false_share_(params.false_share),
        echo_(params.echo),
        rays_(cone_rays(half_angle_rad_, params.rings)) {
    // Weights the shares of the solid angle by the beam pattern; their sum stays 1.
    double sum = 0.0;
    for (const ConeRay& ray : rays_) sum += ray.share * beam_pattern(echo_, ray.off_axis_rad);
    for (ConeRay& ray : rays_) ray.share *= beam_pattern(echo_, ray.off_axis_rad) / sum;
    returns_.reserve(rays_.size());
  }

  void step(Time now) override {
    // Always draw the same count, so that later readings do not depend on what the sensor detects.
    const Fate fate = draw_fate();
    if (!turn_.is_now()) {
      readings_.push_nothing();
      return;
    }
    RangeSample truth;
    truth.min_range_m = min_range_m_;
    truth.max_range_m = max_range_m_;
    truth.half_angle_rad = half_angle_rad_;
    truth.X_WS = X_WS();
    RangeSample sample = truth;
    double echo_m;
    if (echo_.threshold > 0.0) {
      echo_m = listen(truth.X_WS, truth.range_m);
    } else {
      echo_m = truth.range_m = shortest_m(truth.X_WS);
    }
    sample.range_m = readings_.is_in_outage(now) ? kInfinity : reading_of(echo_m, fate);
    readings_.push(now, sample, truth);
  }

 private:
  /// Random effects on one reading.
  struct Fate {
    double noise_m;
    bool is_missed;
    bool is_false;
    double false_place;  ///< position between the shortest range and the true echo, 0 to 1
  };

  Fate draw_fate() {
    Fate fate;
    fate.noise_m =
        is_uniform_ ? noise_.uniform(-accuracy_m_, accuracy_m_) : noise_std_m_ * noise_.normal();
    fate.is_missed = faults_.uniform() < missed_share_;
    fate.is_false = faults_.uniform() < false_share_;
    fate.false_place = faults_.uniform();
    return fate;
  }

  /// Casts the rays of the cone, a few together: those that follow are only `after_m` longer than
  /// the shortest hit so far.
  /// @param use  called with (ray, its direction in W, hit) for each that meets something
  /// @returns the shortest hit; infinity without a hit
  template <class Use>
  double cast_cone(const Pose& X_WS, double after_m, Use&& use) const {
    constexpr std::size_t kTogether = 8;
    std::array<SceneRay, kTogether> rays;
    std::array<std::optional<RayHit>, kTogether> hits;
    double nearest_m = kInfinity;
    for (std::size_t at = 0; at < rays_.size(); at += kTogether) {
      const std::size_t count = std::min(kTogether, rays_.size() - at);
      const double reach_m = std::min(nearest_m + after_m, max_range_m_);
      for (std::size_t i = 0; i < count; ++i) {
        rays[i] = {X_WS.p, X_WS.q * rays_[at + i].dir_S, reach_m};
      }
      scene_->cast_rays(std::span(rays).first(count), std::span(hits).first(count));
      for (std::size_t i = 0; i < count; ++i) {
        if (!hits[i]) continue;
        nearest_m = std::min(nearest_m, hits[i]->distance_m);
        use(rays_[at + i], rays[i].dir_W, *hits[i]);
      }
    }
    return nearest_m;
  }

  double shortest_m(const Pose& X_WS) const {
    return cast_cone(X_WS, 0.0, [](const ConeRay&, const Eigen::Vector3d&, const RayHit&) {});
  }

  /// Distance of the first return that is strong enough. @param nearest_m  set to the shortest hit
  double listen(const Pose& X_WS, double& nearest_m) {
    // A return more than a pulse behind the shortest hit cannot add to it. Cast the rays that far
    // first; the full range is needed only if the shortest hit is too weak.
    const double first_m = listen_up_to(X_WS, echo_.pulse_m, nearest_m);
    if (first_m == nearest_m) return first_m;
    return listen_up_to(X_WS, max_range_m_, nearest_m);
  }

  /// The same; of returns farther than `after_m` behind the shortest hit some are missing.
  double listen_up_to(const Pose& X_WS, double after_m, double& nearest_m) {
    returns_.clear();
    nearest_m = cast_cone(
        X_WS, after_m, [&](const ConeRay& ray, const Eigen::Vector3d& dir_W, const RayHit& hit) {
          // Below the shortest range the strength stays that of the shortest range: it grows with
          // r^-2.
          const double distance_m = std::max(hit.distance_m, min_range_m_);
          returns_.push_back(
              {hit.distance_m, ray.share * echo_spreading(echo_, distance_m) *
                                   surface_echo(echo_, hit.surface, -hit.normal_W.dot(dir_W))});
        });
    return first_echo_m(echo_, returns_);
  }

  double reading_of(double echo_m, const Fate& fate) const {
    // A false echo is uniform between the shortest range and the true echo.
    if (fate.is_false) {
      const double until_m = std::max(min_range_m_, std::min(echo_m, max_range_m_));
      return min_range_m_ + fate.false_place * (until_m - min_range_m_);
    }
    if (fate.is_missed || !std::isfinite(echo_m)) return kInfinity;
    const double reading_m = round_to_step(scale_ * echo_m + fate.noise_m, resolution_m_);
    return reading_m > max_range_m_ ? kInfinity : std::max(min_range_m_, reading_m);
  }

  const SceneQuery* scene_;
  Turn turn_;
  RandomStream noise_;
  RandomStream faults_;
  double half_angle_rad_;
  double min_range_m_;
  double max_range_m_;
  bool is_uniform_;
  double accuracy_m_;
  double noise_std_m_;
  double resolution_m_;
  double scale_;
  double missed_share_;
  double false_share_;
  EchoParams echo_;
  std::vector<ConeRay> rays_;  ///< shares include the beam pattern; their sum is 1
  std::vector<EchoReturn> returns_;
};

}  // namespace

PartSpec ultrasound_spec() {
  return mounted_sensor_spec<RangeSample>(
      "ultrasound",
      "Ultrasonic ranger: first return in a cone of rays, with noise, echo strength, missed and "
      "false echoes",
      20.0, ultrasound_table());
}

std::unique_ptr<Sensor> make_ultrasound(const ParameterSet& parameters,
                                        const SensorContext& context) {
  return std::make_unique<Ultrasound>(parameters, context);
}

}  // namespace vinerow::sensors

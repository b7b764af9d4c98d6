#include "engine/sensors/lidar_3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "engine/api/messages/sensors.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/math/angles.h"
#include "engine/sensors/blindness.h"
#include "engine/sensors/camera/thing_numbers.h"
#include "engine/sensors/laser_optics.h"
#include "engine/sensors/mounted_sensor.h"
#include "engine/sensors/resolution.h"
#include "engine/sensors/scan_links.h"
#include "engine/sensors/scan_pattern.h"

namespace vinerow::sensors {
namespace {

constexpr int kMaxSubRays3d = 19;
constexpr int kSlices = 20;

enum class Returns { kStrongest, kLast, kDual };

struct Lidar3dParams {
  ScanPatternParams pattern;
  std::optional<int> slices;  ///< default: as many as divide the period, up to kSlices
  LaserRanging ranging{
      .min_range_m = 0.5, .max_range_m = 100.0, .noise_std_m = 0.02, .dark_range_m = 40.0};
  double divergence_rad = 0.0;
  int sub_rays = 1;
  double pulse_m = 0.75;
  Returns returns = Returns::kStrongest;
  double resolution_m = 0.0;
  bool organised = false;
  bool labels = false;
};

std::string find_fault_in_grid(const Lidar3dParams& p) {
  if (!p.organised) return "";
  if (p.pattern.is_rosette || p.pattern.column_s > 0.0) {
    return "organised = true, which only a spinning pattern with columns can have; set it to false";
  }
  if (p.returns != Returns::kDual) return "";
  return "organised = true, which has one point of each pulse; set returns to strongest or last";
}

const ParameterTable<Lidar3dParams>& lidar_3d_table() {
  using P = Lidar3dParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .include(&P::pattern, scan_pattern_table())
          .integer("slices", &P::slices, between(1, 1000),
                   fmt::format("times in a period at which its pose is taken; in between it moves "
                               "evenly; default: the largest number up to {} that cuts the period "
                               "into whole physics steps",
                               kSlices))
          .include(&P::ranging, laser_ranging_table())
          .degrees("divergence_deg", &P::divergence_rad, between(0.0, 5.0),
                   "full width of a beam, which takes sub_rays > 1")
          .integer("sub_rays", &P::sub_rays, between(1, kMaxSubRays3d),
                   "rays of a beam: the middle, and the others on a circle about it")
          .number("pulse_m", "m", &P::pulse_m, kPositive,
                  "surfaces of a beam closer together than this make one echo")
          .choice("returns", &P::returns,
                  {{"strongest", Returns::kStrongest},
                   {"last", Returns::kLast},
                   {"dual", Returns::kDual}},
                  "echoes of a pulse that are reported")
          .number("resolution_m", "m", &P::resolution_m, between(0.0, 1.0),
                  "step of a range; 0: none")
          .boolean("organised", &P::organised,
                   "true: clouds have rows, the highest laser first, and columns of one azimuth, "
                   "with a point for each pulse, also where nothing was seen")
          .boolean("labels", &P::labels,
                   "true: points have the label and the number of what they are on, as pixels of "
                   "cameras")
          .rule(find_fault_in_grid);
  return table;
}

/// Time between two poses. @throws ConfigError if the period has no such slices
Duration sampling_of(const Lidar3dParams& params, const SensorContext& context) {
  const std::int64_t step = std::max<std::int64_t>(context.physics_step.ns, 1);
  const auto is_cut_by = [&](int slices) { return context.period.ns % (slices * step) == 0; };
  int slices = params.slices.value_or(kSlices);
  while (!params.slices && slices > 1 && !is_cut_by(slices)) --slices;
  if (is_cut_by(slices)) return {context.period.ns / slices};
  throw ConfigError(fmt::format(
      "{}: slices = {} cut its period of {:g} s into {:g} s, must be a multiple of the physics "
      "step of {:g} s",
      context.part, slices, context.period.s(), context.period.s() / slices,
      context.physics_step.s()));
}

/// What a ray met, if points have labels.
struct MetThing {
  Label label = Label::kSky;
  std::uint32_t number = ThingNumbers::kNothing;
  bool operator==(const MetThing&) const = default;
};

struct Echo3d {
  double distance_m = 0.0;
  double power = 0.0;
  MetThing thing;  ///< that returned most of it
};

class Lidar3d final : public MountedSensor<PointCloud>, public LooksOut {
 public:
  Lidar3d(const ParameterSet& parameters, const SensorContext& context)
      : Lidar3d(lidar_3d_table().read(parameters, context.part), parameters, context) {}
  Lidar3d(const Lidar3dParams& params, const ParameterSet& parameters, const SensorContext& context)
      : MountedSensor(parameters, context),
        params_(params),
        vehicle_(context.vehicle),
        world_(context.world),
        light_(&context.light()),
        find_vehicles_(context.vehicles),
        sampling_(sampling_of(params, context)),
        pattern_(make_scan_pattern(params.pattern, context.period.s(), context.part)),
        optics_(params.ranging, draw_offset_m(params.ranging, context)),
        random_(context.random()) {
    if (params.labels) numbers_.emplace(world_->meshes);
    for (int ray = 1; ray < params.sub_rays; ++ray) {
      // Half of the beam's area lies inside of this circle.
      constexpr double kHalfArea = 0.7;
      const double width = std::tan(0.5 * params.divergence_rad) * kHalfArea;
      const double angle = 2.0 * kPi * (ray - 1) / (params.sub_rays - 1);
      asides_.emplace_back(width * std::cos(angle), width * std::sin(angle));
    }
    // As large as a frame can be, so that none allocates memory.
    const std::size_t pulses = pattern_->most_pulses();
    rays_.reserve(pulses * static_cast<std::size_t>(params.sub_rays));
    hits_.reserve(rays_.capacity());
    if (find_vehicles_) {
      own_rays_.reserve(rays_.capacity());
      link_hits_.reserve(rays_.capacity());
    }
    order_.reserve(pulses);
    first_ray_.reserve(pulses);
    if (params.organised) {
      lay_out_rows();
      cloud_ = true_cloud_ = empty_;
      readings_.prefill(cloud_);
      return;
    }
    resize(cloud_, params.returns == Returns::kDual ? 2 * pulses : pulses);
    resize(true_cloud_, pulses);
    readings_.prefill(cloud_);
    resize(cloud_, 0);
    resize(true_cloud_, 0);
  }

  Duration sampling() const override { return sampling_; }

  void check_view(const Pose& X_WB) override { look_out(X_WB * X_BS_); }

  void sample(Time now) override {
    const Pose X_WS_now = X_WS();
    if (begin_) {
      cast_until(now, X_WS_now);
    } else {
      look_out(X_WS_now);
    }
    last_ = now;
    last_X_WS_ = X_WS_now;
    if (!begin_) begin_frame(now);
  }

  void step(Time now) override {
    if (*begin_ == now) {
      // The first frame only begins.
      readings_.push_nothing();
      return;
    }
    readings_.push(*begin_, cloud_, true_cloud_);
    ++frame_;
    begin_frame(now);
  }

 private:
  void resize(PointCloud& cloud, std::size_t count) const {
    for (std::vector<float>* list :
         {&cloud.x, &cloud.y, &cloud.z, &cloud.intensity, &cloud.time_s}) {
      list->resize(count);
    }
    cloud.ring.resize(count);
    cloud.return_number.resize(count);
    if (!numbers_) return;
    cloud.label.resize(count);
    cloud.instance.resize(count);
  }

  /// Rows of an organised cloud: of each ring its row, and a cloud in which nothing was seen. The
  /// pulses of all frames are the same.
  void lay_out_rows() {
    pulses_ = pattern_->pulses(0);
    const std::size_t lasers = params_.pattern.elevations_deg.size();
    columns_ = pattern_->most_pulses() / lasers - 1;
    empty_.rows = static_cast<std::uint32_t>(lasers);
    resize(empty_, lasers * columns_);
    for (std::size_t i = 0; i < empty_.ring.size(); ++i) {
      empty_.ring[i] = static_cast<std::uint16_t>(i / columns_);
    }
    for (const LaserPulse& pulse : pulses_) {
      empty_.time_s[place_of(pulse)] = static_cast<float>(pulse.time_s);
    }
  }

  /// Of a pulse in an organised cloud.
  std::size_t place_of(const LaserPulse& pulse) const {
    return (empty_.rows - 1u - pulse.ring) * columns_ + pulse.column;
  }

  /// Before the first pulse.
  void look_out(const Pose& X_WS_now) {
    if (find_vehicles_) links_.emplace(find_vehicles_(), vehicle_);
    const std::string reason =
        find_blindness(X_WS_now, *world_, *light_, links_ ? &links_->scene() : nullptr);
    if (reason.empty()) return;
    throw ConfigError(fmt::format("the scanner {}: change its position_m", reason));
  }

  void begin_frame(Time now) {
    begin_ = now;
    next_pulse_ = 0;
    pulses_ = pattern_->pulses(frame_);
    if (params_.organised) {
      cloud_ = true_cloud_ = empty_;
      return;
    }
    resize(cloud_, 0);
    resize(true_cloud_, 0);
  }

  /// Pulses between the last sample and this one.
  void cast_until(Time now, const Pose& X_WS_now) {
    const double from_s = (last_ - *begin_).s(), to_s = (now - *begin_).s();
    const std::size_t first = next_pulse_;
    while (next_pulse_ < pulses_.size() && pulses_[next_pulse_].time_s < to_s) ++next_pulse_;
    order_.resize(next_pulse_ - first);
    std::iota(order_.begin(), order_.end(), first);
    // Ring by ring: a scanner fires its lasers far apart, and rays side by side cost half as much.
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(pulses_[a].ring, a) < std::pair(pulses_[b].ring, b);
    });
    cast_slice({from_s, to_s, X_WS_now});
    first_ray_.resize(order_.size());
    const auto sub_rays = static_cast<std::size_t>(params_.sub_rays);
    for (std::size_t i = 0; i < order_.size(); ++i) first_ray_[order_[i] - first] = i * sub_rays;
    for (std::size_t number = first; number < next_pulse_; ++number) {
      receive(pulses_[number], first_ray_[number - first]);
    }
  }

  /// From the last sample to this one, in the time of the frame.
  struct Slice {
    double from_s, to_s;
    const Pose& X_WS_end;
  };

  /// Casts the rays of the pulses in order_, on all cores if there are many.
  void cast_slice(const Slice& slice) {
    constexpr std::size_t kRaysAtOnce = 1024;
    const auto sub_rays = static_cast<std::size_t>(params_.sub_rays);
    rays_.resize(order_.size() * sub_rays);
    hits_.resize(rays_.size());
    if (links_) {
      own_rays_.resize(rays_.size());
      link_hits_.resize(rays_.size());
      links_->scene().update();  // to where they are at the slice's end
    }
    for_chunks(order_.size(), std::max<std::size_t>(1, kRaysAtOnce / sub_rays),
               [this, &slice](std::size_t, std::size_t begin, std::size_t end) {
                 cast_pulses(slice, begin, end);
               });
  }

  /// Of the pulses [begin, end) in order_.
  void cast_pulses(const Slice& slice, std::size_t begin, std::size_t end) {
    // Entries of the rotation matrix change evenly and directions are normalised: for a turn by a
    // in a slice, directions are off by the order of a^3 / 100.
    const Eigen::Matrix3d R_last_WS = last_X_WS_.q.toRotationMatrix();
    const Eigen::Matrix3d R_end_WS = slice.X_WS_end.q.toRotationMatrix();
    const auto sub_rays = static_cast<std::size_t>(params_.sub_rays);
    for (std::size_t i = begin; i < end; ++i) {
      const LaserPulse& pulse = pulses_[order_[i]];
      const double share = (pulse.time_s - slice.from_s) / (slice.to_s - slice.from_s);
      const Eigen::Vector3d p_W = last_X_WS_.p + share * (slice.X_WS_end.p - last_X_WS_.p);
      const Eigen::Matrix3d R_WS = R_last_WS + share * (R_end_WS - R_last_WS);
      write_rays(pulse, p_W, R_WS, &rays_[i * sub_rays]);
      if (links_) write_rays(pulse, slice.X_WS_end.p, R_end_WS, &own_rays_[i * sub_rays]);
    }
    const std::size_t from = begin * sub_rays, count = (end - begin) * sub_rays;
    const auto rays = std::span(rays_).subspan(from, count);
    const auto hits = std::span(hits_).subspan(from, count);
    light_->cast_rays(rays, hits);
    if (links_) {
      links_->cast(rays, std::span(own_rays_).subspan(from, count), hits,
                   std::span(link_hits_).subspan(from, count));
    }
  }

  /// Writes the middle of a beam, and rays on a circle about it, to where `ray` points.
  void write_rays(const LaserPulse& pulse, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& R_WS,
                  SceneRay* ray) const {
    const auto write = [&](const Eigen::Vector3d& dir_S) {
      *ray++ = {p_W, (R_WS * dir_S).normalized(), params_.ranging.max_range_m};
    };
    write(pulse.dir_S);
    if (asides_.empty()) return;
    const Eigen::Vector3d u_S = pulse.dir_S.unitOrthogonal(), v_S = pulse.dir_S.cross(u_S);
    for (const Eigen::Vector2d& aside : asides_) {
      write(pulse.dir_S + aside.x() * u_S + aside.y() * v_S);
    }
  }

  /// @param first  number of the beam's middle among the rays
  void receive(const LaserPulse& pulse, std::size_t first) {
    // Always draw the same count for a pulse, so that later readings do not depend on what it
    // detects.
    const bool is_dual = params_.returns == Returns::kDual;
    const double luck_of_strongest = random_.uniform(), luck_of_last = random_.uniform();
    const double luck_of_second = is_dual ? random_.uniform() : 0.0;
    const double noise = random_.normal();
    const double second_noise = is_dual ? random_.normal() : noise;
    const bool is_lost = random_.uniform() < params_.ranging.beam_dropout_share;
    const int count = find_echoes(pulse, first);
    if (is_lost || count == 0) return;
    if (readings_.is_in_outage(*begin_ + duration_from_s(pulse.time_s))) return;
    const Echo3d* const strongest =
        std::max_element(echoes_.begin(), echoes_.begin() + count,
                         [](const Echo3d& a, const Echo3d& b) { return a.power < b.power; });
    const Echo3d* last = &echoes_[count - 1];
    const auto is_detected = [](const Echo3d& echo, double chance) {
      return chance < LaserOptics::detection_probability(echo.power);
    };
    const bool has_strongest = is_detected(*strongest, luck_of_strongest);
    // A last echo that is too weak leaves the strongest one as the last.
    if (!is_detected(*last, luck_of_last)) last = strongest;
    if (params_.returns == Returns::kLast) {
      if (last != strongest || has_strongest) report(pulse, *last, noise, 2);
      return;
    }
    if (has_strongest) report(pulse, *strongest, noise, 1);
    if (!is_dual) return;
    if (last != strongest) {
      report(pulse, *last, second_noise, 2);
    } else if (const Echo3d* second = find_second(strongest, count);
               second != nullptr && is_detected(*second, luck_of_second)) {
      report(pulse, *second, second_noise, 2);
    }
  }

  /// Second strongest of the echoes before the last one. @returns nullptr if there is none
  const Echo3d* find_second(const Echo3d* strongest, int count) const {
    const Echo3d* second = nullptr;
    for (const Echo3d* echo = echoes_.data(); echo < echoes_.data() + count - 1; ++echo) {
      if (echo != strongest && (!second || echo->power > second->power)) second = echo;
    }
    return second;
  }

  void report(const LaserPulse& pulse, const Echo3d& echo, double noise, std::uint8_t number) {
    const double reading_m = optics_.reading_m(echo.distance_m, noise);
    if (!std::isfinite(reading_m)) return;
    const double percent = 100.0 * optics_.apparent_reflectance(echo.power, echo.distance_m);
    add(cloud_, pulse, round_to_step(reading_m, params_.resolution_m), percent, number, echo.thing);
  }

  MetThing find_thing(const RayHit& hit) {
    if (!numbers_) return {};
    if (hit.surface == SurfaceClass::kVehicle) {
      return {Label::kVehicle, numbers_->of_vehicle(links_->scene().vehicle_of(hit.mesh))};
    }
    return {numbers_->label(hit), numbers_->of(hit, last_thing_)};
  }

  void add(PointCloud& cloud, const LaserPulse& pulse, double range_m, double intensity,
           std::uint8_t number, const MetThing& thing) const {
    const Eigen::Vector3d p_S = range_m * pulse.dir_S;
    if (params_.organised) {
      const std::size_t i = place_of(pulse);
      cloud.x[i] = static_cast<float>(p_S.x());
      cloud.y[i] = static_cast<float>(p_S.y());
      cloud.z[i] = static_cast<float>(p_S.z());
      cloud.intensity[i] = static_cast<float>(intensity);
      cloud.return_number[i] = number;
      if (!numbers_) return;
      cloud.label[i] = static_cast<std::uint8_t>(thing.label);
      cloud.instance[i] = thing.number;
      return;
    }
    cloud.x.push_back(static_cast<float>(p_S.x()));
    cloud.y.push_back(static_cast<float>(p_S.y()));
    cloud.z.push_back(static_cast<float>(p_S.z()));
    cloud.intensity.push_back(static_cast<float>(intensity));
    cloud.time_s.push_back(static_cast<float>(pulse.time_s));
    cloud.ring.push_back(pulse.ring);
    cloud.return_number.push_back(number);
    if (!numbers_) return;
    cloud.label.push_back(static_cast<std::uint8_t>(thing.label));
    cloud.instance.push_back(thing.number);
  }

  /// What a ray of a beam meets.
  struct Met {
    double distance_m, power;
    MetThing thing;
  };

  /// The thing that returned most of an echo, by all of its rays.
  static MetThing find_strongest(std::span<const Met> rays) {
    MetThing strongest;
    double most = -1.0;
    for (const Met& ray : rays) {
      double power = 0.0;
      for (const Met& other : rays) power += other.thing == ray.thing ? other.power : 0.0;
      if (power <= most) continue;
      most = power;
      strongest = ray.thing;
    }
    return strongest;
  }

  /// What the rays of a beam meet, in the order of distance. @returns number of echoes
  int find_echoes(const LaserPulse& pulse, std::size_t first) {
    std::array<Met, kMaxSubRays3d> met;
    int hits = 0;
    for (int ray = 0; ray < params_.sub_rays; ++ray) {
      const std::optional<RayHit>& hit = hits_[first + static_cast<std::size_t>(ray)];
      if (!hit) continue;
      const double power = optics_.power(*hit, rays_[first + static_cast<std::size_t>(ray)].dir_W);
      const MetThing thing = find_thing(*hit);
      met[hits++] = {hit->distance_m, power / params_.sub_rays, thing};
      if (ray > 0) continue;
      add(true_cloud_, pulse, hit->distance_m,
          100.0 * optics_.apparent_reflectance(power, hit->distance_m), 1, thing);
    }
    std::sort(met.begin(), met.begin() + hits,
              [](const Met& a, const Met& b) { return a.distance_m < b.distance_m; });
    int count = 0;
    for (int i = 0; i < hits;) {
      Echo3d echo;
      double weighted_m = 0.0, plain_m = 0.0;
      const int nearest = i;
      for (; i < hits && met[i].distance_m <= met[nearest].distance_m + params_.pulse_m; ++i) {
        echo.power += met[i].power;
        weighted_m += met[i].power * met[i].distance_m;
        plain_m += met[i].distance_m;
      }
      if (numbers_) echo.thing = find_strongest(std::span(met).subspan(nearest, i - nearest));
      echo.distance_m = echo.power > 0.0 ? weighted_m / echo.power : plain_m / (i - nearest);
      echoes_[count++] = echo;
    }
    return count;
  }

  Lidar3dParams params_;
  std::string vehicle_;  ///< own
  const WorldModel* world_;
  const RayScene* light_;
  std::function<VehicleScene&()> find_vehicles_;  ///< empty: there are none
  std::optional<ScanLinks> links_;                ///< from the first sample on
  Duration sampling_;
  std::unique_ptr<ScanPattern> pattern_;
  LaserOptics optics_;
  RandomStream random_;
  std::uint64_t frame_ = 0;
  std::optional<Time> begin_;  ///< of the frame
  std::span<const LaserPulse> pulses_;
  std::size_t next_pulse_ = 0;
  Time last_;  ///< of the last sample
  Pose last_X_WS_;
  std::vector<Eigen::Vector2d> asides_;  ///< of the rays on the circle, per length
  std::vector<SceneRay> rays_;           ///< of a slice
  std::vector<SceneRay> own_rays_;       ///< the same from the pose at its end, for links_
  std::vector<std::optional<RayHit>> hits_, link_hits_;
  std::vector<std::size_t> order_;      ///< in which the pulses of a slice are cast
  std::vector<std::size_t> first_ray_;  ///< of each pulse of a slice: the beam's middle
  std::array<Echo3d, kMaxSubRays3d> echoes_;
  std::optional<ThingNumbers> numbers_;  ///< if points have labels
  ThingNumbers::Found last_thing_;
  std::size_t columns_ = 0;  ///< of an organised cloud
  PointCloud empty_;         ///< an organised cloud in which nothing was seen
  PointCloud cloud_, true_cloud_;
};

}  // namespace

PartSpec lidar_3d_spec() {
  return mounted_sensor_spec<PointCloud>(
      "lidar_3d",
      "3D laser scanner: points of each frame with time, ring and intensity; it moves while it "
      "turns, and its beams look through leaves",
      10.0, lidar_3d_table());
}

std::unique_ptr<Sensor> make_lidar_3d(const ParameterSet& parameters,
                                      const SensorContext& context) {
  return std::make_unique<Lidar3d>(parameters, context);
}

}  // namespace vinerow::sensors

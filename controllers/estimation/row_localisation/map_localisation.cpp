#include "controllers/estimation/row_localisation/map_localisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/estimation/parts/estimator_events.h"
#include "controllers/estimation/parts/initial_pose.h"
#include "controllers/estimation/parts/mounting.h"
#include "controllers/estimation/row_localisation/ground_reference.h"
#include "controllers/estimation/row_localisation/map_localisation_law.h"
#include "controllers/estimation/row_localisation/map_watch.h"
#include "controllers/estimation/row_localisation/range_sensors.h"
#include "engine/api/messages/commands.h"
#include "engine/api/parameter_table.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

/// All parameters of the estimator.
struct MapEstimatorParams {
  std::string ins = "ins", gps = "gps";  ///< signals; gps empty: none
  std::optional<Eigen::Vector3d> p_BA;   ///< antenna in B; absent: as mounted
  std::vector<std::string> ranges;       ///< range sensors; empty: all ultrasonic sensors
  int cone_rays = 7;
  double range_bound_m = 0.003;
  double start_std_m = 0.26;
  bool on_map = true;
  MapLocalisationParams law;
  GroundParams ground;
  InitialPoseParams initial_pose;
};

const ParameterTable<MapEstimatorParams>& map_localisation_table() {
  using P = MapEstimatorParams;
  using Law = MapLocalisationParams;
  using Noise = LocalisationNoise;
  const auto law = [](auto member) { return inside(&P::law, member); };
  const auto noise = [](auto... members) { return inside(&P::law, &Law::noise, members...); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("ins", &P::ins, "signal of the aided inertial unit: velocity and attitude")
          .text("gps", &P::gps, "signal of the satellite receiver; '' = none")
          .numbers("antenna_m", "m", &P::p_BA, between(-100.0, 100.0),
                   "position of the antenna in B (x, y, z), subtracted from the fix; default: "
                   "where the receiver is mounted")
          .texts("ranges", &P::ranges, "names of the range sensors; empty: all ultrasonic sensors")
          .integer("cone_rays", &P::cone_rays, between(1, 31),
                   "rays over a sensor's cone whose first return is predicted")
          .number("range_bound_m", "m", &P::range_bound_m, kPositive,
                  "largest error of an echo's distance")
          .number("max_range_m", "m", law(&Law::max_range_m), kPositive,
                  "walls farther away than this are not used")
          .number("start_std_m", "m", &P::start_std_m, between(0.0, 100.0),
                  "1 sigma of each coordinate at the start")
          .number("velocity_density_m_rts", "m/sqrt(s)", noise(&Noise::velocity_density_m_rts),
                  between(0.0, 10.0), "density of the white part of the velocity's error")
          .number("velocity_std_mps", "m/s", noise(&Noise::velocity_mps, &SlowError::std),
                  between(0.0, 10.0), "1 sigma of the velocity's slow error, each axis")
          .number("velocity_time_s", "s", noise(&Noise::velocity_mps, &SlowError::time_s),
                  kPositive, "its correlation time")
          .degrees("heading_std_deg", noise(&Noise::heading_rad, &SlowError::std),
                   between(0.0, 90.0), "1 sigma of the heading's slow error")
          .number("heading_time_s", "s", noise(&Noise::heading_rad, &SlowError::time_s), kPositive,
                  "its correlation time")
          .degrees("heading_white_std_deg", law(&Law::heading_white_std_rad), between(0.0, 90.0),
                   "1 sigma of the heading's error that changes with every reading")
          .number("fix_walk_std_m", "m", noise(&Noise::fix_horizontal_m, &SlowError::std),
                  between(0.0, 100.0),
                  "1 sigma of the fixes' slow error, east and north; up 1.5 times as much")
          .number("fix_walk_time_s", "s", noise(&Noise::fix_horizontal_m, &SlowError::time_s),
                  kPositive, "its correlation time")
          .number("fix_slow_share", "", law(&Law::fix_slow_share), between(0.0, 0.999),
                  "share of a fix's stated variance that is slow error, a different one in each "
                  "mode of the receiver, as with RTK; 0: a fix states its white error alone, "
                  "and fix_walk_std_m is the slow one")
          .number("map_shift_std_m", "m", law(&Law::map_shift_std_m), between(0.0, 100.0),
                  "1 sigma of a shift of the whole map, in addition to the map's own")
          .choice("place", &P::on_map, {{"on_map", true}, {"in_world", false}},
                  "on_map: the estimate is the position relative to the map's walls, which "
                  "planners on the same map need; in_world: it contains the estimated shift of "
                  "the map; the covariance refers to the world in both cases")
          .number("gate_sigma", "", law(&Law::gate_sigma), kPositive,
                  "limit of the innovation; echoes beyond it count as false")
          .number("fix_gate_sigma", "", law(&Law::fix_gate_sigma), kPositive,
                  "limit of the innovation; fixes beyond it are rejected")
          .number("huber_sigma", "", law(&Law::huber_sigma), kPositive,
                  "innovation above which echoes weigh less")
          .boolean("walls_correct_height", law(&Law::walls_correct_height),
                   "whether echoes from leaning walls correct the height; use false on maps from "
                   "point clouds, whose walls lean differently from the true ones")
          .formerly("walls_tell_height")
          .number("false_share", "", law(&Law::false_share), between(1e-6, 0.9),
                  "share of echoes that no wall explains, for the weights of the alleys")
          .integer("bank", law(&Law::bank), between(1, 8),
                   "maximum number of filters, one for each possible alley")
          .number("bank_std_m", "m", law(&Law::bank_std_m), kPositive,
                  "deviation of the start above which there is one filter for each alley")
          .include(&P::ground, ground_table())
          .include(&P::initial_pose, initial_pose_table());
  return table;
}

std::string map_localisation_name(const EstimatorContext& context) {
  return context.part + " (map_localisation)";
}

MapEstimatorParams read_map_estimator_params(const ParameterSet& parameters,
                                             const EstimatorContext& context) {
  MapEstimatorParams params =
      map_localisation_table().read(parameters, map_localisation_name(context));
  LocalisationNoise& noise = params.law.noise;
  noise.fix_vertical_m = {1.5 * noise.fix_horizontal_m.std, noise.fix_horizontal_m.time_s};
  return params;
}

std::vector<RangeSensorModel> make_cone_sensors(const MapEstimatorParams& params,
                                                const EstimatorContext& context,
                                                const GroundReference& ground) {
  std::vector<RangeSensorModel> sensors =
      find_range_sensors(params.ranges, context, map_localisation_name(context));
  std::erase_if(sensors, [&](const RangeSensorModel& s) { return ground.looks_down(s.name); });
  for (RangeSensorModel& sensor : sensors) {
    sensor.fan_rays = params.cone_rays;
    sensor.bound_m = params.range_bound_m;
  }
  return sensors;
}

const RowMap& demand_map(const EstimatorContext& context) {
  demand_row_meshes(context, map_localisation_name(context), "");
  return *context.map;
}

class MapLocalisation final : public Estimator {
 public:
  MapLocalisation(const MapEstimatorParams& params, const EstimatorContext& context)
      : ins_name_(params.ins),
        gps_name_(params.gps),
        start_std_m_(params.start_std_m),
        on_map_(params.on_map),
        max_range_m_(params.law.max_range_m),
        map_(demand_map(context)),
        ground_(params.ground, context, &map_, map_localisation_name(context)),
        sensors_(make_cone_sensors(params, context, ground_)),
        index_(map_),
        law_(params.law, map_, index_, sensors_),
        random_(context.random("start")),
        initial_pose_(params.initial_pose),
        p_BA_(antenna_of(context, params.gps, params.p_BA)) {}

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    ins_ = ports.read<Odometry>(ins_name_);
    if (!gps_name_.empty()) gps_ = ports.read<GnssFix>(gps_name_);
    for (const RangeSensorModel& sensor : sensors_) {
      ranges_.push_back({ports.read<RangeSample>(sensor.name), 0, Time{}});
    }
    ground_.connect(ports);
    initial_pose_.connect(ports);
    estimate_ = ports.write<Odometry>("estimate");
    state_writer_ = ports.write<NamedValues>("estimator_state");
    events_.connect(ports);
    state_.names = {"filters",     "best_weight",      "nis_range",          "nis_gnss_position",
                    "echoes",      "echoes_gated",     "echoes_unexplained", "fixes",
                    "fixes_gated", "heights",          "heights_gated",      "refused",
                    "lost",        "map_shift_east_m", "map_shift_north_m",  "heading_error_rad",
                    "unmapped",    "ground_echoes"};
    state_.values.assign(state_.names.size(), 0.0);
  }

  void step(Time now) override {
    if (!ins_.has_value() || !truth_.has_value()) return;
    if (is_finite(ins_.value())) known_ins_ = ins_.value();
    if (!law_.has_started()) {
      // The attitude comes from the inertial unit's first reading; the position is drawn.
      const double z = random_.normal(), y = random_.normal(), x = random_.normal();
      law_.start(now, truth_.value().X_WB.p + start_std_m_ * Eigen::Vector3d(x, y, z),
                 start_std_m_ * start_std_m_ * Eigen::Matrix3d::Identity());
    }
    if (const auto pose = initial_pose_.take()) restart_at(now, *pose);
    const Odometry& motion = ins_.value();
    law_.predict(now, motion.X_WB.q * motion.v_WB_B, motion.X_WB.q);
    if (!gps_name_.empty() && gps_.is_newer_than(seen_fix_)) {
      const GnssFix& fix = gps_.value();
      if (fix.valid) {
        law_.correct_fix(gps_.stamp(), fix.p_W, fix.std_m, p_BA_, static_cast<int>(fix.mode));
      }
    }
    while (const auto plane = ground_.read(now, known_ins_.X_WB.q, law_.state().p_W())) {
      law_.correct_plane(plane->measured, plane->normal_W, plane->offset_m, plane->std_m);
    }
    for (std::size_t i = 0; i < ranges_.size(); ++i) take_range(static_cast<int>(i));
    report_event(now);
    write(now, known_ins_);
  }

 private:
  static bool is_finite(const Odometry& ins) {
    return ins.X_WB.q.coeffs().allFinite() && ins.v_WB_B.allFinite() && ins.w_WB_B.allFinite() &&
           std::isfinite(ins.yaw_std_rad);
  }

  struct Range {
    SignalReader<RangeSample> reader;
    std::uint64_t seen;
    Time last;
  };

  /// The heading stays that of the inertial unit; the height stays.
  void restart_at(Time now, const InitialPose::Value& pose) {
    const Eigen::Vector3d p_W(pose.p_W.x(), pose.p_W.y(), law_.state().p_W().z());
    Eigen::Vector3d variance_m2 = law_.state().covariance().diagonal().head<3>();
    variance_m2.head<2>() = pose.std_m.cwiseAbs2();
    law_.start(now, p_W, variance_m2.asDiagonal());
    events_.report_event(Event::Level::kInfo, InitialPose::describe(pose));
  }

  void take_range(int i) {
    Range& range = ranges_[i];
    if (!range.reader.is_newer_than(range.seen)) return;
    const RangeSample& sample = range.reader.value();
    const Time stamp = range.reader.stamp();
    const double period_s = range.last.ns > 0 ? (stamp - range.last).s() : 0.05;
    range.last = std::max(range.last, stamp);
    // A missing echo has no information: leaves absorb some.
    if (std::isinf(sample.range_m)) return;
    const Pose X_WB{known_ins_.X_WB.q, law_.state().p_W()};
    if (ground_.may_be_ground(X_WB, sensors_[i], sample.half_angle_rad, sample.range_m)) {
      ++ground_echoes_;
      return;
    }
    law_.set_half_angle(i, sample.half_angle_rad);
    law_.correct_range(stamp, i, sample.range_m, std::max(period_s, 1e-3));
  }

  void report_event(Time now) {
    const LocalisationState& state = law_.state();
    const int lost = law_.counters().lost;
    if (lost_event_.is_due(now, lost)) {
      events_.report_event(
          Event::Level::kWarning,
          fmt::format("lost: echoes or fixes contradict the estimate; it restarts near "
                      "({:.1f}, {:.1f}), possible alleys: {} ({} so far)",
                      state.p_W().x(), state.p_W().y(), law_.filter_count(), lost));
    }
    const Pose X_MB{known_ins_.X_WB.q, state.p_W() - state.map_shift_W()};
    watch_.look(now, index_, sensors_, X_MB, max_range_m_, events_);
    events_.write(now);
  }

  void write(Time now, const Odometry& ins) {
    const LocalisationState& state = law_.state();
    Odometry estimate;
    estimate.X_WB.q =
        Eigen::AngleAxisd(-state.heading_error_rad(), Eigen::Vector3d::UnitZ()) * ins.X_WB.q;
    estimate.X_WB.p = on_map_ ? law_.position_on_map() : state.p_W();
    estimate.v_WB_B =
        estimate.X_WB.q.conjugate() * (ins.X_WB.q * ins.v_WB_B - state.velocity_error_W());
    estimate.w_WB_B = ins.w_WB_B;
    estimate.set_position_covariance(on_map_ ? law_.position_on_map_covariance()
                                             : law_.position_covariance());
    const int heading = LocalisationState::kHeading;
    estimate.yaw_std_rad =
        std::hypot(std::sqrt(state.covariance()(heading, heading)), ins.yaw_std_rad);
    estimate_.write(now, estimate);
    const MapLocalisationLaw::Counters& counters = law_.counters();
    const Eigen::Vector3d shift_W = state.map_shift_W();
    const double values[] = {static_cast<double>(law_.filter_count()),
                             law_.best_weight(),
                             law_.range_nis(),
                             law_.fix_nis(),
                             static_cast<double>(counters.echoes),
                             static_cast<double>(counters.echoes_gated),
                             static_cast<double>(counters.echoes_unexplained),
                             static_cast<double>(counters.fixes),
                             static_cast<double>(counters.fixes_gated),
                             static_cast<double>(counters.heights),
                             static_cast<double>(counters.heights_gated),
                             static_cast<double>(counters.refused),
                             static_cast<double>(counters.lost),
                             shift_W.x(),
                             shift_W.y(),
                             state.heading_error_rad(),
                             static_cast<double>(watch_.times_without()),
                             static_cast<double>(ground_echoes_)};
    std::copy(std::begin(values), std::end(values), state_.values.begin());
    state_writer_.write(now, state_);
  }

  std::string ins_name_;
  std::string gps_name_;
  double start_std_m_;
  bool on_map_;
  double max_range_m_;
  const RowMap& map_;
  GroundReference ground_;
  std::vector<RangeSensorModel> sensors_;
  RowMeshIndex index_;
  MapLocalisationLaw law_;
  RandomStream random_;
  InitialPose initial_pose_;
  Eigen::Vector3d p_BA_;
  SignalReader<Odometry> truth_, ins_;
  SignalReader<GnssFix> gps_;
  std::vector<Range> ranges_;
  Odometry known_ins_;  // the last finite one
  MapWatch watch_;
  int ground_echoes_ = 0;
  CountedEvent lost_event_;
  EstimatorEvents events_;
  std::uint64_t seen_fix_ = 0;
  SignalWriter<Odometry> estimate_;
  SignalWriter<NamedValues> state_writer_;
  NamedValues state_;
};

}  // namespace

PartSpec map_localisation_spec() {
  PartSpec spec;
  spec.name = "map_localisation";
  spec.description =
      "Position between mapped rows from an inertial unit, satellite fixes and echoes: a bank of "
      "extended Kalman filters on the echoes themselves, one for each possible alley.";
  map_localisation_table().add_to(spec);
  spec.default_rate_Hz = 100.0;
  spec.reads = {"truth", "<ins>", "<gps>", "<ranges>", "<down>", "initialpose (from outside)"};
  spec.writes = {"estimate", "estimator_state", "estimator_event"};
  return spec;
}

std::unique_ptr<Estimator> make_map_localisation(const ParameterSet& parameters,
                                                 const EstimatorContext& context) {
  return std::make_unique<MapLocalisation>(read_map_estimator_params(parameters, context), context);
}

}  // namespace vinerow::controllers

#include "controllers/estimation/row_localisation/distance_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/estimation/parts/estimator_events.h"
#include "controllers/estimation/parts/initial_pose.h"
#include "controllers/estimation/parts/mounting.h"
#include "controllers/estimation/row_localisation/distance_filter_law.h"
#include "controllers/estimation/row_localisation/distance_filter_params.h"
#include "controllers/estimation/row_localisation/ground_reference.h"
#include "controllers/estimation/row_localisation/map_watch.h"
#include "controllers/estimation/row_localisation/range_sensors.h"
#include "engine/api/messages/commands.h"
#include "engine/api/parameter_table.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector3d;

/// All parameters of the estimator.
struct DistanceEstimatorParams {
  std::string ins = "ins", gps = "gps";  ///< signals
  std::optional<Eigen::Vector3d> p_BA;   ///< antenna in B; absent: as mounted
  std::vector<std::string> ranges;       ///< range sensors; empty: all ultrasonic sensors
  bool use_map = true;
  double start_std_m = 0.26;
  double range_bound_m = 0.003;
  bool cone = true;
  double cone_half_angle_rad = rad_from_deg(15.0);
  int fan_rays = 7;
  GroundParams ground;
  DistanceFilterOptions filter;
  InitialPoseParams initial_pose;
};

const ParameterTable<DistanceEstimatorParams>& distance_filter_table() {
  using P = DistanceEstimatorParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("ins", &P::ins, "signal of the inertial unit: velocity, attitude, position")
          .text("gps", &P::gps, "signal of the satellite receiver")
          .numbers("antenna_m", "m", &P::p_BA, between(-100.0, 100.0),
                   "position of the antenna in B (x, y, z), subtracted from the fix; default: "
                   "where the receiver is mounted")
          .texts("ranges", &P::ranges, "names of the range sensors; empty: all ultrasonic sensors")
          .boolean("use_map", &P::use_map, "false: satellite fixes and inertial unit only")
          .number("start_std_m", "m", &P::start_std_m, between(1e-3, 100.0),
                  "1 sigma of each coordinate at the start (paper C: 0.26)")
          .number("range_bound_m", "m", &P::range_bound_m, kPositive,
                  "largest error of a range (HC-SR04: 3 mm)")
          .boolean("cone", &P::cone,
                   "the sensor's cone is part of the prediction; false: a single ray")
          .degrees("cone_half_angle_deg", &P::cone_half_angle_rad, between(0.1, 60.0),
                   "half angle of that cone")
          .integer("fan_rays", &P::fan_rays, between(1, 101),
                   "rays over the cone; an even number is raised by one")
          .include(&P::ground, ground_table())
          .include(&P::filter, distance_filter_law_table())
          .include(&P::initial_pose, initial_pose_table());
  return table;
}

std::string distance_filter_name(const EstimatorContext& context) {
  return context.part + " (distance_filter)";
}

std::vector<RangeSensorModel> make_filter_sensors(const DistanceEstimatorParams& params,
                                                  const EstimatorContext& context,
                                                  const GroundReference& ground) {
  if (!params.use_map) return {};
  std::vector<RangeSensorModel> sensors =
      find_range_sensors(params.ranges, context, distance_filter_name(context));
  std::erase_if(sensors, [&](const RangeSensorModel& s) { return ground.looks_down(s.name); });
  for (RangeSensorModel& sensor : sensors) {
    sensor.bound_m = params.range_bound_m;
    if (params.cone) {
      sensor.half_angle_rad = params.cone_half_angle_rad;
      sensor.fan_rays = params.fan_rays | 1;
    }
  }
  return sensors;
}

class DistanceFilter final : public Estimator {
 public:
  DistanceFilter(const DistanceEstimatorParams& params, const EstimatorContext& context)
      : ins_name_(params.ins),
        gps_name_(params.gps),
        start_std_m_(params.start_std_m),
        yaw_std_rad_(params.filter.yaw_std_rad),
        inertial_std_m_(params.filter.inertial_std_m),
        ground_(params.ground, context, params.use_map ? context.map : nullptr,
                distance_filter_name(context)),
        sensors_(make_filter_sensors(params, context, ground_)),
        index_(make_index(context)),
        law_(make_distance_filter_params(params.filter),
             context.map != nullptr ? context.map->accuracy : MapAccuracy{},
             index_ ? &*index_ : nullptr, sensors_),
        random_(context.random()),
        initial_pose_(params.initial_pose),
        p_BA_(antenna_of(context, params.gps, params.p_BA)),
        seen_ranges_(sensors_.size(), 0) {
    readings_.reserve(sensors_.size());
    handled_.resize(sensors_.size());
    state_.names = {"echoes",      "echoes_gated",  "echoes_unmatched", "fixes",
                    "fixes_gated", "bad_numbers",   "backwards",        "not_positive",
                    "lost",        "set_restarts",  "heights",          "heights_gated",
                    "unmapped",    "ground_echoes", "nis_range",        "nis_gnss_position"};
    state_.values.resize(state_.names.size());
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    ins_ = ports.read<Odometry>(ins_name_);
    gps_ = ports.read<GnssFix>(gps_name_);
    for (const RangeSensorModel& sensor : sensors_) {
      ranges_.push_back(ports.read<RangeSample>(sensor.name));
    }
    initial_pose_.connect(ports);
    ground_.connect(ports);
    estimate_ = ports.write<Odometry>("estimate");
    ellipsoid_ = ports.write<PositionEllipsoid>("ellipsoid");
    state_out_ = ports.write<NamedValues>("estimator_state");
    events_.connect(ports);
  }

  void step(Time now) override {
    if (!law_.has_started() && truth_.has_value()) start(now);
    if (!law_.has_started()) return;
    if (const auto pose = initial_pose_.take()) restart_at(now, *pose);
    take_inertial(now);
    if (gps_.is_newer_than(seen_fix_) && gps_.value().valid) {
      const GnssFix& fix = gps_.value();
      law_.take_fix(gps_.stamp(), fix.p_W, fix.std_m.cwiseMax(kMinStd_m), p_BA_);
    }
    while (const auto plane = ground_.read(now, law_.q_WB(), law_.kalman().p_W())) {
      law_.take_plane(plane->measured, plane->normal_W, plane->offset_m, plane->std_m);
    }
    take_ranges();
    report_event(now);
    write(now);
  }

 private:
  std::optional<RowMeshIndex> make_index(const EstimatorContext& context) const {
    if (sensors_.empty()) return std::nullopt;
    demand_row_meshes(context, distance_filter_name(context), "set use_map: false");
    return std::optional<RowMeshIndex>(std::in_place, *context.map);
  }

  /// Starts at a draw about the true position, like a user's rough knowledge of it.
  void start(Time now) {
    Vector3d p_W = truth_.value().X_WB.p;
    for (int i = 0; i < 3; ++i) p_W[i] += start_std_m_ * random_.normal();
    q_start_WB_ = truth_.value().X_WB.q;
    law_.start(now, p_W, start_std_m_ * start_std_m_ * Eigen::Matrix3d::Identity());
  }

  /// The attitude stays that of the inertial unit; the height stays.
  void restart_at(Time now, const InitialPose::Value& pose) {
    const Vector3d p_W(pose.p_W.x(), pose.p_W.y(), law_.kalman().p_W().z());
    Vector3d variance_m2 = law_.kalman().position_covariance().diagonal();
    variance_m2.head<2>() = pose.std_m.cwiseAbs2();
    law_.start(now, p_W, variance_m2.asDiagonal());
    events_.report_event(Event::Level::kInfo, InitialPose::describe(pose));
  }

  void take_inertial(Time now) {
    const bool is_new = ins_.is_newer_than(seen_ins_);
    if (!ins_.has_value()) {  // stationary until the unit delivers data
      law_.predict(now, Vector3d::Zero(), q_start_WB_, kStatedYawStd_rad);
      return;
    }
    const Odometry& ins = ins_.value();
    const double stated = ins.yaw_std_rad > 0.0 ? ins.yaw_std_rad : kStatedYawStd_rad;
    law_.predict(now, ins.X_WB.q * ins.v_WB_B, ins.X_WB.q,
                 yaw_std_rad_ > 0.0 ? yaw_std_rad_ : stated);
    if (!is_new) return;
    Vector3d std_m = Vector3d::Constant(inertial_std_m_);
    if (ins.position_variance_m2.minCoeff() > 0.0) std_m = ins.position_variance_m2.cwiseSqrt();
    law_.take_inertial_position(ins_.stamp(), ins.X_WB.p, std_m);
  }

  /// Applies readings of the same time together, in the order of the sensors.
  void take_ranges() {
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      handled_[i] = !ranges_[i].is_newer_than(seen_ranges_[i]);
    }
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      if (handled_[i]) continue;
      const Time measured = ranges_[i].stamp();
      readings_.clear();
      for (std::size_t k = i; k < ranges_.size(); ++k) {
        if (handled_[k] || ranges_[k].stamp() != measured) continue;
        handled_[k] = true;
        const RangeSample& sample = ranges_[k].value();
        if (std::isfinite(sample.range_m) &&
            ground_.may_be_ground({law_.q_WB(), law_.kalman().p_W()}, sensors_[k],
                                  sample.half_angle_rad, sample.range_m)) {
          ++ground_echoes_;
          continue;
        }
        readings_.push_back({static_cast<int>(k), sample.range_m, sample.max_range_m});
        if (std::isfinite(sample.max_range_m)) reach_m_ = std::max(reach_m_, sample.max_range_m);
      }
      law_.take_ranges(measured, readings_);
    }
  }

  void report_event(Time now) {
    const Pose X_WB{law_.q_WB(), law_.kalman().p_W()};
    const DistanceFilterLaw::Counters& counters = law_.counters();
    if (lost_event_.is_due(now, counters.lost)) {
      events_.report_event(
          Event::Level::kWarning,
          fmt::format("lost near ({:.1f}, {:.1f}): echoes or fixes contradict the estimate; "
                      "its variance has been increased ({} so far)",
                      X_WB.p.x(), X_WB.p.y(), counters.lost));
    }
    if (has_event_.is_due(now, counters.set_restarts)) {
      events_.report_event(
          Event::Level::kWarning,
          fmt::format("the ellipsoid was empty near ({:.1f}, {:.1f}): its bounds contradict "
                      "each other; it restarts at the estimate ({} so far)",
                      X_WB.p.x(), X_WB.p.y(), counters.set_restarts));
    }
    if (index_) watch_.look(now, *index_, sensors_, X_WB, reach_m_, events_);
    events_.write(now);
  }

  void write(Time now) {
    Odometry estimate;
    estimate.X_WB = {law_.q_WB(), law_.kalman().p_W()};
    estimate.v_WB_B = law_.q_WB().conjugate() * law_.v_W();
    if (ins_.has_value() && ins_.value().w_WB_B.allFinite()) w_WB_B_ = ins_.value().w_WB_B;
    estimate.w_WB_B = w_WB_B_;
    estimate.set_position_covariance(law_.kalman().position_covariance());
    estimate.yaw_std_rad = law_.yaw_std_rad();
    estimate_.write(now, estimate);

    PositionEllipsoid ellipsoid;
    ellipsoid.centre_W = law_.set().centre_W();
    const Eigen::Matrix3d& shape = law_.set().shape_m2();
    ellipsoid.shape_diagonal_m2 = shape.diagonal();
    ellipsoid.shape_beside_m2 = {shape(0, 1), shape(0, 2), shape(1, 2)};
    ellipsoid_.write(now, ellipsoid);

    const DistanceFilterLaw::Counters& c = law_.counters();
    std::size_t i = 0;
    for (const int count : {c.echoes, c.echoes_gated, c.echoes_unmatched, c.fixes, c.fixes_gated,
                            c.bad_numbers, c.backwards, c.not_positive, c.lost, c.set_restarts,
                            c.heights, c.heights_gated, watch_.times_without(), ground_echoes_}) {
      state_.values[i++] = count;
    }
    state_.values[i++] = law_.range_nis();
    state_.values[i++] = law_.fix_nis();
    state_out_.write(now, state_);
  }

  static constexpr double kMinStd_m = 1e-3;              // an ideal receiver states zero
  static constexpr double kStatedYawStd_rad = 3.491e-3;  // 0.2 deg, VN-200
  static constexpr double kReach_m = 4.0;  // minimum reach of the range sensors (HC-SR04)

  std::string ins_name_, gps_name_;
  double start_std_m_, yaw_std_rad_, inertial_std_m_;
  GroundReference ground_;
  std::vector<RangeSensorModel> sensors_;
  std::optional<RowMeshIndex> index_;
  DistanceFilterLaw law_;
  RandomStream random_;
  InitialPose initial_pose_;
  Vector3d p_BA_;
  int ground_echoes_ = 0;
  std::vector<std::uint64_t> seen_ranges_;
  std::vector<char> handled_;
  std::vector<RangeReading> readings_;
  double reach_m_ = kReach_m;
  Vector3d w_WB_B_ = Vector3d::Zero();
  Eigen::Quaterniond q_start_WB_ = Eigen::Quaterniond::Identity();
  MapWatch watch_;
  CountedEvent lost_event_, has_event_;
  EstimatorEvents events_;
  NamedValues state_;
  std::uint64_t seen_ins_ = 0, seen_fix_ = 0;
  SignalReader<Odometry> truth_, ins_;
  SignalReader<GnssFix> gps_;
  std::vector<SignalReader<RangeSample>> ranges_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<PositionEllipsoid> ellipsoid_;
  SignalWriter<NamedValues> state_out_;
};

}  // namespace

PartSpec distance_filter_spec() {
  PartSpec spec;
  spec.name = "distance_filter";
  spec.description =
      "Position from an inertial unit, satellite fixes and echoes from mapped rows: the 3D "
      "distance filter of Donati et al. 2022, section 3, in several variants, and an EKF on the "
      "range.";
  distance_filter_table().add_to(spec);
  spec.default_rate_Hz = 100.0;
  spec.reads = {"truth", "<ins>", "<gps>", "<ranges>", "<down>", "initialpose (from outside)"};
  spec.writes = {"estimate", "ellipsoid", "estimator_state", "estimator_event"};
  return spec;
}

std::unique_ptr<Estimator> make_distance_filter(const ParameterSet& parameters,
                                                const EstimatorContext& context) {
  return std::make_unique<DistanceFilter>(
      distance_filter_table().read(parameters, distance_filter_name(context)), context);
}

}  // namespace vinerow::controllers

#include "controllers/estimation/map_localisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/estimation/estimator_news.h"
#include "controllers/estimation/ground_reference.h"
#include "controllers/estimation/map_localisation_law.h"
#include "controllers/estimation/map_watch.h"
#include "controllers/estimation/range_sensors.h"
#include "engine/api/messages/commands.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

MapLocalisationParams read_params(const ParameterSet& parameters) {
  MapLocalisationParams params;
  params.noise.velocity_density_m_rts = parameters.number("velocity_density_m_rts");
  params.noise.velocity_mps = {parameters.number("velocity_std_mps"),
                               parameters.number("velocity_time_s")};
  params.noise.heading_rad = {rad_from_deg(parameters.number("heading_std_deg")),
                              parameters.number("heading_time_s")};
  params.noise.fix_horizontal_m = {parameters.number("fix_walk_std_m"),
                                   parameters.number("fix_walk_time_s")};
  params.noise.fix_vertical_m = {1.5 * parameters.number("fix_walk_std_m"),
                                 parameters.number("fix_walk_time_s")};
  params.heading_white_std_rad = rad_from_deg(parameters.number("heading_white_std_deg"));
  params.map_shift_std_m = parameters.number("map_shift_std_m");
  params.gate_sigma = parameters.number("gate_sigma");
  params.fix_gate_sigma = parameters.number("fix_gate_sigma");
  params.fix_slow_share = parameters.number("fix_slow_share");
  params.huber_sigma = parameters.number("huber_sigma");
  params.walls_tell_height = parameters.boolean("walls_tell_height");
  params.max_range_m = parameters.number("max_range_m");
  params.false_share = parameters.number("false_share");
  params.bank = static_cast<int>(parameters.integer("bank"));
  params.bank_std_m = parameters.number("bank_std_m");
  return params;
}

std::string map_localisation_name(const EstimatorContext& context) {
  return context.part + " (map_localisation)";
}

std::vector<RangeSensorModel> read_cone_sensors(const ParameterSet& parameters,
                                                const EstimatorContext& context,
                                                const GroundReference& ground) {
  std::vector<RangeSensorModel> sensors =
      find_range_sensors(parameters.texts("ranges"), context, map_localisation_name(context));
  std::erase_if(sensors, [&](const RangeSensorModel& s) { return ground.looks_down(s.name); });
  for (RangeSensorModel& sensor : sensors) {
    sensor.fan_rays = static_cast<int>(parameters.integer("cone_rays"));
    sensor.bound_m = parameters.number("range_bound_m");
  }
  return sensors;
}

const RowMap& demand_map(const EstimatorContext& context) {
  demand_row_meshes(context, map_localisation_name(context), "");
  return *context.map;
}

class MapLocalisation final : public Estimator {
 public:
  MapLocalisation(const ParameterSet& parameters, const EstimatorContext& context)
      : ins_name_(parameters.text("ins")),
        gps_name_(parameters.text("gps")),
        start_std_m_(parameters.number("start_std_m")),
        on_map_(parameters.text("place") == "on_map"),
        max_range_m_(parameters.number("max_range_m")),
        map_(demand_map(context)),
        ground_(parameters, context, &map_, map_localisation_name(context)),
        sensors_(read_cone_sensors(parameters, context, ground_)),
        index_(map_),
        law_(read_params(parameters), map_, index_, sensors_),
        random_(context.random("start")) {
    const auto& antenna = parameters.numbers("antenna_m");
    p_BA_ = {antenna[0], antenna[1], antenna[2]};
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    ins_ = ports.read<Odometry>(ins_name_);
    if (!gps_name_.empty()) gps_ = ports.read<GnssFix>(gps_name_);
    for (const RangeSensorModel& sensor : sensors_) {
      ranges_.push_back({ports.read<RangeSample>(sensor.name), 0, Time{}});
    }
    ground_.connect(ports);
    estimate_ = ports.write<Odometry>("estimate");
    state_writer_ = ports.write<NamedValues>("estimator_state");
    news_.connect(ports);
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
      // The inertial unit's attitude is known from the first reading; the place is drawn.
      const Eigen::Vector3d draw(random_.normal(), random_.normal(), random_.normal());
      law_.start(now, truth_.value().X_WB.p + start_std_m_ * draw,
                 start_std_m_ * start_std_m_ * Eigen::Matrix3d::Identity());
    }
    const Odometry& told = ins_.value();
    law_.predict(now, told.X_WB.q * told.v_WB_B, told.X_WB.q);
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
    tell(now);
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

  void take_range(int i) {
    Range& range = ranges_[i];
    if (!range.reader.is_newer_than(range.seen)) return;
    const RangeSample& sample = range.reader.value();
    const Time stamp = range.reader.stamp();
    const double period_s = range.last.ns > 0 ? (stamp - range.last).s() : 0.05;
    range.last = std::max(range.last, stamp);
    // No echo tells nothing: leaves swallow some.
    if (std::isinf(sample.range_m)) return;
    const Pose X_WB{known_ins_.X_WB.q, law_.state().p_W()};
    if (ground_.may_be_ground(X_WB, sensors_[i], sample.half_angle_rad, sample.range_m)) {
      ++ground_echoes_;
      return;
    }
    law_.set_half_angle(i, sample.half_angle_rad);
    law_.correct_range(stamp, i, sample.range_m, std::max(period_s, 1e-3));
  }

  void tell(Time now) {
    const LocalisationState& state = law_.state();
    const int lost = law_.counters().lost;
    if (lost_news_.is_due(now, lost)) {
      news_.tell(Event::Level::kWarning,
                 fmt::format("lost: echoes or fixes contradict the estimate; begins anew near "
                             "({:.1f}, {:.1f}), alleys in question: {} ({} so far)",
                             state.p_W().x(), state.p_W().y(), law_.filter_count(), lost));
    }
    const Pose X_MB{known_ins_.X_WB.q, state.p_W() - state.map_shift_W()};
    watch_.look(now, index_, sensors_, X_MB, max_range_m_, news_);
    news_.write(now);
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
  Eigen::Vector3d p_BA_;
  SignalReader<Odometry> truth_, ins_;
  SignalReader<GnssFix> gps_;
  std::vector<Range> ranges_;
  Odometry known_ins_;  // the last that was finite
  MapWatch watch_;
  int ground_echoes_ = 0;
  CountedNews lost_news_;
  EstimatorNews news_;
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
      "Place between mapped rows from an inertial unit, satellite fixes and echoes: a bank of "
      "extended Kalman filters on the echoes themselves, one per alley in question.";
  spec.parameters = {
      text_parameter("ins", "ins", "signal of the aided inertial unit: velocity and attitude"),
      text_parameter("gps", "gps", "signal of the satellite receiver; '' = none"),
      number_list_parameter("antenna_m", "m", {0.0, 0.0, 0.0},
                            "where the antenna sits in B (x, y, z); taken off the fix", 3),
      text_list_parameter("ranges", {}, "names of the range sensors; empty: all ultrasounds"),
      integer_parameter("cone_rays", 7, 1, 31,
                        "rays over a sensor's cone whose first return is predicted"),
      positive_parameter("range_bound_m", "m", 0.003, "largest error of an echo's distance"),
      positive_parameter("max_range_m", "m", 4.0, "walls farther away than this are not used"),
      number_parameter("start_std_m", "m", 0.26, 0.0, 100.0,
                       "1 sigma of the place at the start, each axis"),
      number_parameter("velocity_density_m_rts", "m/sqrt(s)", 0.003, 0.0, 10.0,
                       "white part of the velocity's error, summed up"),
      number_parameter("velocity_std_mps", "m/s", 0.05, 0.0, 10.0,
                       "1 sigma of the velocity's slow error, each axis"),
      positive_parameter("velocity_time_s", "s", 5.0, "its correlation time"),
      number_parameter("heading_std_deg", "deg", 0.2, 0.0, 90.0,
                       "1 sigma of the heading's slow error"),
      positive_parameter("heading_time_s", "s", 60.0, "its correlation time"),
      number_parameter("heading_white_std_deg", "deg", 0.2, 0.0, 90.0,
                       "1 sigma of the heading's error that changes with every reading"),
      number_parameter("fix_walk_std_m", "m", 0.7, 0.0, 100.0,
                       "1 sigma of the fixes' slow error, east and north; up 1.5 times as much"),
      positive_parameter("fix_walk_time_s", "s", 60.0, "its correlation time"),
      number_parameter("fix_slow_share", "", 0.0, 0.0, 0.999,
                       "share of the variance that a fix states which is slow error, another one "
                       "in each of the receiver's modes, as with RTK; 0: a fix states its white "
                       "error alone, and fix_walk_std_m holds"),
      number_parameter("map_shift_std_m", "m", 0.0, 0.0, 100.0,
                       "1 sigma of a shift of the whole map, beside what its maker states"),
      choice_parameter("place", "on_map", {"on_map", "in_world"},
                       "where a map's shift is a state, the estimate is the place beside the map's "
                       "walls, where planners on the same map want it, or that in the world; the "
                       "covariance is against the world either way"),
      positive_parameter("gate_sigma", "", 3.5, "echoes farther from their prediction are false"),
      positive_parameter("fix_gate_sigma", "", 5.0, "so are fixes"),
      positive_parameter("huber_sigma", "", 1.5, "echoes farther off than this weigh less"),
      boolean_parameter("walls_tell_height", true,
                        "whether echoes off walls that lean correct the height; false on maps of "
                        "point clouds, whose walls lean otherwise than the true ones"),
      number_parameter("false_share", "", 0.1, 1e-6, 0.9,
                       "share of the echoes that no wall explains, for the alleys' weights"),
      integer_parameter("bank", 5, 1, 8, "filters at most, one per alley in question"),
      positive_parameter("bank_std_m", "m", 0.5,
                         "a place known less well than this begins with one filter per alley"),
  };
  for (ParameterSpec& parameter : ground_parameters()) {
    spec.parameters.push_back(std::move(parameter));
  }
  spec.default_rate_Hz = 100.0;
  spec.reads = {"truth", "<ins>", "<gps>", "<ranges>", "<down>"};
  spec.writes = {"estimate", "estimator_state", "estimator_event"};
  return spec;
}

std::unique_ptr<Estimator> make_map_localisation(const ParameterSet& parameters,
                                                 const EstimatorContext& context) {
  return std::make_unique<MapLocalisation>(parameters, context);
}

}  // namespace vinerow

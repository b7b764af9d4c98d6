#include "controllers/estimation/map_localisation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/estimation/map_localisation_law.h"
#include "controllers/estimation/range_sensors.h"
#include "controllers/estimation/row_ground.h"
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
  params.huber_sigma = parameters.number("huber_sigma");
  params.max_range_m = parameters.number("max_range_m");
  params.false_share = parameters.number("false_share");
  params.bank = static_cast<int>(parameters.integer("bank"));
  params.bank_std_m = parameters.number("bank_std_m");
  return params;
}

std::vector<RangeSensorModel> read_range_sensors(const ParameterSet& parameters,
                                                 const EstimatorContext& context) {
  std::vector<RangeSensorModel> sensors =
      find_range_sensors(parameters.texts("ranges"), context, context.part + " (map_localisation)");
  const std::string& down = parameters.text("down");
  std::erase_if(sensors, [&](const RangeSensorModel& sensor) { return sensor.name == down; });
  for (RangeSensorModel& sensor : sensors) {
    sensor.fan_rays = static_cast<int>(parameters.integer("cone_rays"));
    sensor.bound_m = parameters.number("range_bound_m");
  }
  return sensors;
}

const RowMap& map_of(const EstimatorContext& context) {
  demand_row_meshes(context, context.part + " (map_localisation)", "");
  return *context.map;
}

class MapLocalisation final : public Estimator {
 public:
  MapLocalisation(const ParameterSet& parameters, const EstimatorContext& context)
      : ins_name_(parameters.text("ins")),
        gps_name_(parameters.text("gps")),
        start_std_m_(parameters.number("start_std_m")),
        sensors_(read_range_sensors(parameters, context)),
        map_(map_of(context)),
        index_(map_),
        law_(read_params(parameters), map_, index_, sensors_),
        random_(context.random("start")) {
    const auto& antenna = parameters.numbers("antenna_m");
    p_BA_ = {antenna[0], antenna[1], antenna[2]};
    ground_std_m_ = parameters.number("ground_std_m");
    const std::string& down = parameters.text("down");
    if (!down.empty()) {
      down_ = find_range_sensors({down}, context, context.part + " (map_localisation)").front();
    }
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    ins_ = ports.read<Odometry>(ins_name_);
    if (!gps_name_.empty()) gps_ = ports.read<GnssFix>(gps_name_);
    for (const RangeSensorModel& sensor : sensors_) {
      ranges_.push_back({ports.read<RangeSample>(sensor.name), 0, Time{}});
    }
    if (down_) down_reader_ = ports.read<RangeSample>(down_->name);
    estimate_ = ports.write<Odometry>("estimate");
    state_writer_ = ports.write<NamedValues>("estimator_state");
    state_.names = {"filters",     "best_weight",      "nis_echo",           "nis_fix",
                    "echoes",      "echoes_gated",     "echoes_unexplained", "fixes",
                    "fixes_gated", "heights",          "heights_gated",      "refused",
                    "lost",        "map_shift_east_m", "map_shift_north_m",  "heading_error_rad"};
    state_.values.assign(state_.names.size(), 0.0);
  }

  void step(Time now) override {
    if (!ins_.has_value() || !truth_.has_value()) return;
    const Odometry& ins = ins_.value();
    if (!law_.has_started()) {
      // The inertial unit's attitude is known from the first reading; the place is drawn.
      const Eigen::Vector3d draw(random_.normal(), random_.normal(), random_.normal());
      law_.start(now, truth_.value().X_WB.p + start_std_m_ * draw,
                 start_std_m_ * start_std_m_ * Eigen::Matrix3d::Identity());
    }
    law_.predict(now, ins.X_WB.q * ins.v_WB_B, ins.X_WB.q);
    if (!gps_name_.empty() && gps_.is_newer_than(seen_fix_)) {
      const GnssFix& fix = gps_.value();
      if (fix.valid) law_.correct_fix(gps_.stamp(), fix.p_W, fix.std_m, p_BA_);
    }
    if (down_ && down_reader_.is_newer_than(seen_down_)) take_height(ins.X_WB.q);
    for (std::size_t i = 0; i < ranges_.size(); ++i) take_range(static_cast<int>(i));
    write(now, ins);
  }

 private:
  struct Range {
    SignalReader<RangeSample> reader;
    std::uint64_t seen;
    Time last;
  };

  /// The echo of what looks down, from the ground between the rows.
  void take_height(const Eigen::Quaterniond& q_WB) {
    const RangeSample& sample = down_reader_.value();
    if (!std::isfinite(sample.range_m)) return;
    const auto ground = find_ground(map_, law_.state().p_W());
    if (!ground) return;
    const Eigen::Vector3d dir_W = q_WB * down_->X_BS.q * Eigen::Vector3d::UnitX();
    const auto distance_m = plane_distance_m(*ground, dir_W, sample.half_angle_rad, sample.range_m);
    if (!distance_m) return;
    const double lever_m = ground->normal_W.dot(q_WB * down_->X_BS.p);
    law_.correct_plane(down_reader_.stamp(), ground->normal_W,
                       ground->offset_m + *distance_m - lever_m, ground_std_m_);
  }

  void take_range(int i) {
    Range& range = ranges_[i];
    if (!range.reader.is_newer_than(range.seen)) return;
    const RangeSample& sample = range.reader.value();
    const Time stamp = range.reader.stamp();
    const double period_s = range.last.ns > 0 ? (stamp - range.last).s() : 0.05;
    range.last = stamp;
    // No echo tells nothing: leaves swallow some.
    if (std::isinf(sample.range_m)) return;
    law_.set_half_angle(i, sample.half_angle_rad);
    law_.correct_range(stamp, i, sample.range_m, std::max(period_s, 1e-3));
  }

  void write(Time now, const Odometry& ins) {
    const LocalisationState& state = law_.state();
    Odometry estimate;
    estimate.X_WB.q =
        Eigen::AngleAxisd(-state.heading_error_rad(), Eigen::Vector3d::UnitZ()) * ins.X_WB.q;
    estimate.X_WB.p = state.p_W();
    estimate.v_WB_B =
        estimate.X_WB.q.conjugate() * (ins.X_WB.q * ins.v_WB_B - state.velocity_error_W());
    estimate.w_WB_B = ins.w_WB_B;
    estimate.set_position_covariance(law_.position_covariance());
    const int heading = LocalisationState::kHeading;
    estimate.yaw_std_rad =
        std::hypot(std::sqrt(state.covariance()(heading, heading)), ins.yaw_std_rad);
    estimate_.write(now, estimate);
    const MapLocalisationLaw::Counters& counters = law_.counters();
    const Eigen::Vector3d shift_W = state.map_shift_W();
    const double values[] = {static_cast<double>(law_.filter_count()),
                             law_.best_weight(),
                             law_.echo_nis(),
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
                             state.heading_error_rad()};
    std::copy(std::begin(values), std::end(values), state_.values.begin());
    state_writer_.write(now, state_);
  }

  std::string ins_name_;
  std::string gps_name_;
  double start_std_m_;
  std::vector<RangeSensorModel> sensors_;
  const RowMap& map_;
  RowMeshIndex index_;
  MapLocalisationLaw law_;
  RandomStream random_;
  Eigen::Vector3d p_BA_;
  SignalReader<Odometry> truth_, ins_;
  SignalReader<GnssFix> gps_;
  std::optional<RangeSensorModel> down_;
  double ground_std_m_;
  SignalReader<RangeSample> down_reader_;
  std::uint64_t seen_down_ = 0;
  std::vector<Range> ranges_;
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
      text_parameter("down", "", "name of a range sensor that looks at the ground; '' = none"),
      positive_parameter("ground_std_m", "m", 0.05,
                         "1 sigma of a height above the ground between the rows"),
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
      number_parameter("map_shift_std_m", "m", 0.0, 0.0, 100.0,
                       "1 sigma of a shift of the whole map, beside what its maker states"),
      positive_parameter("gate_sigma", "", 3.5, "echoes farther from their prediction are false"),
      positive_parameter("fix_gate_sigma", "", 5.0, "so are fixes"),
      positive_parameter("huber_sigma", "", 1.5, "echoes farther off than this weigh less"),
      number_parameter("false_share", "", 0.1, 1e-6, 0.9,
                       "share of the echoes that no wall explains, for the alleys' weights"),
      integer_parameter("bank", 5, 1, 8, "filters at most, one per alley in question"),
      positive_parameter("bank_std_m", "m", 0.5,
                         "a place known less well than this begins with one filter per alley"),
  };
  spec.default_rate_Hz = 100.0;
  spec.reads = {"truth", "<ins>", "<gps>", "<ranges>"};
  spec.writes = {"estimate", "estimator_state"};
  return spec;
}

std::unique_ptr<Estimator> make_map_localisation(const ParameterSet& parameters,
                                                 const EstimatorContext& context) {
  return std::make_unique<MapLocalisation>(parameters, context);
}

}  // namespace vinerow

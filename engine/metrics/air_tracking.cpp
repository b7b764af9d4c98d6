#include "engine/metrics/air_tracking.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/flight.h"
#include "engine/api/plan_stretch.h"
#include "engine/math/angles.h"
#include "engine/metrics/spread.h"

namespace vinerow::metrics {
namespace {

constexpr std::array<const char*, 4> kOutside = {"outside_lon_states", "outside_lon_inputs",
                                                 "outside_lat_states", "outside_lat_inputs"};
constexpr std::array<const char*, 4> kLimitSteps = {
    "limit_steps_lon_states", "limit_steps_lon_inputs", "limit_steps_lat_states",
    "limit_steps_lat_inputs"};

class AirTracking final : public Metric {
 public:
  explicit AirTracking(const MetricContext& context)
      : vehicle_(context.vehicle_truth),
        gravity_mps2_(context.gravity_mps2),
        has_wings_(context.vehicle_description->fixed_wing.has_value()) {
    outside_at_.fill(-1);
  }

  void connect(Ports& ports) override {
    if (!has_wings_) return;  // other vehicles' "reference" has another type
    truth_ = ports.read<Odometry>("truth");
    reference_ = ports.read_optional<AirReference>("reference");
    deviation_ = ports.read_optional<NamedValues>("deviation");
    landing_ = ports.read_optional<NamedValues>("landing");
    plan_.connect(ports);
  }

  void step(Time) override {
    if (!has_wings_) return;
    plan_.take_over();
    if (!reference_.has_value()) return;
    const AirReference& wanted = reference_.value();
    if (wanted.phase == AirReference::Phase::kDone && !wanted.power && landing_.has_value()) {
      const Eigen::Vector2d wanted_W(landing_.value().values[0], landing_.value().values[1]);
      landing_m_ = (truth_.value().X_WB.p.head<2>() - wanted_W).norm();
    }
    const bool is_straight = wanted.phase == AirReference::Phase::kStraight;
    if (!is_straight && wanted.phase != AirReference::Phase::kTurn) return;
    const Pose& X_WB = truth_.value().X_WB;
    const RollPitchYaw attitude = rpy_from_quaternion(X_WB.q);
    height_m_.add(X_WB.p.z() - wanted.height_m);
    const double heading_error_rad = wrap_angle(attitude.yaw_rad - wanted.heading_rad);
    heading_rad_.add(heading_error_rad);
    bank_rad_.add(attitude.roll_rad);
    if (vehicle_ != nullptr) {
      airspeed_mps_.add(vehicle_->air_velocity_B().norm() - wanted.airspeed_mps);
      load_factor_ = std::max(load_factor_, vehicle_->specific_force_B().z() / gravity_mps2_);
    }
    if (is_straight) {
      straight_heading_rad_.add(heading_error_rad);
      if (plan_.has_plan()) watch_leg(X_WB.p);
    }
    watch_limits();
  }

  std::map<std::string, double> results() const override {
    if (!has_wings_) return {};
    std::map<std::string, double> results = {
        {"height_error_rms_m", height_m_.rms()},
        {"height_error_max_m", height_m_.max_or_nan()},
        {"heading_error_rms_deg", deg_from_rad(heading_rad_.rms())},
        {"straight_heading_error_rms_deg", deg_from_rad(straight_heading_rad_.rms())},
        {"straight_cross_track_rms_m", cross_track_m_.rms()},
        {"straight_cross_track_max_m", cross_track_m_.max_or_nan()},
        {"airspeed_error_rms_mps", airspeed_mps_.rms()},
        {"bank_max_deg", deg_from_rad(bank_rad_.max_or_nan())},
        {"load_factor_max", airspeed_mps_.count > 0 ? load_factor_ : kNotMeasured},
        {"limit_share_max", limit_share_.max_or_nan()},
        {"landing_distance_m", landing_m_}};
    for (std::size_t i = 0; i < kLimitSteps.size(); ++i) {
      results[kLimitSteps[i]] =
          limit_share_.count > 0 ? static_cast<double>(limit_steps_[i]) : kNotMeasured;
    }
    return results;
  }

 private:
  void watch_leg(const Eigen::Vector3d& p_W) {
    const PlanStretch::Place place = plan_.find(p_W);
    if (plan_.is_leg(place.segment)) cross_track_m_.add(place.lateral_m);
  }

  /// Counts each deviation once, whatever the metric's rate.
  void watch_limits() {
    if (!deviation_.is_newer_than(deviations_seen_)) return;
    const NamedValues& deviation = deviation_.value();
    if (share_at_ < 0 && !find_names(deviation.names)) return;
    limit_share_.add(deviation.values[static_cast<std::size_t>(share_at_)]);
    for (std::size_t i = 0; i < kOutside.size(); ++i) {
      limit_steps_[i] += deviation.values[static_cast<std::size_t>(outside_at_[i])] > 0.5;
    }
  }

  /// Finds the indices of the values once, because a writer's names are fixed when it connects.
  /// @returns true if all names exist
  bool find_names(const std::vector<std::string>& names) {
    const auto place_of = [&names](const char* name) {
      const auto found = std::find(names.begin(), names.end(), name);
      return found == names.end() ? -1 : static_cast<int>(found - names.begin());
    };
    for (std::size_t i = 0; i < kOutside.size(); ++i) {
      outside_at_[i] = place_of(kOutside[i]);
      if (outside_at_[i] < 0) return false;
    }
    share_at_ = place_of("limit_share");
    return share_at_ >= 0;
  }

  SignalReader<NamedValues> landing_;
  double landing_m_ = kNotMeasured;  // true distance from the wanted landing point
  const Vehicle* vehicle_;
  double gravity_mps2_;
  bool has_wings_;
  SignalReader<Odometry> truth_;
  SignalReader<AirReference> reference_;
  SignalReader<NamedValues> deviation_;
  PlanStretch plan_;
  std::uint64_t deviations_seen_ = 0;
  std::array<int, 4> outside_at_;
  int share_at_ = -1;
  Spread height_m_, heading_rad_, straight_heading_rad_, cross_track_m_, airspeed_mps_, bank_rad_;
  Spread limit_share_;
  double load_factor_ = -std::numeric_limits<double>::infinity();
  std::array<std::int64_t, 4> limit_steps_ = {0, 0, 0, 0};
};

}  // namespace

const std::vector<ResultSpec>& air_tracking_results() {
  using Range = ResultRange;
  static const std::vector<ResultSpec> results = {
      {"height_error_rms_m", "m", Range::from_zero(), "RMS height error",
       "Fixed wings: root mean square of true height minus reference height. Like all tracking "
       "metrics of fixed wings, measured while the reference is straight or turns, without launch, "
       "loiter and landing.",
       "paper A, §2, fig. 9-11"},
      {"height_error_max_m", "m", Range::from_zero(), "max height error",
       "Fixed wings: largest absolute difference of true and reference height while the reference "
       "is straight or turns.",
       "paper A, §2, fig. 9-11"},
      {"heading_error_rms_deg", "deg", Range::zero_to(180.0), "RMS heading error",
       "Fixed wings: root mean square of true heading minus reference heading while the reference "
       "is straight or turns.",
       "paper A, §2"},
      {"straight_heading_error_rms_deg", "deg", Range::zero_to(180.0),
       "RMS heading error on straights",
       "Fixed wings: root mean square of true heading minus reference heading while the reference "
       "is straight.",
       "paper A, §2"},
      {"straight_cross_track_rms_m", "m", Range::from_zero(), "RMS lateral error on lanes",
       "Fixed wings: root mean square of the true horizontal distance from the lane while the "
       "reference is straight.",
       "paper A, §2"},
      {"straight_cross_track_max_m", "m", Range::from_zero(), "max lateral error on lanes",
       "Fixed wings: largest true horizontal distance from the lane while the reference is "
       "straight.",
       "paper A, §2"},
      {"airspeed_error_rms_mps", "m/s", Range::from_zero(), "RMS airspeed error",
       "Fixed wings: root mean square of true airspeed minus reference airspeed while the "
       "reference is straight or turns.",
       "paper A, §2, fig. 9-11"},
      {"bank_max_deg", "deg", Range::zero_to(180.0), "max bank angle",
       "Fixed wings: largest absolute true roll angle while the reference is straight or turns.",
       ""},
      {"load_factor_max", "1", Range::any(), "max load factor",
       "Fixed wings: largest specific force along the body's z axis divided by g, while the "
       "reference is straight or turns.",
       ""},
      {"limit_steps_lon_states", "1", Range::count(), "longitudinal state violations",
       "Fixed wings: number of controller ticks with a longitudinal state outside the limits that "
       "the controller monitors (signal `deviation`).",
       "paper A, §2.2 (±10 %)"},
      {"limit_steps_lon_inputs", "1", Range::count(), "longitudinal input violations",
       "Fixed wings: number of controller ticks with throttle or elevator farther from trim than "
       "the controller's limit.",
       "paper A, §2.2 (20 %)"},
      {"limit_steps_lat_states", "1", Range::count(), "lateral state violations",
       "Fixed wings: number of controller ticks with a lateral state outside the limits that the "
       "controller monitors.",
       "paper A, §2.2 (±10 %)"},
      {"limit_steps_lat_inputs", "1", Range::count(), "lateral input violations",
       "Fixed wings: number of controller ticks with the aileron farther from trim than the "
       "controller's limit.",
       "paper A, §2.2 (20 %)"},
      {"limit_share_max", "1", Range::from_zero(), "max fraction of limits used",
       "Fixed wings: largest fraction of its limit that any monitored state or input reached; 1 is "
       "at the limit.",
       "paper A, §2.2"},
      {"landing_distance_m", "m", Range::from_zero(), "landing error",
       "Fixed wings: true horizontal distance of the landed vehicle from the planned touchdown "
       "position.",
       ""}};
  return results;
}

PartSpec air_tracking_spec() {
  PartSpec spec;
  spec.name = "air_tracking";
  spec.description =
      "Fixed-wing vehicles: errors of height, heading, cross-track and airspeed in the survey, "
      "bank, load factor, and ticks outside the controller's limits (paper A, figures 9 to 11)";
  spec.reads = {"truth", "reference (optional)", "deviation (optional)", "landing (optional)",
                "plan (optional)"};
  spec.results = air_tracking_results();
  return spec;
}

std::unique_ptr<Metric> make_air_tracking(const ParameterSet&, const MetricContext& context) {
  return std::make_unique<AirTracking>(context);
}

}  // namespace vinerow::metrics

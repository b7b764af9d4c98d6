#include "engine/metrics/flight_metric.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/flight.h"
#include "engine/api/plan_stretch.h"
#include "engine/math/angles.h"
#include "engine/metrics/extremes.h"
#include "engine/metrics/spread.h"

namespace vinerow::metrics {
namespace {

/// Largest tangential acceleration of a reference at constant row speed. Chosen: following the
/// ground's waves needs less, slowing down for a turn more.
constexpr double kConstantSpeed_mps2 = 0.1;
/// Height of B's origin above its height on the ground, from which the vehicle is in the air.
/// Chosen.
constexpr double kInTheAir_m = 0.1;
/// Height above B's origin from which the ground is searched downwards. Chosen: finds the ground
/// even if the vehicle has sunk into it.
constexpr double kLookFrom_m = 0.5;
/// Length of the ray that measures the return clearance. Chosen: above any flight height.
constexpr double kFarthestBelow_m = 1000.0;
/// Distance from a limit, as a share of the command's range, up to which a command is at it.
/// Chosen: covers rounding only.
constexpr double kAtLimit = 1e-6;

class Flight final : public Metric {
 public:
  explicit Flight(const MetricContext& context)
      : scene_(context.scene),
        description_(context.vehicle_description),
        vehicle_(context.vehicle_truth),
        has_wings_(description_->fixed_wing.has_value()) {}

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    plan_.connect(ports);
    // Fixed-wing vehicles have another reference (AirReference), which air_tracking judges.
    if (!has_wings_) reference_ = ports.read_optional<ReferenceTrajectory>("reference");
    actuators_ = ports.read_optional<NamedValues>("actuators");
  }

  void step(Time) override {
    if (!description_->flies() || crashed()) return;
    plan_.take_over();
    const Odometry& truth = truth_.value();
    const Eigen::Vector3d& p_W = truth.X_WB.p;
    const std::optional<double> ground_m =
        scene_->ground_height_m(p_W.x(), p_W.y(), p_W.z() + kLookFrom_m);
    const double height_m = ground_m ? p_W.z() - *ground_m : kNotMeasured;
    if (height_m > description_->height_above_ground_m + kInTheAir_m) {
      watch_rotors();
      const Eigen::Vector3d up_W = truth.X_WB.q * Eigen::Vector3d::UnitZ();
      tilt_rad_.add(std::acos(std::clamp(up_W.z(), -1.0, 1.0)));
    }
    watch_hover(p_W);
    if (!plan_.has_plan()) return;
    const PlanStretch::Place place = plan_.find(p_W);
    if (plan_.is_leg(place.segment)) {
      if (plan_.is_flight()) altitude_.add(p_W.z() - place.plan_z_m);
      if (ground_m) row_height_m_.add(height_m);
      watch_speed(truth.v_WB_B.norm());
    } else if (plan_.is(PathKind::kReturn, place.segment) && !plan_.is_steep(place.segment)) {
      const auto below = scene_->cast_ray(p_W, -Eigen::Vector3d::UnitZ(), kFarthestBelow_m);
      if (below) return_clearance_m_.add(below->distance_m);
    }
  }

  std::map<std::string, double> results() const override {
    if (!description_->flies()) return {};
    std::map<std::string, double> results = {
        {"altitude_error_rms_m", altitude_.rms()},
        {"altitude_error_max_m", altitude_.max_or_nan()},
        {"height_above_ground_min_m", row_height_m_.min_or_nan()},
        {"height_above_ground_max_m", row_height_m_.max_or_nan()},
        {"row_speed_mean_mps", share(speed_sum_mps_, speeds_)},
        {"tilt_max_deg", deg_from_rad(tilt_rad_.max_or_nan())},
        {"crashed", crashed() ? 1.0 : 0.0}};
    if (has_wings_) return results;
    results["row_speed_error_max_mps"] = speed_error_.max_or_nan();
    results["return_clearance_min_m"] = return_clearance_m_.min_or_nan();
    results["hover_error_rms_m"] = hover_m_.rms();
    results["hover_error_max_m"] = hover_m_.max_or_nan();
    results["thrust_limit_share"] = share(static_cast<double>(limited_), airborne_);
    return results;
  }

 private:
  static double share(double sum, std::int64_t count) {
    return count > 0 ? sum / static_cast<double>(count) : kNotMeasured;
  }

  bool crashed() const { return vehicle_ != nullptr && !vehicle_->crash().empty(); }

  void watch_speed(double speed_mps) {
    speed_sum_mps_ += speed_mps;
    ++speeds_;
    if (!reference_.has_value() || reference_.value().points.empty()) return;
    const TrajectoryPoint& wanted = reference_.value().points.front();
    const double wanted_mps = wanted.v_W.norm();
    if (wanted_mps <= 0.0) return;
    if (std::abs(wanted.a_W.dot(wanted.v_W)) > kConstantSpeed_mps2 * wanted_mps) return;
    speed_error_.add(speed_mps - wanted_mps);
  }

  void watch_hover(const Eigen::Vector3d& p_W) {
    if (!reference_.has_value() || reference_.value().points.empty()) return;
    if (reference_.value().phase != ReferenceTrajectory::Phase::kHover) return;
    hover_m_.add((p_W - reference_.value().points.front().p_W).norm());
  }

  void watch_rotors() {
    if (!actuators_.has_value()) return;
    const NamedValues& commands = actuators_.value();
    if (rotors_.size() != commands.names.size()) find_rotors(commands.names);
    ++airborne_;
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      if (rotors_[i] == nullptr) continue;
      const double slack = kAtLimit * (rotors_[i]->max - rotors_[i]->min);
      const double command = commands.values[i];
      if (command >= rotors_[i]->max - slack || command <= rotors_[i]->min + slack) {
        ++limited_;
        return;
      }
    }
  }

  /// Called once, because a writer's names are fixed when it connects.
  void find_rotors(const std::vector<std::string>& names) {
    rotors_.clear();
    for (const std::string& name : names) {
      const auto spec = std::find_if(description_->actuators.begin(), description_->actuators.end(),
                                     [&](const ActuatorSpec& a) { return a.name == name; });
      const bool is_rotor = name.starts_with("rotor_") && spec != description_->actuators.end();
      rotors_.push_back(is_rotor ? &*spec : nullptr);
    }
  }

  const SceneQuery* scene_;
  const VehicleDescription* description_;
  const Vehicle* vehicle_;
  bool has_wings_;
  SignalReader<Odometry> truth_;
  PlanStretch plan_;
  SignalReader<ReferenceTrajectory> reference_;
  SignalReader<NamedValues> actuators_;
  std::vector<const ActuatorSpec*> rotors_;  ///< of each name; null if it is not a rotor
  Spread altitude_, speed_error_, hover_m_;
  Extremes row_height_m_, return_clearance_m_, tilt_rad_;
  double speed_sum_mps_ = 0.0;
  std::int64_t speeds_ = 0;
  std::int64_t airborne_ = 0;
  std::int64_t limited_ = 0;
};

}  // namespace

const std::vector<ResultSpec>& flight_results() {
  using Range = ResultRange;
  static const std::vector<ResultSpec> results = {
      {"altitude_error_rms_m", "m", Range::from_zero(), "RMS altitude error on legs",
       "Flying vehicles: root mean square of true height minus planned height at the nearest point "
       "of the planned leg. The nearest point is searched in three dimensions, so that the flight "
       "home above the rows is not confused with the legs.",
       "paper A, §4.2"},
      {"altitude_error_max_m", "m", Range::from_zero(), "max altitude error on legs",
       "Flying vehicles: largest absolute difference of true height and planned height on the "
       "legs.",
       "paper A, §4.2"},
      {"height_above_ground_min_m", "m", Range::any(), "min height on legs",
       "Flying vehicles: smallest height of the origin above the true ground on the legs.",
       "paper A, §4.2"},
      {"height_above_ground_max_m", "m", Range::any(), "max height on legs",
       "Flying vehicles: largest height of the origin above the true ground on the legs.",
       "paper A, §4.2"},
      {"row_speed_mean_mps", "m/s", Range::from_zero(), "mean speed on legs",
       "Flying vehicles: mean true speed on the legs.", "paper A, §4.2"},
      {"row_speed_error_max_mps", "m/s", Range::from_zero(), "max speed error on legs",
       "Rotorcraft: largest difference of true speed and reference speed on the legs, where the "
       "reference speed is constant (tangential acceleration at most 0.1 m/s²).",
       "paper A, §4.2"},
      {"return_clearance_min_m", "m", Range::from_zero(), "min clearance on flight home",
       "Rotorcraft: smallest vertical distance to the ground, canopy or posts below, on the flight "
       "home without its initial climb.",
       "paper A, §4.2"},
      {"hover_error_rms_m", "m", Range::from_zero(), "RMS hover error",
       "Rotorcraft: root mean square of the distance from the hover position while the guidance is "
       "in the hover phase.",
       ""},
      {"hover_error_max_m", "m", Range::from_zero(), "max hover error",
       "Rotorcraft: largest distance from the hover position while the guidance is in the hover "
       "phase.",
       ""},
      {"tilt_max_deg", "deg", Range::zero_to(180.0), "max tilt",
       "Flying vehicles: largest angle between the body's z axis and the vertical in the air.", ""},
      {"thrust_limit_share", "1", Range::share(), "time with saturated rotor",
       "Rotorcraft: fraction of the ticks in the air in which the command of at least one rotor "
       "was at a limit.",
       "paper A, §4.2"},
      {"crashed", "1", Range::zero_or_one(), "crashed", "Flying vehicles: 1 after a crash, else 0.",
       ""}};
  return results;
}

PartSpec flight_spec() {
  PartSpec spec;
  spec.name = "flight";
  spec.description =
      "Flying vehicles: height and speed in the rows, clearance on the return, hover error, tilt "
      "in the air, rotors at their limits, crash";
  spec.reads = {"truth", "plan (optional)", "reference (optional)", "actuators (optional)"};
  spec.results = flight_results();
  return spec;
}

std::unique_ptr<Metric> make_flight(const ParameterSet&, const MetricContext& context) {
  return std::make_unique<Flight>(context);
}

}  // namespace vinerow::metrics

#include "engine/metrics/wheel_slip.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/plan_stretch.h"
#include "engine/metrics/spread.h"

namespace vinerow::metrics {
namespace {

/// Speed of rim and vehicle below which a slip has no meaning. Chosen.
constexpr double kStationary_mps = 0.05;
constexpr int kAbsent = -1;
/// Largest possible slip: the rim runs backwards as fast as the wheel moves forwards.
constexpr double kMaxSlip = 2.0;

/// "fl" for "wheel_fl_slip" and the ending "_slip"; empty if the name does not have that form.
std::string wheel_of(const std::string& name, const std::string& ending) {
  const std::string beginning = "wheel_";
  const bool fits = name.size() > beginning.size() + ending.size() && name.starts_with(beginning) &&
                    name.ends_with(ending);
  if (!fits) return "";
  return name.substr(beginning.size(), name.size() - beginning.size() - ending.size());
}

class WheelSlip final : public Metric {
 public:
  explicit WheelSlip(const MetricContext& context) {
    const VehicleDescription& vehicle = *context.vehicle_description;
    flies_ = vehicle.flies();
    if (vehicle.wheeled) radius_m_ = vehicle.wheeled->wheel_radius_m;
    // Results are needed by name before the first value of "wheels" exists.
    for (const ActuatorSpec& actuator : vehicle.actuators) {
      const std::string name = wheel_of(actuator.name, "_speed_radps");
      if (!name.empty()) wheels_.emplace_back(name);
    }
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    values_ = ports.read_optional<NamedValues>("wheels");
    plan_.connect(ports);
  }

  void step(Time) override {
    plan_.take_over();
    if (!values_.is_newer_than(values_seen_)) return;
    if (!found_) find_values();
    const Odometry& truth = truth_.value();
    const bool moves = truth.v_WB_B.norm() >= kStationary_mps;
    const bool turns = plan_.has_plan() && plan_.is_turn(plan_.find(truth.X_WB.p).segment);
    const std::vector<double>& values = values_.value().values;
    const auto value = [&](int index) { return index == kAbsent ? 0.0 : values[index]; };
    for (Wheel& wheel : wheels_) {
      if (wheel.slip_at == kAbsent) continue;
      if (wheel.load_at != kAbsent && value(wheel.load_at) <= 0.0) continue;
      const bool spins = std::abs(radius_m_ * value(wheel.speed_at)) >= kStationary_mps;
      if (!moves && !spins) continue;
      const double slip = value(wheel.slip_at);
      all_.add(slip);
      wheel.slip.add(slip);
      if (turns) turns_.add(slip);
      if (wheel.angle_at != kAbsent) angles_.add(value(wheel.angle_at));
    }
  }

  std::map<std::string, double> results() const override {
    // Flying vehicles without wheels have no such results, not even NaN.
    if (flies_ && wheels_.empty()) return {};
    std::map<std::string, double> results{{"slip_rms", all_.rms()},
                                          {"slip_max", all_.max_or_nan()},
                                          {"slip_rms_turn", turns_.rms()},
                                          {"slip_max_turn", turns_.max_or_nan()},
                                          {"slip_angle_rms_rad", angles_.rms()}};
    for (const Wheel& wheel : wheels_) {
      results["slip_rms_" + wheel.name] = wheel.slip.rms();
      results["slip_max_" + wheel.name] = wheel.slip.max_or_nan();
    }
    return results;
  }

 private:
  struct Wheel {
    explicit Wheel(std::string its_name) : name(std::move(its_name)) {}
    std::string name;
    int slip_at = kAbsent, angle_at = kAbsent, speed_at = kAbsent, load_at = kAbsent;
    Spread slip;
  };

  /// Called once, because a writer's names are fixed when it connects.
  void find_values() {
    found_ = true;
    const std::vector<std::string>& names = values_.value().names;
    const auto index_of = [&](const std::string& name) {
      const auto at = std::find(names.begin(), names.end(), name);
      return at == names.end() ? kAbsent : static_cast<int>(at - names.begin());
    };
    for (const std::string& name : names) {
      const std::string wheel = wheel_of(name, "_slip");
      if (wheel.empty()) continue;
      const bool known = std::any_of(wheels_.begin(), wheels_.end(),
                                     [&](const Wheel& w) { return w.name == wheel; });
      if (!known) wheels_.emplace_back(wheel);
    }
    for (Wheel& wheel : wheels_) {
      const std::string beginning = "wheel_" + wheel.name;
      wheel.slip_at = index_of(beginning + "_slip");
      wheel.angle_at = index_of(beginning + "_slip_angle_rad");
      wheel.speed_at = index_of(beginning + "_speed_radps");
      wheel.load_at = index_of(beginning + "_load_N");
    }
  }

  double radius_m_ = 0.0;
  bool flies_ = false;
  SignalReader<Odometry> truth_;
  SignalReader<NamedValues> values_;
  std::uint64_t values_seen_ = 0;
  PlanStretch plan_;
  bool found_ = false;
  std::vector<Wheel> wheels_;
  Spread all_, turns_, angles_;
};

}  // namespace

const std::vector<ResultSpec>& wheel_slip_results() {
  using Range = ResultRange;
  static const std::vector<ResultSpec> results = {
      {"slip_rms", "1", Range::zero_to(kMaxSlip), "RMS wheel slip",
       "Root mean square, over all wheels, of the longitudinal slip (Rω - v) / max(|Rω|, |v|), "
       "sampled at record.truth_rate_Hz. Wheels without load are excluded, and stationary ones "
       "(rim and vehicle slower than 0.05 m/s).",
       "paper A, §4.1"},
      {"slip_max", "1", Range::zero_to(kMaxSlip), "max wheel slip",
       "Largest longitudinal slip of any wheel.", "paper A, §4.1"},
      {"slip_rms_turn", "1", Range::zero_to(kMaxSlip), "RMS wheel slip in turns",
       "Root mean square of the longitudinal slip of all wheels in the turns of the plan.",
       "paper A, §4.1"},
      {"slip_max_turn", "1", Range::zero_to(kMaxSlip), "max wheel slip in turns",
       "Largest longitudinal slip of any wheel in the turns of the plan.", "paper A, §4.1"},
      {"slip_angle_rms_rad", "rad", Range::from_zero(), "RMS slip angle",
       "Root mean square, over all wheels, of the angle between the wheel's rolling direction and "
       "its velocity.",
       ""},
      {"slip_rms_<wheel>", "1", Range::zero_to(kMaxSlip), "RMS slip of one wheel",
       "Root mean square of the longitudinal slip of the named wheel.", "paper A, §4.1"},
      {"slip_max_<wheel>", "1", Range::zero_to(kMaxSlip), "max slip of one wheel",
       "Largest longitudinal slip of the named wheel.", "paper A, §4.1"}};
  return results;
}

PartSpec wheel_slip_spec() {
  PartSpec spec;
  spec.name = "wheel_slip";
  spec.description =
      "Slip of the wheels along their rolling direction, over all wheels and for each one";
  spec.reads = {"truth", "wheels (optional)", "plan (optional)"};
  spec.results = wheel_slip_results();
  return spec;
}

std::unique_ptr<Metric> make_wheel_slip(const ParameterSet&, const MetricContext& context) {
  return std::make_unique<WheelSlip>(context);
}

}  // namespace vinerow::metrics

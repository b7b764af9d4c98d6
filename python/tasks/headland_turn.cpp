#include "python/tasks/headland_turn.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/sim/simulation.h"
#include "python/tasks/alley_track.h"
#include "python/tasks/skid_drive.h"
#include "python/tasks/vehicle_view.h"

namespace vinerow::tasks {
namespace {

struct TurnParams {
  double speed_mps = 1.0;
  double yaw_rate_radps = 0.8;
  double headland_m = 12.0;
  double inside_m = 1.0;
  double lateral_m = 0.15;
  double heading_rad = 0.17453292519943295;
  double heading_weight_m = 2.0;
  double time_price_per_s = 0.2;
  double success_reward = 20.0;
  double contact_price = 20.0;
};

const ParameterTable<TurnParams>& turn_table() {
  using P = TurnParams;
  static const auto table =
      ParameterTable<P>()
          .number("speed_mps", "m/s", &P::speed_mps, kPositive,
                  "speed of action +1; -1 drives backwards as fast")
          .number("yaw_rate_radps", "rad/s", &P::yaw_rate_radps, kPositive, "yaw rate of action +1")
          .number("headland_m", "m", &P::headland_m, kPositive,
                  "distance from the next alley's entrance at which the episode fails")
          .number("inside_m", "m", &P::inside_m, kNotNegative,
                  "distance inside the next alley that ends the turn")
          .number("lateral_m", "m", &P::lateral_m, kPositive,
                  "largest distance from its centre line there")
          .degrees("heading_deg", &P::heading_rad, above(0.0, 90.0),
                   "largest heading to its centre line there")
          .number("heading_weight_m", "m", &P::heading_weight_m, kNotNegative,
                  "distance that counts as much as heading in the opposite direction")
          .number("time_price_per_s", "1/s", &P::time_price_per_s, kNotNegative,
                  "price of a second")
          .number("success_reward", "", &P::success_reward, kNotNegative,
                  "reward for the completed turn")
          .number("contact_price", "", &P::contact_price, kNotNegative,
                  "price of touching something, or leaving the headland, which ends the episode");
  return table;
}

class HeadlandTurn final : public Task {
 public:
  HeadlandTurn(const TurnParams& params, const TaskContext& context)
      : params_(params),
        vehicle_(context.vehicle),
        who_(fmt::format("task headland_turn of '{}'", context.vehicle)),
        period_s_(context.period_s) {
    const auto far = static_cast<float>(params_.headland_m);
    const auto speed = static_cast<float>(2.0 * params_.speed_mps);
    observation_ = {{"along_m", -far, far},
                    {"lateral_m", -far, far},
                    {"cos_heading"},
                    {"sin_heading"},
                    {"speed_mps", -speed, speed},
                    {"yaw_rate_radps", -kMaxRate_radps, kMaxRate_radps},
                    {"last_speed_action"},
                    {"last_steering_action"}};
  }

  const std::vector<Element>& observation() const override { return observation_; }
  const std::vector<Element>& action() const override {
    static const std::vector<Element> all = {{"speed"}, {"steering"}};
    return all;
  }
  const std::vector<std::string>& numbers() const override {
    static const std::vector<std::string> all = {"time_s", "along_m", "lateral_m", "heading_rad"};
    return all;
  }
  OutsideSignal taken_over() const override {
    return outside_signal<NamedValues>(vehicle_ + "/actuators");
  }

  void begin(Session& session) override {
    view_ = VehicleView(session, vehicle_);
    estimate_ = session.signal<Odometry>(vehicle_ + "/estimate");
    drive_ = SkidDrive(vehicle_ + "/actuators", view_.description(), who_);
    session.advance(session.now());
    const RowMap& rows = *session.simulation().world().rows;
    target_ = AlleyTrack(rows, view_.pose(), who_).neighbour(rows, 1, who_);
    place_ = target_.place(view_.pose());
    last_ = {0.0F, 0.0F};
    time_s_ = 0.0;
  }

  void act(Session& session, std::span<const float> action) override {
    last_ = {action[0], action[1]};
    session.command(drive_.command(session.now(), action[0] * params_.speed_mps,
                                   action[1] * params_.yaw_rate_radps));
  }

  /// reward = potential(now) - potential(before) - time price * period, with the potential
  ///   -(distance to the entrance + heading weight * (1 - cos(heading)) / 2)
  /// (Ng, Harada, Russell, "Policy invariance under reward transformations", ICML 1999).
  Judgement judge(Session& /*session*/) override {
    const double before = potential();
    place_ = target_.place(view_.pose());
    time_s_ += period_s_;
    Judgement judgement;
    judgement.reward = potential() - before - params_.time_price_per_s * period_s_;
    if (view_.has_touched() || std::hypot(place_.along_m, place_.lateral_m) > params_.headland_m) {
      judgement.reward -= params_.contact_price;
      judgement.terminated = true;
    } else if (place_.along_m >= params_.inside_m &&
               std::abs(place_.lateral_m) <= params_.lateral_m &&
               std::abs(place_.heading_rad) <= params_.heading_rad) {
      judgement.reward += params_.success_reward;
      judgement.terminated = judgement.succeeded = true;
    }
    return judgement;
  }

  void observe(std::span<float> observation) override {
    const Odometry& estimate = estimate_.has_value() ? estimate_.value() : view_.truth();
    const AlleyTrack::Place seen = target_.place(estimate.X_WB);
    const std::array<double, 8> values = {seen.along_m,
                                          seen.lateral_m,
                                          std::cos(seen.heading_rad),
                                          std::sin(seen.heading_rad),
                                          estimate.v_WB_B.x(),
                                          estimate.w_WB_B.z(),
                                          last_[0],
                                          last_[1]};
    for (std::size_t i = 0; i < values.size(); ++i) {
      observation[i] =
          std::clamp(static_cast<float>(values[i]), observation_[i].low, observation_[i].high);
    }
  }

  void measure(std::span<double> numbers) const override {
    numbers[0] = time_s_;
    numbers[1] = place_.along_m;
    numbers[2] = place_.lateral_m;
    numbers[3] = place_.heading_rad;
  }

 private:
  static constexpr float kMaxRate_radps = 3.0F;

  double potential() const {
    const double before_m = std::max(params_.inside_m - place_.along_m, 0.0);
    return -std::hypot(before_m, place_.lateral_m) -
           params_.heading_weight_m * 0.5 * (1.0 - std::cos(place_.heading_rad));
  }

  TurnParams params_;
  std::string vehicle_, who_;
  double period_s_;
  std::vector<Element> observation_;
  VehicleView view_;
  SignalView<Odometry> estimate_;
  SkidDrive drive_;
  AlleyTrack target_;
  AlleyTrack::Place place_;
  std::array<float, 2> last_{};
  double time_s_ = 0.0;
};

}  // namespace

TaskSpec headland_turn_spec() {
  return {"headland_turn",
          "A rover leaves its alley and turns on the headland into the next one, in the least time",
          turn_table().specs()};
}

std::unique_ptr<Task> make_headland_turn(const ParameterSet& parameters,
                                         const TaskContext& context) {
  return std::make_unique<HeadlandTurn>(turn_table().read(parameters, "headland_turn"), context);
}

}  // namespace vinerow::tasks

#include "python/tasks/row_flight.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/sim/simulation.h"
#include "python/tasks/alley_track.h"
#include "python/tasks/vehicle_view.h"

namespace vinerow::tasks {
namespace {

constexpr std::array kFlightRangers = {"left", "right", "down"};

struct FlightParams {
  double speed_mps = 2.0;
  double lateral_mps = 1.0;
  double climb_mps = 0.5;
  double yaw_rate_radps = 0.5;
  double height_m = 1.5;
  double take_off_mps = 0.75;
  double range_m = 4.0;
  double deviation_price_per_m = 3.0;
  double height_price_per_m = 2.0;
  double heading_price = 0.5;
  double change_price = 0.02;
  double contact_price = 30.0;
};

const ParameterTable<FlightParams>& flight_table() {
  using P = FlightParams;
  static const auto table =
      ParameterTable<P>()
          .number("speed_mps", "m/s", &P::speed_mps, kPositive, "forward speed of action +1; -1: 0")
          .number("lateral_mps", "m/s", &P::lateral_mps, kPositive,
                  "speed to the left of action +1")
          .number("climb_mps", "m/s", &P::climb_mps, kPositive, "climb of action +1")
          .number("yaw_rate_radps", "rad/s", &P::yaw_rate_radps, kPositive, "yaw rate of action +1")
          .number("height_m", "m", &P::height_m, kPositive, "wanted height above the ground")
          .number("take_off_mps", "m/s", &P::take_off_mps, kPositive,
                  "climb of the take-off that precedes the episode")
          .number("range_m", "m", &P::range_m, kPositive,
                  "largest observed range; no echo: this one")
          .number("deviation_price_per_m", "1/m", &P::deviation_price_per_m, kNotNegative,
                  "price of a step per metre from the centre line")
          .number("height_price_per_m", "1/m", &P::height_price_per_m, kNotNegative,
                  "price of a step per metre from the wanted height")
          .number("heading_price", "", &P::heading_price, kNotNegative,
                  "price of a step per radian of heading to the alley")
          .number("change_price", "", &P::change_price, kNotNegative,
                  "price of a change of the action by 1, squared, in a step")
          .number("contact_price", "", &P::contact_price, kNotNegative,
                  "price of a contact or crash, which ends the episode");
  return table;
}

class RowFlight final : public Task {
 public:
  RowFlight(const FlightParams& params, const TaskContext& context)
      : params_(params),
        vehicle_(context.vehicle),
        who_(fmt::format("task row_flight of '{}'", context.vehicle)),
        period_s_(context.period_s) {
    const auto range = static_cast<float>(params_.range_m);
    for (const char* ranger : kFlightRangers) {
      observation_.push_back({fmt::format("{}_m", ranger), 0.0F, range});
    }
    for (const char* axis : {"forward", "left", "up"}) {
      observation_.push_back({fmt::format("speed_{}_mps", axis), -10.0F, 10.0F});
    }
    observation_.push_back({"roll_rad", -kPiF, kPiF});
    observation_.push_back({"pitch_rad", -kPiF, kPiF});
    observation_.push_back({"yaw_from_start_rad", -kPiF, kPiF});
    observation_.push_back({"yaw_rate_radps", -5.0F, 5.0F});
    for (const Element& element : action()) {
      observation_.push_back({"last_" + element.name + "_action"});
    }
  }

  const std::vector<Element>& observation() const override { return observation_; }
  const std::vector<Element>& action() const override {
    static const std::vector<Element> all = {{"forward"}, {"left"}, {"climb"}, {"yaw_rate"}};
    return all;
  }
  const std::vector<std::string>& numbers() const override {
    static const std::vector<std::string> all = {"average_deviation_m", "average_height_error_m",
                                                 "distance_m", "lateral_m"};
    return all;
  }
  OutsideSignal taken_over() const override {
    return outside_signal<ReferenceTrajectory>(vehicle_ + "/reference");
  }

  void begin(Session& session) override {
    view_ = VehicleView(session, vehicle_);
    for (std::size_t i = 0; i < kFlightRangers.size(); ++i) {
      rangers_[i] = session.signal<RangeSample>(vehicle_ + "/" + kFlightRangers[i]);
    }
    estimate_ = session.signal<Odometry>(vehicle_ + "/estimate");
    static_cast<void>(view_.description().need_rotorcraft(who_));
    session.advance(session.now());
    world_ = &session.simulation().world();
    alley_ = AlleyTrack(*world_->rows, view_.pose(), who_);
    start_yaw_rad_ = yaw_rad_ = yaw_from_quaternion(view_.pose().q);
    last_ = {};
    change_ = 0.0;
    deviation_sum_m_ = height_error_sum_m_ = 0.0;
    steps_ = 0;
    take_off(session);
    place_ = alley_.place(view_.pose());
    start_m_ = place_.along_m;
  }

  void act(Session& session, std::span<const float> action) override {
    change_ = 0.0;
    for (std::size_t i = 0; i < last_.size(); ++i) {
      change_ += std::pow(action[i] - last_[i], 2);
      last_[i] = action[i];
    }
    const Odometry& now = estimate();
    const double yaw_rate_radps = action[3] * params_.yaw_rate_radps;
    // Heading and height are integrated, so that a zero action holds them.
    yaw_rad_ += yaw_rate_radps * period_s_;
    up_m_ = std::clamp(up_m_ + action[2] * params_.climb_mps * period_s_, now.X_WB.p.z() - kLead_m,
                       now.X_WB.p.z() + kLead_m);
    const Eigen::Vector3d v_H(0.5 * (action[0] + 1.0) * params_.speed_mps,
                              action[1] * params_.lateral_mps, action[2] * params_.climb_mps);
    const double yaw = yaw_from_quaternion(now.X_WB.q);
    const Eigen::Vector3d p_W(now.X_WB.p.x(), now.X_WB.p.y(), up_m_);
    command(session, p_W, Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * v_H, yaw_rate_radps,
            ReferenceTrajectory::Phase::kRow);
  }

  /// reward = progress / (speed * period) - prices of deviation, height error, heading and change.
  Judgement judge(Session& /*session*/) override {
    const double before_m = place_.along_m;
    place_ = alley_.place(view_.pose());
    const double height_error_m = std::abs(height_m() - params_.height_m);
    deviation_sum_m_ += std::abs(place_.lateral_m);
    height_error_sum_m_ += height_error_m;
    ++steps_;
    Judgement judgement;
    judgement.reward = (place_.along_m - before_m) / (params_.speed_mps * period_s_) -
                       params_.deviation_price_per_m * std::abs(place_.lateral_m) -
                       params_.height_price_per_m * height_error_m -
                       params_.heading_price * std::abs(place_.heading_rad) -
                       params_.change_price * change_;
    if (view_.has_touched() || height_m() > kMaxHeights * params_.height_m) {
      judgement.reward -= params_.contact_price;
      judgement.terminated = true;
    } else if (place_.along_m >= alley_.length_m()) {
      judgement.terminated = judgement.succeeded = true;
    }
    return judgement;
  }

  void observe(std::span<float> observation) override {
    std::size_t next = 0;
    const auto put = [&](double value) {
      observation[next] =
          std::clamp(static_cast<float>(value), observation_[next].low, observation_[next].high);
      ++next;
    };
    for (const auto& ranger : rangers_) {
      put(seen_range_m(ranger, static_cast<float>(params_.range_m)));
    }
    const Odometry& now = estimate();
    const double yaw = yaw_from_quaternion(now.X_WB.q);
    const Eigen::Vector3d v_H =
        Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()) * (now.X_WB.q * now.v_WB_B);
    for (int axis = 0; axis < 3; ++axis) put(v_H[axis]);
    const RollPitchYaw rpy = rpy_from_quaternion(now.X_WB.q);
    put(rpy.roll_rad);
    put(rpy.pitch_rad);
    put(wrap_angle(yaw - start_yaw_rad_));
    put(now.w_WB_B.z());
    for (const float action : last_) put(action);
  }

  void measure(std::span<double> numbers) const override {
    const auto steps = static_cast<double>(std::max<std::int64_t>(steps_, 1));
    numbers[0] = deviation_sum_m_ / steps;
    numbers[1] = height_error_sum_m_ / steps;
    numbers[2] = place_.along_m - start_m_;
    numbers[3] = place_.lateral_m;
  }

 private:
  static constexpr float kPiF = static_cast<float>(kPi);
  /// Wanted heights above which it has flown away. Chosen: above every canopy.
  static constexpr double kMaxHeights = 3.0;
  static constexpr double kSettle_s = 1.0;
  /// Largest distance of the commanded height from the present one. Chosen.
  static constexpr double kLead_m = 0.3;

  const Odometry& estimate() const {
    return estimate_.has_value() ? estimate_.value() : view_.truth();
  }
  double height_m() const {
    const Eigen::Vector3d& p_W = view_.pose().p;
    return world_->terrain ? p_W.z() - world_->terrain->height_m(p_W.x(), p_W.y()) : p_W.z();
  }

  /// Straight up from the start at constant speed, then one second of rest.
  void take_off(Session& session) {
    const Eigen::Vector3d start_W = view_.pose().p;
    const double climb_m = std::max(params_.height_m - height_m(), 0.0);
    const double up_s = climb_m / params_.take_off_mps;
    up_m_ = start_W.z() + climb_m;
    for (double t_s = 0.0; t_s < up_s + kSettle_s && !session.over(); t_s += period_s_) {
      const double up_m = std::min(t_s * params_.take_off_mps, climb_m);
      const Eigen::Vector3d v_W(0.0, 0.0, t_s < up_s ? params_.take_off_mps : 0.0);
      command(session, start_W + Eigen::Vector3d(0.0, 0.0, up_m), v_W, 0.0,
              t_s < up_s ? ReferenceTrajectory::Phase::kTakeOff : ReferenceTrajectory::Phase::kRow);
      session.advance_for(duration_from_s(period_s_));
    }
    if (!session.over()) return;
    throw ConfigError(
        fmt::format("{}: the run is over after {:.3g} s, but the take-off takes {:.3g} s", who_,
                    session.now().s(), up_s + kSettle_s));
  }

  void command(Session& session, const Eigen::Vector3d& p_W, const Eigen::Vector3d& v_W,
               double yaw_rate_radps, ReferenceTrajectory::Phase phase) {
    reference_.phase = phase;
    // Two points a second apart: the controller interpolates between them until the next action.
    reference_.dt_s = 1.0;
    reference_.points.resize(2);
    for (int i = 0; i < 2; ++i) {
      TrajectoryPoint& point = reference_.points[i];
      point.p_W = p_W + i * v_W;
      point.v_W = v_W;
      point.yaw_rad = yaw_rad_ + i * yaw_rate_radps;
      point.yaw_rate_radps = yaw_rate_radps;
    }
    session.command(
        outside_command<ReferenceTrajectory>(vehicle_ + "/reference", session.now(), reference_));
  }

  FlightParams params_;
  std::string vehicle_, who_;
  double period_s_;
  std::vector<Element> observation_;
  VehicleView view_;
  std::array<SignalView<RangeSample>, kFlightRangers.size()> rangers_;
  SignalView<Odometry> estimate_;
  const WorldModel* world_ = nullptr;
  ReferenceTrajectory reference_;
  AlleyTrack alley_;
  AlleyTrack::Place place_;
  double start_yaw_rad_ = 0.0, yaw_rad_ = 0.0, up_m_ = 0.0, start_m_ = 0.0;
  std::array<float, 4> last_{};
  double change_ = 0.0;
  double deviation_sum_m_ = 0.0, height_error_sum_m_ = 0.0;
  std::int64_t steps_ = 0;
};

}  // namespace

TaskSpec row_flight_spec() {
  return {"row_flight",
          "A quadrotor takes off and flies along an alley in gusts, between the rows and at a "
          "constant height, from three range sensors",
          flight_table().specs()};
}

std::unique_ptr<Task> make_row_flight(const ParameterSet& parameters, const TaskContext& context) {
  return std::make_unique<RowFlight>(flight_table().read(parameters, "row_flight"), context);
}

}  // namespace vinerow::tasks

#include "python/tasks/row_following.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/payload.h"
#include "engine/core/error.h"
#include "engine/sim/simulation.h"
#include "python/tasks/alley_track.h"
#include "python/tasks/skid_drive.h"
#include "python/tasks/vehicle_view.h"

namespace vinerow::tasks {
namespace {

constexpr std::array kRangers = {"left_front", "left_rear", "right_front", "right_rear"};

struct RowParams {
  double speed_mps = 1.5;
  double yaw_rate_radps = 0.6;
  double range_m = 3.0;
  double smoothing_s = 0.5;
  double gap_m = 1.2;
  double deviation_price_per_m = 5.0;
  double steering_price = 0.05;
  double contact_price = 20.0;
};

ParameterTable<RowParams> row_table() {
  using P = RowParams;
  return ParameterTable<P>()
      .number("speed_mps", "m/s", &P::speed_mps, kPositive, "speed of action +1; -1 stops")
      .number("yaw_rate_radps", "rad/s", &P::yaw_rate_radps, kPositive, "yaw rate of action +1")
      .number("range_m", "m", &P::range_m, kPositive, "largest observed range; no echo: this one")
      .number("smoothing_s", "s", &P::smoothing_s, kPositive,
              "time constant of the smoothed ranges")
      .number("gap_m", "m", &P::gap_m, kPositive,
              "a longer range is a gap in the row, which the smoothed range ignores")
      .number("steering_price", "", &P::steering_price, kNotNegative,
              "price of a change of the steering action by 1, squared, in a step")
      .number("contact_price", "", &P::contact_price, kNotNegative,
              "price of touching something, which ends the episode");
}

const ParameterTable<RowParams>& following_table() {
  using P = RowParams;
  static const auto table =
      row_table().number("deviation_price_per_m", "1/m", &P::deviation_price_per_m, kNotNegative,
                         "price of a step per metre from the centre line");
  return table;
}

/// What both tasks share: sensors, drive, place in the alley.
class RowTask : public Task {
 public:
  RowTask(const RowParams& params, const TaskContext& context, std::string name)
      : params_(params),
        vehicle_(context.vehicle),
        who_(fmt::format("task {} of '{}'", name, context.vehicle)),
        period_s_(context.period_s),
        share_(context.period_s / (context.period_s + params.smoothing_s)) {
    const auto range = static_cast<float>(params_.range_m);
    for (const char* ranger : kRangers) {
      observation_.push_back({fmt::format("{}_m", ranger), 0.0F, range});
    }
    for (const char* ranger : kRangers) {
      observation_.push_back({fmt::format("{}_smooth_m", ranger), 0.0F, range});
    }
    observation_.push_back({"yaw_rate_radps", -kMaxRate_radps, kMaxRate_radps});
    observation_.push_back({"last_speed_action", -1.0F, 1.0F});
    observation_.push_back({"last_steering_action", -1.0F, 1.0F});
  }

  const std::vector<Element>& observation() const final { return observation_; }
  const std::vector<Element>& action() const final {
    static const std::vector<Element> all = {{"speed"}, {"steering"}};
    return all;
  }
  OutsideSignal taken_over() const final {
    return outside_signal<NamedValues>(vehicle_ + "/actuators");
  }

  void begin(Session& session) override {
    view_ = VehicleView(session, vehicle_);
    for (std::size_t i = 0; i < kRangers.size(); ++i) {
      rangers_[i] = session.signal<RangeSample>(vehicle_ + "/" + kRangers[i]);
    }
    imu_ = session.signal<ImuSample>(vehicle_ + "/imu");
    drive_ = SkidDrive(vehicle_ + "/actuators", view_.description(), who_);
    session.advance(session.now());
    alley_ = AlleyTrack(*session.simulation().world().rows, view_.pose(), who_);
    place_ = alley_.place(view_.pose());
    start_m_ = place_.along_m;
    last_ = {-1.0F, 0.0F};
    steering_change_ = 0.0F;
    deviation_sum_m_ = 0.0;
    steps_ = 0;
    for (std::size_t i = 0; i < kRangers.size(); ++i) {
      smooth_m_[i] = std::min<double>(range_m(i), params_.gap_m);
    }
  }

  void act(Session& session, std::span<const float> action) final {
    steering_change_ = action[1] - last_[1];
    last_ = {action[0], action[1]};
    session.command(drive_.command(session.now(), 0.5 * (action[0] + 1.0) * params_.speed_mps,
                                   action[1] * params_.yaw_rate_radps));
  }

  void observe(std::span<float> observation) final {
    for (std::size_t i = 0; i < kRangers.size(); ++i) {
      observation[i] = range_m(i);
      if (observation[i] <= params_.gap_m) {
        smooth_m_[i] += share_ * (observation[i] - smooth_m_[i]);
      }
      observation[kRangers.size() + i] = static_cast<float>(smooth_m_[i]);
    }
    std::size_t next = 2 * kRangers.size();
    const double rate = imu_.has_value() ? imu_.value().w_WS_S.z() : 0.0;
    observation[next++] = std::clamp(static_cast<float>(rate), -kMaxRate_radps, kMaxRate_radps);
    observation[next++] = last_[0];
    observation[next++] = last_[1];
  }

 protected:
  /// Rate at which a gyro of this class saturates would be higher; a rover never turns faster.
  static constexpr float kMaxRate_radps = 3.0F;

  /// @returns metres driven along the alley since the last call
  double move() {
    const double before_m = place_.along_m;
    place_ = alley_.place(view_.pose());
    deviation_sum_m_ += std::abs(place_.lateral_m);
    ++steps_;
    return place_.along_m - before_m;
  }
  bool has_touched() const {
    return view_.has_touched() || std::abs(place_.lateral_m) > 0.5 * alley_.width_m();
  }
  bool has_turned_round() const { return std::abs(place_.heading_rad) > 0.5 * M_PI; }
  bool at_end() const { return place_.along_m >= alley_.length_m(); }
  double steering_cost() const {
    return params_.steering_price * steering_change_ * steering_change_;
  }

  RowParams params_;
  std::string vehicle_, who_;
  double period_s_;
  VehicleView view_;
  AlleyTrack alley_;
  AlleyTrack::Place place_;
  double start_m_ = 0.0;
  double deviation_sum_m_ = 0.0;
  std::int64_t steps_ = 0;

 private:
  float range_m(std::size_t i) const {
    return seen_range_m(rangers_[i], static_cast<float>(params_.range_m));
  }

  double share_;  ///< of a new range in its smoothed value
  std::vector<Element> observation_;
  std::array<SignalView<RangeSample>, kRangers.size()> rangers_;
  std::array<double, kRangers.size()> smooth_m_{};
  SignalView<ImuSample> imu_;
  SkidDrive drive_;
  std::array<float, 2> last_{};
  float steering_change_ = 0.0F;
};

class RowFollowing final : public RowTask {
 public:
  RowFollowing(const RowParams& params, const TaskContext& context)
      : RowTask(params, context, "row_following") {}

  const std::vector<std::string>& numbers() const override {
    static const std::vector<std::string> all = {"average_deviation_m", "distance_m", "lateral_m"};
    return all;
  }

  /// reward = progress / (speed * period) - deviation price - steering price, per step.
  Judgement judge(Session& /*session*/) override {
    const double progress_m = move();
    Judgement judgement;
    judgement.reward = progress_m / (params_.speed_mps * period_s_) -
                       params_.deviation_price_per_m * std::abs(place_.lateral_m) - steering_cost();
    if (has_touched() || has_turned_round()) {
      judgement.reward -= params_.contact_price;
      judgement.terminated = true;
    } else if (at_end()) {
      judgement.terminated = judgement.succeeded = true;
    }
    return judgement;
  }

  void measure(std::span<double> numbers) const override {
    numbers[0] =
        steps_ > 0 ? deviation_sum_m_ / static_cast<double>(steps_) : std::abs(place_.lateral_m);
    numbers[1] = place_.along_m - start_m_;
    numbers[2] = place_.lateral_m;
  }
};

struct SprayingParams {
  RowParams row;
  double time_price_per_s = 0.5;
  double cover_reward = 100.0;
};

const ParameterTable<SprayingParams>& spraying_table() {
  using P = SprayingParams;
  static const auto table =
      ParameterTable<P>()
          .include(&P::row, row_table())
          .number("time_price_per_s", "1/s", &P::time_price_per_s, kNotNegative,
                  "price of a second")
          .number("cover_reward", "", &P::cover_reward, kNotNegative,
                  "reward for the canopy surface of one row that receives its dose");
  return table;
}

class Spraying final : public RowTask {
 public:
  Spraying(const SprayingParams& params, const TaskContext& context)
      : RowTask(params.row, context, "spraying"), prices_(params) {}

  const std::vector<std::string>& numbers() const override {
    static const std::vector<std::string> all = {"covered_rows", "worked_covered_share",
                                                 "distance_m", "average_deviation_m"};
    return all;
  }

  void begin(Session& session) override {
    RowTask::begin(session);
    sprayer_ = nullptr;
    for (const auto& [name, payload] : view_.runtime().payloads()) {
      if (name == "sprayer") sprayer_ = payload.get();
    }
    if (!sprayer_) {
      throw ConfigError(fmt::format("{} needs a payload 'sprayer' of the vehicle", who_));
    }
    rows_ = static_cast<double>(session.simulation().world().rows->rows.size());
    next_count_s_ = kCountPeriod_s;
    elapsed_s_ = covered_rows_ = worked_share_ = 0.0;
  }

  /// reward = -time price * period - steering price per step, and once per second, and at the end,
  /// cover reward * rows covered since then.
  Judgement judge(Session& session) override {
    static_cast<void>(move());
    elapsed_s_ += period_s_;
    Judgement judgement;
    judgement.reward = -prices_.time_price_per_s * period_s_ - steering_cost();
    if (has_touched() || has_turned_round()) {
      judgement.reward -= params_.contact_price;
      judgement.terminated = true;
    } else if (at_end()) {
      judgement.terminated = judgement.succeeded = true;
    }
    // Counting visits every patch of the canopy.
    if (judgement.terminated || session.over() || elapsed_s_ >= next_count_s_) {
      next_count_s_ += kCountPeriod_s;
      const auto results = sprayer_->results();
      // NaN where there is no canopy: vines in winter, and before the first row.
      const auto share = [&results](const char* name) {
        const double value = results.at(name);
        return std::isfinite(value) ? value : 0.0;
      };
      const double covered = share("covered_share") * rows_;
      judgement.reward += prices_.cover_reward * (covered - covered_rows_);
      covered_rows_ = covered;
      worked_share_ = share("worked_covered_share");
    }
    return judgement;
  }

  void measure(std::span<double> numbers) const override {
    numbers[0] = covered_rows_;
    numbers[1] = worked_share_;
    numbers[2] = place_.along_m - start_m_;
    numbers[3] = steps_ > 0 ? deviation_sum_m_ / static_cast<double>(steps_) : 0.0;
  }

 private:
  static constexpr double kCountPeriod_s = 1.0;

  SprayingParams prices_;
  const Payload* sprayer_ = nullptr;
  double rows_ = 0.0;
  double next_count_s_ = 0.0;
  double elapsed_s_ = 0.0;
  double covered_rows_ = 0.0;
  double worked_share_ = 0.0;
};

}  // namespace

TaskSpec row_following_spec() {
  return {"row_following",
          "A rover follows an alley to its end, as near to the centre line as it can, from four "
          "range sensors and a gyro",
          following_table().specs()};
}

std::unique_ptr<Task> make_row_following(const ParameterSet& parameters,
                                         const TaskContext& context) {
  return std::make_unique<RowFollowing>(following_table().read(parameters, "row_following"),
                                        context);
}

TaskSpec spraying_spec() {
  return {"spraying",
          "A rover sprays the rows beside its alley in the least time, with as little canopy as "
          "possible left without its dose",
          spraying_table().specs()};
}

std::unique_ptr<Task> make_spraying(const ParameterSet& parameters, const TaskContext& context) {
  return std::make_unique<Spraying>(spraying_table().read(parameters, "spraying"), context);
}

}  // namespace vinerow::tasks

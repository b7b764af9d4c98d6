#include "engine/live/pacer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace vinerow::live {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;

// Peers get a word in between two slices, so a slice should take about this much wall time.
constexpr double kSliceWall_s = 0.01;
constexpr double kMostLag_s = 0.25;  // more cannot be caught up: the speed is not held
constexpr double kWordsEvery_s = 10.0;
constexpr double kMeasureOver_s = 0.5;
constexpr Duration kShortest{1'000'000};

double seconds(Pacer::Clock::duration wall) {
  return duration<double>(wall).count();
}

}  // namespace

Pacer::Plan Pacer::plan(Time now, Clock::time_point wall, Duration longest) {
  // Without a limit, the slice grows or shrinks towards the wanted wall time, at most twofold.
  if (last_slice_ && now > last_slice_->simulated) {
    const double took_s = std::max(seconds(wall - last_slice_->wall), 1e-6);
    const double share = std::clamp(kSliceWall_s / took_s, 0.5, 2.0);
    slice_ = std::clamp(Duration{static_cast<std::int64_t>(share * static_cast<double>(slice_.ns))},
                        kShortest, longest);
  }
  last_slice_ = Moment{wall, now};
  if (speed_ <= 0.0) return {{}, slice_};

  if (!base_) base_ = Moment{wall, now};
  const double due_s = (now - base_->simulated).s() / speed_;
  const double ahead_s = due_s - seconds(wall - base_->wall);
  if (ahead_s < -kMostLag_s) {
    lag_s_ = -ahead_s;
    base_ = Moment{wall, now};
  }
  const Duration paced = std::max(duration_from_s(kSliceWall_s * speed_), Duration{1});
  Plan plan{{}, std::min({slice_, paced, longest})};
  if (ahead_s > 0.0) plan.wait = duration_cast<Clock::duration>(duration<double>(ahead_s));
  return plan;
}

std::string Pacer::take_lag() {
  // Not before the speed that the run makes is known.
  if (lag_s_ <= 0.0 || factor_ <= 0.0) return "";
  lag_s_ = 0.0;
  const Clock::time_point wall = last_slice_ ? last_slice_->wall : Clock::time_point{};
  if (last_words_ && seconds(wall - *last_words_) < kWordsEvery_s) return "";
  last_words_ = wall;
  return fmt::format(
      "the run cannot hold {:g} times real time: it makes {:.2g} (the result does not depend on "
      "that)",
      speed_, factor_);
}

double Pacer::measure(Time now, Clock::time_point wall) {
  if (!measured_from_ || now < measured_from_->simulated) measured_from_ = Moment{wall, now};
  const double over_s = seconds(wall - measured_from_->wall);
  if (over_s >= kMeasureOver_s) {
    factor_ = (now - measured_from_->simulated).s() / over_s;
    measured_from_ = Moment{wall, now};
  }
  return factor_;
}

}  // namespace vinerow::live

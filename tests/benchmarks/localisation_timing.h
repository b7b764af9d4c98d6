#pragma once
/// Times of the single steps of a flight that is given to a law several times over: of each step
/// the median of its replays, so that what else runs on the machine counts little.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

namespace vinerow::bench {

constexpr int kReplays = 9;

template <class Work>
double time_us(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  const auto end = std::chrono::steady_clock::now();
  return std::chrono::duration<double, std::micro>(end - begin).count();
}

/// @pre not empty
inline double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Times of the same steps in the same order, replay after replay.
class Steps {
 public:
  void begin_replay() { next_ = 0; }
  void add(double us) {
    if (next_ == times_us_.size()) times_us_.emplace_back();
    times_us_[next_++].push_back(us);
  }
  std::vector<double> medians_us() const {
    std::vector<double> medians;
    for (const std::vector<double>& times : times_us_) medians.push_back(quantile(times, 0.5));
    return medians;
  }

 private:
  std::vector<std::vector<double>> times_us_;
  std::size_t next_ = 0;
};

/// Counters `name`, the median over the steps, and `name_p99`; none if there was no such step.
inline void report(benchmark::State& state, const std::string& name,
                   const std::vector<double>& steps_us) {
  if (steps_us.empty()) return;
  state.counters[name] = quantile(steps_us, 0.5);
  state.counters[name + "_p99"] = quantile(steps_us, 0.99);
}

}  // namespace vinerow::bench

#pragma once
/// Delay line between a sensor and its signal: first in, first out, fixed capacity, no heap after
/// set-up.

#include <vector>

#include "engine/api/signal.h"
#include "engine/core/check.h"

namespace vinerow::sensors {

template <class T>
class DelayLine {
 public:
  /// @param delay   between measurement and delivery
  /// @param period  of the sensor
  DelayLine(Duration delay, Duration period) : delay_(delay) {
    if (delay.ns > 0) ring_.resize(static_cast<std::size_t>(delay.ns / period.ns) + 2);
  }

  /// For readings that own memory (names, lists): copies the reading into every slot, so that
  /// push() does not allocate.
  void prefill(const T& reading) {
    for (Entry& entry : ring_) entry.reading = reading;
  }

  Duration delay() const { return delay_; }

  /// Writes at once if there is no delay; otherwise keeps the reading until deliver().
  void push(Time measured, const T& reading, SignalWriter<T>& out) {
    if (delay_.ns == 0) {
      out.write(measured, reading);
      return;
    }
    Entry& entry = next();
    entry.measured = measured;
    entry.reading = reading;
    entry.is_lost = false;
  }

  /// Enters a lost reading, which keeps its slot so that the timing of the others is unchanged.
  void push_lost() {
    if (delay_.ns > 0) next().is_lost = true;
  }

  /// Writes the oldest reading if it was not lost; its stamp is the time of the measurement.
  void deliver(SignalWriter<T>& out) {
    if (count_ == 0) return;
    const Entry& oldest = ring_[first_];
    if (!oldest.is_lost) out.write(oldest.measured, oldest.reading);
    first_ = (first_ + 1) % ring_.size();
    --count_;
  }

 private:
  struct Entry {
    Time measured;
    T reading;
    bool is_lost = false;
  };
  Entry& next() {
    VINEROW_DEMAND(count_ < ring_.size());
    return ring_[(first_ + count_++) % ring_.size()];
  }
  Duration delay_;
  std::vector<Entry> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace vinerow::sensors

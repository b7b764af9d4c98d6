#pragma once
/// Events of an estimator, limited in rate.

#include <string>
#include <vector>

#include "engine/api/messages/event.h"
#include "engine/api/signal.h"

namespace vinerow::controllers {

/// Rate limit for an event that may occur often: due the first time and then, if the count has
/// grown, at most every 10 s.
class CountedEvent {
 public:
  static constexpr Duration kQuiet{10'000'000'000};

  /// @param count  occurrences so far @returns whether to report it now
  bool is_due(Time now, int count) {
    if (count == reported_ || (reported_ > 0 && now - last_ < kQuiet)) return false;
    reported_ = count;
    last_ = now;
    return true;
  }

 private:
  int reported_ = 0;
  Time last_;
};

/// Writes the signal "estimator_event".
class EstimatorEvents {
 public:
  void connect(Ports& ports) { out_ = ports.write<Event>("estimator_event"); }
  void report_event(Event::Level level, std::string text);
  /// Writes the next waiting event. A signal holds one event, so events of the same tick are
  /// written in successive ticks. Allocates only when events are queued.
  void write(Time now);

 private:
  std::vector<Event> waiting_;
  SignalWriter<Event> out_;
};

}  // namespace vinerow::controllers

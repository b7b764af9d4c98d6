#pragma once
/// What an estimator tells people as events, without repeating itself.

#include <string>
#include <vector>

#include "engine/api/messages/event.h"
#include "engine/api/signal.h"

namespace vinerow::controllers {

/// Something that is counted and may happen often: told the first time and then, if it went on, at
/// most every 10 s.
class CountedNews {
 public:
  static constexpr Duration kQuiet{10'000'000'000};

  /// @param count  how often it happened so far  @returns whether to tell of it now
  bool is_due(Time now, int count) {
    if (count == told_ || (told_ > 0 && now - last_ < kQuiet)) return false;
    told_ = count;
    last_ = now;
    return true;
  }

 private:
  int told_ = 0;
  Time last_;
};

/// Writes the signal "estimator_event".
class EstimatorNews {
 public:
  void connect(Ports& ports) { out_ = ports.write<Event>("estimator_event"); }
  void tell(Event::Level level, std::string text);
  /// A signal holds one event: what was told together is written one tick after another. Allocates
  /// only where something is told.
  void write(Time now);

 private:
  std::vector<Event> waiting_;
  SignalWriter<Event> out_;
};

}  // namespace vinerow::controllers

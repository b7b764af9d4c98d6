#include "controllers/estimation/parts/estimator_events.h"

#include <utility>

namespace vinerow::controllers {

void EstimatorEvents::report_event(Event::Level level, std::string text) {
  Event event;  // its source is the writer of the signal
  event.level = level;
  event.text = std::move(text);
  waiting_.push_back(std::move(event));
}

void EstimatorEvents::write(Time now) {
  if (waiting_.empty()) return;
  out_.write(now, waiting_.front());
  waiting_.erase(waiting_.begin());
}

}  // namespace vinerow::controllers

#include "controllers/estimation/parts/estimator_news.h"

#include <utility>

namespace vinerow::controllers {

void EstimatorNews::tell(Event::Level level, std::string text) {
  Event event;  // of whoever writes the signal
  event.level = level;
  event.text = std::move(text);
  waiting_.push_back(std::move(event));
}

void EstimatorNews::write(Time now) {
  if (waiting_.empty()) return;
  out_.write(now, waiting_.front());
  waiting_.erase(waiting_.begin());
}

}  // namespace vinerow::controllers

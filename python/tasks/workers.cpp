#include "python/tasks/workers.h"

#include <algorithm>

namespace vinerow::tasks {

Workers::Workers(int threads) {
  for (int i = 1; i < threads; ++i) threads_.emplace_back([this] { serve(); });
}

Workers::~Workers() {
  ending_ = true;
  ++batch_;
  batch_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Workers::run(int count, const std::function<void(int)>& job) {
  job_ = &job;
  count_ = count;
  failures_.assign(static_cast<std::size_t>(count), nullptr);
  next_ = 0;
  busy_ = static_cast<int>(threads_.size());
  ++batch_;
  batch_.notify_all();
  take_jobs();
  for (int busy = busy_; busy > 0; busy = busy_) busy_.wait(busy);
  const auto failed = std::find_if(failures_.begin(), failures_.end(),
                                   [](const std::exception_ptr& failure) { return !!failure; });
  if (failed != failures_.end()) std::rethrow_exception(*failed);
}

void Workers::serve() {
  std::uint64_t seen = 0;
  while (true) {
    batch_.wait(seen);
    seen = batch_;
    if (ending_) return;
    take_jobs();
    if (--busy_ == 0) busy_.notify_all();
  }
}

void Workers::take_jobs() {
  for (int i = next_++; i < count_; i = next_++) {
    try {
      (*job_)(i);
    } catch (...) {
      failures_[static_cast<std::size_t>(i)] = std::current_exception();
    }
  }
}

}  // namespace vinerow::tasks

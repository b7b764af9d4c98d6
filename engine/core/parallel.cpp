#include "engine/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/core/check.h"

namespace vinerow {

void for_chunks(std::size_t count, std::size_t chunk,
                const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
  VINEROW_DEMAND(chunk >= 1);
  const std::size_t chunks = count / chunk + (count % chunk != 0 ? 1 : 0);
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr error;
  std::size_t failed = chunks;
  const auto work = [&] {
    for (std::size_t index; (index = next++) < chunks;) {
      try {
        body(index, index * chunk, std::min(count, (index + 1) * chunk));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (index < failed) {
          failed = index;
          error = std::current_exception();
        }
        next = chunks;
      }
    }
  };
  const std::size_t threads =
      std::min<std::size_t>(chunks, std::max(1u, std::thread::hardware_concurrency()));
  std::vector<std::jthread> others;
  for (std::size_t k = 1; k < threads; ++k) others.emplace_back(work);
  work();
  others.clear();
  if (error) std::rethrow_exception(error);
}

}  // namespace vinerow

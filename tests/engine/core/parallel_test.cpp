#include "engine/core/parallel.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace vinerow::parallel_test {
namespace {

TEST(ForChunks, CoversEveryItemOnceInChunksThatDependOnNothingElse) {
  for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 1000u}) {
    for (const std::size_t chunk : {1u, 8u, 2000u}) {
      std::vector<int> visits(count, 0);
      std::vector<std::pair<std::size_t, std::size_t>> chunks((count + chunk - 1) / chunk);
      for_chunks(count, chunk, [&](std::size_t index, std::size_t begin, std::size_t end) {
        chunks.at(index) = {begin, end};
        for (std::size_t k = begin; k < end; ++k) ++visits[k];
      });
      EXPECT_EQ(visits, std::vector<int>(count, 1)) << count << " by " << chunk;
      for (std::size_t k = 0; k < chunks.size(); ++k) {
        EXPECT_EQ(chunks[k].first, k * chunk);
        EXPECT_EQ(chunks[k].second, std::min(count, (k + 1) * chunk));
      }
    }
  }
}

TEST(ForChunks, ThrowsWhatTheLowestFailedChunkHasThrown) {
  for (int round = 0; round < 50; ++round) {
    try {
      for_chunks(64, 1, [](std::size_t index, std::size_t, std::size_t) {
        if (index >= 5) throw std::runtime_error(std::to_string(index));
      });
      FAIL() << "nothing thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "5");
    }
  }
}

TEST(ForChunks, MayBeUsedInsideAChunk) {
  std::atomic<int> sum = 0;
  for_chunks(4, 1, [&](std::size_t, std::size_t, std::size_t) {
    for_chunks(10, 3, [&](std::size_t, std::size_t begin, std::size_t end) {
      sum += static_cast<int>(end - begin);
    });
  });
  EXPECT_EQ(sum, 40);
}

/// Threads that a loop of many chunks takes.
std::size_t count_threads() {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  for_chunks(200, 1, [&](std::size_t, std::size_t, std::size_t) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  return threads.size();
}

TEST(ForChunks, TakesTheCoresThatItsThreadMayUse) {
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  EXPECT_EQ(count_threads(), cores);
  {
    const ShareOfCores share(cores);
    EXPECT_EQ(count_threads(), 1u);
  }
  EXPECT_EQ(count_threads(), cores);
}

TEST(ForChunks, ThreadsOfALoopHaveDifferentNumbers) {
  const std::size_t cores = most_threads();
  EXPECT_EQ(cores, std::max(1u, std::thread::hardware_concurrency()));
  for (int round = 0; round < 20; ++round) {
    std::vector<std::set<std::thread::id>> of_number(cores);
    std::mutex mutex;
    for_chunks(100, 1, [&](std::size_t, std::size_t, std::size_t) {
      std::this_thread::sleep_for(std::chrono::microseconds(20));
      const std::lock_guard lock(mutex);
      of_number.at(thread_in_loop()).insert(std::this_thread::get_id());
    });
    for (const auto& threads : of_number) EXPECT_LE(threads.size(), 1u);
  }
}

TEST(ForChunks, TwoLoopsAtOnceAreBothDone) {
  std::atomic<int> sum = 0;
  const auto loop = [&] {
    for (int round = 0; round < 50; ++round) {
      for_chunks(10, 1, [&](std::size_t, std::size_t, std::size_t) { ++sum; });
    }
  };
  std::thread other(loop);
  loop();
  other.join();
  EXPECT_EQ(sum, 1000);
}

#if !defined(__SANITIZE_THREAD__)  // which refuses new threads after a fork
TEST(ForChunks, WorksInAForkedProcess) {
  const auto count = [] {
    std::atomic<int> sum = 0;
    for_chunks(10, 1, [&](std::size_t, std::size_t, std::size_t) { ++sum; });
    return sum.load();
  };
  ASSERT_EQ(count(), 10);
  const pid_t child = fork();
  if (child == 0) _exit(count());
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 10);
}
#endif

TEST(ForChunks, InsideAChunkTakesNoFurtherThreads) {
  const std::size_t cores = most_threads();
  std::vector<std::size_t> inner(2 * cores), most(2 * cores);
  for_chunks(inner.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
    inner[i] = count_threads();
    most[i] = most_threads();
  });
  EXPECT_EQ(inner, std::vector<std::size_t>(inner.size(), 1));
  EXPECT_EQ(most, inner);
  // A loop of a single chunk leaves all of them.
  for_chunks(1, 1, [&](std::size_t, std::size_t, std::size_t) { inner[0] = count_threads(); });
  EXPECT_EQ(inner[0], cores);
}

}  // namespace
}  // namespace vinerow::parallel_test

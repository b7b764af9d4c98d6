#include "engine/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>
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

}  // namespace
}  // namespace vinerow::parallel_test

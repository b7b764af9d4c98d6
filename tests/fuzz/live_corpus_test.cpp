#include <gtest/gtest.h>

#include "tests/fuzz/changed_bytes.h"
#include "tests/fuzz/live_seeds.h"
#include "tests/fuzz/read_live_frames.h"

namespace vinerow::fuzz::live_corpus_test {
namespace {

// read_live_frames() checks the answers to any input; the tests only choose inputs.

LiveTally read(const std::string& bytes) {
  return read_live_frames({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

TEST(LiveCorpus, SeedsHaveTheAnswersThatTheyWereMadeFor) {
  int messages = 0;
  for (const LiveSeed& seed : live_seeds()) {
    SCOPED_TRACE(seed.name);
    EXPECT_LE(seed.bytes.size(), 4096u);
    const LiveTally tally = read(seed.bytes);
    EXPECT_EQ(tally.refusals, seed.refusals) << tally.refusal;
    EXPECT_EQ(tally.responses, seed.responses);
    EXPECT_GT(tally.frames, 0);
    messages += tally.messages;
  }
  EXPECT_GE(messages, 10);
}

TEST(LiveCorpus, EveryLengthOfSomeSeeds) {
  for (const LiveSeed& seed : live_seeds()) {
    if (seed.name != "subscribe" && seed.name != "drive_cdr" && seed.name != "lockstep") continue;
    for (std::size_t length = 0; length < seed.bytes.size(); ++length) {
      read(seed.bytes.substr(0, length));
    }
  }
}

TEST(LiveCorpus, SeveralChangesAtOnce) {
  constexpr int kRounds = 100;
  RandomStream random(3, "", "changes");
  std::vector<std::string> inputs;
  for (const LiveSeed& seed : live_seeds()) inputs.push_back(seed.bytes);
  for (const std::string& input : inputs) {
    for (int round = 0; round < kRounds; ++round) read(changed(input, inputs, random));
  }
}

}  // namespace
}  // namespace vinerow::fuzz::live_corpus_test

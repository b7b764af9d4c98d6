#include <gtest/gtest.h>

#include "tests/fuzz/changed_bytes.h"
#include "tests/fuzz/read_autopilot_bytes.h"

namespace vinerow::fuzz::autopilot_corpus_test {
namespace {

// read_autopilot_bytes() checks the answers to any input; the tests only choose inputs.

AutopilotTally read(const std::string& bytes) {
  return read_autopilot_bytes({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

TEST(AutopilotCorpus, SeedsAreReadAsTheyWereMade) {
  for (const AutopilotSeed& seed : autopilot_seeds()) {
    SCOPED_TRACE(seed.name);
    EXPECT_LE(seed.bytes.size(), 2048u);
    const AutopilotTally tally = read(seed.bytes);
    EXPECT_EQ(tally.read, seed.read);
    EXPECT_EQ(tally.refusal, "");
    if (seed.name == "flight") {
      EXPECT_GT(tally.sent, 5);
    }
  }
}

TEST(AutopilotCorpus, EveryLengthOfTheSeeds) {
  for (const AutopilotSeed& seed : autopilot_seeds()) {
    for (std::size_t length = 0; length < seed.bytes.size(); ++length) {
      read(seed.bytes.substr(0, length));
    }
  }
}

TEST(AutopilotCorpus, SeveralChangesAtOnce) {
  constexpr int kRounds = 2000;
  RandomStream random(5, "", "changes");
  std::vector<std::string> inputs;
  for (const AutopilotSeed& seed : autopilot_seeds()) inputs.push_back(seed.bytes);
  for (const std::string& input : inputs) {
    for (int round = 0; round < kRounds; ++round) read(changed(input, inputs, random));
  }
}

}  // namespace
}  // namespace vinerow::fuzz::autopilot_corpus_test

#include <gtest/gtest.h>

#include "tests/fuzz/changed_bytes.h"
#include "tests/fuzz/cloud_seeds.h"
#include "tests/support/folder_test.h"

namespace vinerow::fuzz::fuzz_corpus_test {
namespace {

/// What read_cloud_bytes() demands, it demands of every input; the tests only choose inputs.
class FuzzCorpus : public test::FolderTest {
 protected:
  FuzzCorpus() : FolderTest("fuzz") {}

  static std::string read(CloudKind kind, const std::string& bytes) {
    return read_cloud_bytes(kind,
                            {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  }
};

TEST_F(FuzzCorpus, SeedsAreReadOrRefusedAsTheyWereMade) {
  std::size_t refused = 0;
  for (const CloudSeed& seed : cloud_seeds(folder_)) {
    SCOPED_TRACE(seed.name);
    EXPECT_LE(seed.bytes.size(), 2000u);
    const std::string sentence = read(seed.kind, seed.bytes);
    const bool is_broken = seed.name.starts_with("count_huge") || seed.name == "laszip.las" ||
                           seed.name == "scale_nan.las" || seed.name == "compressed.pcd";
    EXPECT_EQ(!sentence.empty(), is_broken) << sentence;
    refused += sentence.empty() ? 0 : 1;
    // The first bytes determine the kind, whatever the extension.
    if (seed.kind != CloudKind::kXyz) {
      EXPECT_EQ(read(CloudKind::kAny, seed.bytes).empty(), sentence.empty());
    }
  }
  EXPECT_EQ(refused, 6u);
}

TEST_F(FuzzCorpus, EveryLengthOfEverySeed) {
  for (const CloudSeed& seed : cloud_seeds(folder_)) {
    for (std::size_t length = 0; length < seed.bytes.size(); ++length) {
      const std::string sentence = read(seed.kind, seed.bytes.substr(0, length));
      EXPECT_EQ(sentence.find("is empty (0 bytes)") != std::string::npos, length == 0);
    }
  }
}

TEST_F(FuzzCorpus, EveryByteOfEverySeedFlipped) {
  RandomStream random(1, "", "flip");
  for (const CloudSeed& seed : cloud_seeds(folder_)) {
    for (std::size_t at = 0; at < seed.bytes.size(); ++at) {
      for (const int value : {0x00, 0xff, 0x80, static_cast<int>(below(random, 256))}) {
        std::string bytes = seed.bytes;
        bytes[at] = static_cast<char>(value);
        read(seed.kind, bytes);
      }
    }
  }
}

TEST_F(FuzzCorpus, SeveralChangesAtOnce) {
  constexpr int kRounds = 300;
  RandomStream random(2, "", "changes");
  const std::vector<CloudSeed> seeds = cloud_seeds(folder_);
  std::vector<std::string> inputs;
  for (const CloudSeed& seed : seeds) inputs.push_back(seed.bytes);
  for (const CloudSeed& seed : seeds) {
    for (int round = 0; round < kRounds; ++round) {
      read(round % 4 == 0 ? CloudKind::kAny : seed.kind, changed(seed.bytes, inputs, random));
    }
  }
}

/// Longer than any buffer: lines, words and headers that never end.
TEST_F(FuzzCorpus, WhatNeverEndsIsRefused) {
  const std::string endless(1 << 19, '1');
  for (const char* begin : {"", "ply\n", "ply\nformat ascii 1.0\nelement vertex ", "VERSION ",
                            "VERSION 0.7\nFIELDS ", "# .PCD\n# ", "LASF"}) {
    for (const CloudKind kind :
         {CloudKind::kAny, CloudKind::kLas, CloudKind::kPly, CloudKind::kPcd, CloudKind::kXyz}) {
      EXPECT_NE(read(kind, begin + endless), "") << begin;
    }
  }
}

}  // namespace
}  // namespace vinerow::fuzz::fuzz_corpus_test

#include "engine/core/hash.h"

#include <gtest/gtest.h>

namespace vinerow::hash_test {
namespace {

// Published test value: XXH3 128 bits of the empty input, seed 0.
TEST(Hash, EmptyInputHasThePublishedDigest) {
  EXPECT_EQ(Hasher().hex(), "99aa06d3014798d86001c324468d497f");
}

TEST(Hash, TextsAreDelimited) {
  Hasher a, b;
  a.add("ab"), a.add("c");
  b.add("a"), b.add("bc");
  EXPECT_NE(a.hex(), b.hex());
}

TEST(Hash, ReadingTheDigestDoesNotDisturbIt) {
  Hasher a, b;
  a.add(1.0), b.add(1.0);
  static_cast<void>(a.hex());
  a.add(2.0), b.add(2.0);
  EXPECT_EQ(a.hex(), b.hex());
}

}  // namespace
}  // namespace vinerow::hash_test

/// Token, origin, path and protocol of a request.

#include <gtest/gtest.h>

#include "engine/live/request_check.h"

namespace vinerow::live::request_check_test {
namespace {

TEST(RequestCheck, SplitsATarget) {
  EXPECT_EQ(split_target("/live.js").path, "/live.js");
  const Target both = split_target("/a%20b?x=1&token=s%26cret&y");
  EXPECT_EQ(both.path, "/a b");
  EXPECT_EQ(both.token, "s&cret");
  for (const char* odd : {"", "?", "/%", "/%4", "/%zz", "/?token", "/?&&="}) {
    EXPECT_EQ(split_target(odd).token, "") << odd;
  }
  EXPECT_EQ(split_target("/?token=a+b%2Bc").token, "a b+c");
  EXPECT_EQ(split_target("/%zz").path, "/%zz");
}

TEST(RequestCheck, EncodesAToken) {
  EXPECT_EQ(percent_encoded("aZ09-._~"), "aZ09-._~");
  EXPECT_EQ(percent_encoded("a b&c/\xff"), "a%20b%26c%2F%FF");
  EXPECT_EQ(split_target("/?token=" + percent_encoded("a b&c=%")).token, "a b&c=%");
}

TEST(RequestCheck, ComparesSecrets) {
  EXPECT_TRUE(is_same_secret("abc", "abc"));
  EXPECT_TRUE(is_same_secret("", ""));
  for (const char* wrong : {"", "ab", "abd", "abcabc", "abc "}) {
    EXPECT_FALSE(is_same_secret(wrong, "abc")) << wrong;
    EXPECT_FALSE(is_same_secret("abc", wrong)) << wrong;
  }
}

TEST(RequestCheck, TrustsProgramsOwnPagesAndFoxglove) {
  for (const char* good : {"", "http://localhost:8765", "http://127.0.0.1", "https://[::1]:1",
                           "https://app.foxglove.dev", "file://"}) {
    EXPECT_TRUE(is_trusted_origin(good)) << good;
  }
  for (const char* bad : {"https://example.com", "http://localhost.example.com", "null",
                          "https://app.foxglove.dev.example.com", "http://127.0.0.1.example.com"}) {
    EXPECT_FALSE(is_trusted_origin(bad)) << bad;
  }
}

TEST(RequestCheck, ChoosesAProtocol) {
  EXPECT_EQ(choose_protocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(choose_protocol("foxglove.websocket.v1, foxglove.sdk.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(choose_protocol("chat ,foxglove.websocket.v1"), "foxglove.websocket.v1");
  for (const char* other : {"", "chat", "foxglove", "foxglove.websocket.v12", ","}) {
    EXPECT_EQ(choose_protocol(other), "") << other;
  }
}

}  // namespace
}  // namespace vinerow::live::request_check_test

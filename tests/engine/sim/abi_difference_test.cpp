#include "engine/sim/abi_difference.h"

#include <gtest/gtest.h>

#include <string>

#include "engine/api/abi.h"

namespace vinerow::abi_difference_test {
namespace {

/// This program's tag with one field changed.
std::string with(const std::string& name, const std::string& value) {
  std::string tag = abi_tag();
  const std::size_t at = tag.find("; " + name + " ") + 2 + name.size() + 1;
  const std::size_t end = tag.find("; ", at);
  return tag.replace(at, end - at, value);
}

TEST(AbiDifference, ThereIsNoneToOneself) {
  EXPECT_EQ(abi_difference(abi_tag(), abi_tag()), "");
}

TEST(AbiDifference, SaysInWordsWhatDiffers) {
  const std::string alignment = std::to_string(EIGEN_MAX_STATIC_ALIGN_BYTES);
  EXPECT_EQ(abi_difference(with("alignment", "64"), abi_tag()),
            "was compiled with 64-byte alignment (-mavx or -march=native?), this vinerow uses " +
                alignment);
  const auto contains = [](const std::string& name, const std::string& value,
                           const std::string& text) {
    EXPECT_NE(abi_difference(with(name, value), abi_tag()).find(text), std::string::npos)
        << abi_difference(with(name, value), abi_tag());
  };
  contains("ndebug", "2", "NDEBUG");
  contains("cxx11_abi", "7", "_GLIBCXX_USE_CXX11_ABI 7");
  contains("gxx_abi", "1002", "C++ ABI 1002 (another compiler?)");
  contains("headers", "0123456789abcdef", "another version of vinerow's headers (hash 0123456789abcdef");
  contains("CameraShot", "224/32",
           "stores CameraShot in 224 bytes aligned to 32, this vinerow in ");
}

TEST(AbiDifference, NamesTheCauseBeforeItsEffects) {
  std::string tag = with("Odometry", "192/32");
  const std::string from = "alignment " + std::to_string(EIGEN_MAX_STATIC_ALIGN_BYTES);
  tag.replace(tag.find(from), from.size(), "alignment 64");
  EXPECT_NE(abi_difference(tag, abi_tag()).find("64-byte alignment"), std::string::npos);
}

TEST(AbiDifference, TagsThatAreNoneAreQuoted) {
  const std::string own = "vinerow-abi " + std::to_string(VINEROW_ABI_VERSION);
  for (const std::string tag : {"vinerow-abi-8-cxxabi-1017", "", "x", "; ; "}) {
    EXPECT_EQ(abi_difference(tag, abi_tag()),
              "was built for '" + tag + "', this vinerow is '" + own + "'");
  }
  EXPECT_EQ(abi_difference(own, abi_tag()), "does not state its 'headers'");
}

}  // namespace
}  // namespace vinerow::abi_difference_test

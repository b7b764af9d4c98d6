#include "engine/core/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

namespace vinerow::files_test {
namespace {

class ReadBytes : public ::testing::Test {
 protected:
  ReadBytes()
      : folder_(std::filesystem::temp_directory_path() /
                ("read_bytes_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~ReadBytes() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(ReadBytes, OfAnySize) {
  for (const std::size_t size : {0u, 1u, 4095u, 4096u, 4097u, 1'000'000u}) {
    std::string content(size, '\0');
    for (std::size_t i = 0; i < size; ++i) content[i] = static_cast<char>(i * 7 + i / 256);
    std::ofstream(folder_ / "file", std::ios::binary) << content;
    EXPECT_EQ(read_bytes(folder_ / "file"), content) << size;
  }
}

TEST_F(ReadBytes, OfAPipeWhoseSizeIsUnknown) {
  const std::filesystem::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string content(50'000, 'x');
  std::jthread writer([&] { std::ofstream(pipe, std::ios::binary) << content; });
  EXPECT_EQ(read_bytes(pipe), content);
}

TEST_F(ReadBytes, OfWhatIsNoFile) {
  EXPECT_FALSE(read_bytes(folder_ / "absent"));
  EXPECT_FALSE(read_bytes(folder_));
}

}  // namespace
}  // namespace vinerow::files_test

#include "engine/core/whole_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "engine/core/error.h"
#include "tests/support/folder_test.h"

namespace vinerow::whole_file_test {
namespace {

class WholeFileTest : public test::FolderTest {
 protected:
  WholeFileTest() : FolderTest("whole_file") {}
  std::filesystem::path file() const { return folder_ / "a.txt"; }
  std::string text() const {
    std::ifstream in(file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Files of the folder, whatever they are called.
  int files() const {
    int count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++count;
    return count;
  }
};

template <class Error, class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(WholeFileTest, KeepsItsNameFromOthersUntilItIsWhole) {
  write_whole_file(file(), "before");
  {
    WholeFile out(file());
    out.write("half");
    EXPECT_EQ(text(), "before");
  }
  EXPECT_EQ(text(), "before") << "not finished";
  EXPECT_EQ(files(), 1) << "and nothing is left of it";
  WholeFile out(file());
  out.write("af");
  out.write("ter");
  out.finish();
  EXPECT_EQ(text(), "after");
  EXPECT_EQ(files(), 1);
}

TEST_F(WholeFileTest, AWrongPlaceIsBadInput) {
  EXPECT_EQ(error_of<ConfigError>([] { write_whole_file("/nowhere/x.ply", "", "mesh file"); }),
            "mesh file '/nowhere/x.ply' cannot be written: No such file or directory");
  EXPECT_EQ(error_of<ConfigError>([&] { write_whole_file(folder_, ""); }),
            "'" + folder_.string() + "' cannot be written: Is a directory");
}

TEST_F(WholeFileTest, AFullDiskIsNamed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EXPECT_EQ(error_of<WriteError>([] { write_whole_file("/dev/full", "text"); }),
            "'/dev/full' cannot be written: the disk is full");
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));
}

TEST_F(WholeFileTest, WhatDoesNotFitLeavesTheFileOfBefore) {
  write_whole_file(file(), "before");
  // The limit holds for a process: a child writes.
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error =
        error_of<WriteError>([&] { write_whole_file(file(), std::string(100'000, 'x')); });
    _exit(error == "'" + file().string() +
                       "' cannot be written: the file would exceed the size limit (ulimit -f)"
              ? 0
              : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(text(), "before");
  EXPECT_EQ(files(), 1);
}

TEST_F(WholeFileTest, ALinkKeepsPointingWhereItPoints) {
  write_whole_file(file(), "before");
  std::filesystem::create_symlink(file(), folder_ / "link");
  write_whole_file(folder_ / "link", "after");
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
  EXPECT_EQ(text(), "after");
}

}  // namespace
}  // namespace vinerow::whole_file_test

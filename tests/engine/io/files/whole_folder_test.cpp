#include "engine/io/files/whole_folder.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "tests/support/folder_test.h"

namespace vinerow::io::whole_folder_test {
namespace {

namespace fs = std::filesystem;

class WholeFolderTest : public test::FolderTest {
 protected:
  WholeFolderTest() : FolderTest("whole_folder") {}
};

TEST_F(WholeFolderTest, AppearsWhenItIsFinished) {
  const fs::path wanted = folder_ / "a" / "b";
  {
    WholeFolder folder(wanted);
    fs::create_directory(folder.path() / "inner");
    write_whole_file(folder.path() / "inner" / "x", "1");
    EXPECT_FALSE(fs::exists(wanted));
    folder.finish();
    EXPECT_TRUE(fs::exists(wanted / "inner" / "x"));
  }
  EXPECT_TRUE(fs::exists(wanted / "inner" / "x"));
  EXPECT_FALSE(fs::exists(wanted.string() + ".unfinished"));
}

TEST_F(WholeFolderTest, AnUnfinishedOneLeavesNothing) {
  {
    const WholeFolder folder(folder_ / "a");
    write_whole_file(folder.path() / "x", "1");
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(WholeFolderTest, ReplacesAnEmptyFolderAndWhatAKilledProgramLeft) {
  fs::create_directory(folder_ / "a");
  fs::create_directory(folder_ / "a.unfinished");
  write_whole_file(folder_ / "a.unfinished" / "old", "1");
  WholeFolder folder(folder_ / "a" / "");  // with a slash at its end
  write_whole_file(folder.path() / "x", "1");
  folder.finish();
  EXPECT_TRUE(fs::exists(folder_ / "a" / "x"));
  EXPECT_FALSE(fs::exists(folder_ / "a" / "old"));
}

TEST_F(WholeFolderTest, LeavesAFolderWithFilesAlone) {
  fs::create_directory(folder_ / "a");
  write_whole_file(folder_ / "a" / "mine", "1");
  try {
    const WholeFolder folder(folder_ / "a");
    FAIL() << "it was not refused";
  } catch (const ConfigError& error) {
    EXPECT_EQ(without_folder(error.what()),
              "'a' exists and is not empty: remove it, or choose another folder with --out");
  }
  EXPECT_TRUE(fs::exists(folder_ / "a" / "mine"));
}

}  // namespace
}  // namespace vinerow::io::whole_folder_test

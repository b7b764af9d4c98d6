#include "engine/api/file_shelf.h"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "tests/support/folder_test.h"

namespace vinerow::file_shelf_test {
namespace {

class FileShelfTest : public test::FolderTest {
 protected:
  FileShelfTest() : FolderTest("file_shelf") {}
  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
};

TEST_F(FileShelfTest, MakesAValueOnce) {
  FileShelf shelf;
  int made = 0;
  const auto make = [&] { return ++made; };
  EXPECT_EQ(*keep<int>(&shelf, "a", make), 1);
  EXPECT_EQ(*keep<int>(&shelf, "a", make), 1);
  EXPECT_EQ(*keep<int>(&shelf, "b", make), 2);
  EXPECT_EQ(*keep<double>(&shelf, "a", [] { return 0.5; }), 0.5) << "another type, another value";
  EXPECT_EQ(*keep<int>(nullptr, "a", make), 3) << "without a shelf always anew";
  EXPECT_THROW(keep<int>(&shelf, "c", []() -> int { throw 1; }), int);
  EXPECT_EQ(*keep<int>(&shelf, "c", make), 4) << "what failed is not kept";
}

TEST_F(FileShelfTest, AMarkChangesWithTheFile) {
  const auto file = write("points.csv", "1,2");
  const std::string before = file_mark(file);
  EXPECT_EQ(file_mark(file), before);
  write("points.csv", "1,2,3");
  EXPECT_NE(file_mark(file), before);
  const std::string same_size = file_mark(file);
  std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) +
                                             std::chrono::seconds(1));
  EXPECT_NE(file_mark(file), same_size);
  std::filesystem::remove(file);
  EXPECT_NE(file_mark(file), before);
}

TEST_F(FileShelfTest, AFoldersMarkChangesWithWhatIsInIt) {
  std::filesystem::create_directories(folder_ / "meshes");
  const auto file = write("meshes/row_00.ply", "ply");
  const std::string before = file_mark(folder_);
  EXPECT_EQ(file_mark(folder_), before);
  write("meshes/row_01.ply", "ply");
  EXPECT_NE(file_mark(folder_), before);
  std::filesystem::remove(folder_ / "meshes/row_01.ply");
  EXPECT_EQ(file_mark(folder_), before);
}

TEST_F(FileShelfTest, ThreadsGetTheSameValue) {
  FileShelf shelf;
  std::vector<std::shared_ptr<const std::string>> got(8);
  std::vector<std::thread> threads;
  for (auto& value : got) {
    threads.emplace_back([&] { value = keep<std::string>(&shelf, "k", [] { return "v"; }); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& value : got) EXPECT_EQ(value, got.front());
}

}  // namespace
}  // namespace vinerow::file_shelf_test

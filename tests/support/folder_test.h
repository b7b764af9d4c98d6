#pragma once
/// A fixture whose tests have a folder of their own, empty at the start and removed at the end.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace vinerow::test {

class FolderTest : public ::testing::Test {
 protected:
  /// @param suite  stands in the folder's name before the test's
  explicit FolderTest(const std::string& suite)
      : folder_(std::filesystem::temp_directory_path() /
                ("vinerow_" + suite + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~FolderTest() override { std::filesystem::remove_all(folder_); }

  /// A message without the folder in the names of its files.
  std::string without_folder(std::string text) const {
    const std::string folder = folder_.string() + "/";
    for (std::size_t at; (at = text.find(folder)) != std::string::npos;) {
      text.erase(at, folder.size());
    }
    return text;
  }

  const std::filesystem::path folder_;
};

}  // namespace vinerow::test

#pragma once
/// Creation of output folders.

#include <filesystem>

namespace vinerow::io {

/// Creates a folder and its missing parents.
/// @throws ConfigError "folder '/proc/x' cannot be created: No such file or directory"
void make_folder(const std::filesystem::path& folder);

/// Folder for the results of a long computation. It is created before, so that a place where
/// nothing can be written is found at once, and removed again if it is new and still empty at the
/// end.
class ResultFolder {
 public:
  /// @throws ConfigError as make_folder()
  explicit ResultFolder(std::filesystem::path folder);
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

 private:
  std::filesystem::path folder_;
  bool is_new_;
};

/// The same as make_folder() for the parent folder of a file.
void make_folder_of(const std::filesystem::path& file);

}  // namespace vinerow::io

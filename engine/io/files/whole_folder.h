#pragma once
/// Folder of files that is complete or absent: written under another name, then renamed.

#include <filesystem>

namespace vinerow::io {

/// @throws ConfigError if a file has that name, or the folder is not empty
void check_new_folder(const std::filesystem::path& folder);

class WholeFolder {
 public:
  /// Starts "<folder>.unfinished"; one that an earlier, killed program left is removed.
  /// @throws ConfigError as check_new_folder(), or if the folder cannot be created
  explicit WholeFolder(std::filesystem::path folder);
  /// Removes it unless it was finished.
  ~WholeFolder();
  WholeFolder(const WholeFolder&) = delete;
  WholeFolder& operator=(const WholeFolder&) = delete;

  /// Where to write until finish().
  const std::filesystem::path& path() const { return unfinished_; }
  /// Gives the folder its name. @throws WriteError, ConfigError
  void finish();

 private:
  std::filesystem::path folder_, unfinished_;
};

}  // namespace vinerow::io

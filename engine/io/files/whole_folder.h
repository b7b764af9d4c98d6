#pragma once
/// Folder of files that is complete or absent: written under another name, then renamed.

#include <filesystem>

namespace vinerow::io {

class WholeFolder {
 public:
  /// Starts "<folder>.unfinished"; one that an earlier, killed program left is removed.
  /// @throws ConfigError if a file has that name, the folder is not empty, or cannot be created
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

#pragma once
/// Atomic files: written under a temporary name in the same folder, then renamed. If the process
/// ends before that, the old file remains.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace vinerow {

/// Results could not be stored: the disk is full, a quota is used up, a device failed. Exit status
/// 3. (A place where nothing can ever be written is bad input: ConfigError.)
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Text of an error number: "the disk is full", "Permission denied".
std::string words_of_write_failure(int error_number);

/// @param what  "'runs/x/summary.json'"  @param error_number  errno of the call that failed
/// @throws WriteError "'x' cannot be written: the disk is full" if storing failed; ConfigError if
/// the place is wrong (no folder, no permission)
[[noreturn]] void throw_cannot_write(const std::string& what, int error_number);

class WholeFile {
 public:
  /// @param kind  precedes the file's name in messages: "mesh file"
  /// @throws ConfigError, WriteError
  explicit WholeFile(const std::filesystem::path& file, std::string_view kind = {});
  /// Removes the temporary file of an unfinished write.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// For writers that use a stream; finish() reports its errors.
  std::FILE* stream() { return stream_.get(); }
  /// @throws WriteError
  void write(std::string_view bytes);
  /// Closes the file and renames it to its final name. @throws WriteError
  void finish();

 private:
  [[noreturn]] void fail(int error_number);

  std::string what_;
  std::filesystem::path target_;
  std::filesystem::path temporary_;  ///< the target itself if it is a device
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_{nullptr, &std::fclose};
};

/// Name of the temporary file.
std::filesystem::path temporary_name(const std::filesystem::path& file);

/// Writes a whole file. Arguments and errors as for WholeFile.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes,
                      std::string_view kind = {});

}  // namespace vinerow

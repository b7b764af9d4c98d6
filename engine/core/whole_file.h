#pragma once
/// Files that are there whole or not at all: written under a temporary name beside their own, then
/// renamed. A process that ends in between leaves what was there before.

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

/// Of an error number, for people: "the disk is full", "Permission denied".
std::string words_of_write_failure(int error_number);

/// @param what  "'runs/x/summary.json'"  @param error_number  errno of the call that failed
/// @throws WriteError "'x' cannot be written: the disk is full" where storing failed; ConfigError
///   where the place is wrong (no folder, no permission)
[[noreturn]] void throw_cannot_write(const std::string& what, int error_number);

class WholeFile {
 public:
  /// @param kind  stands before the file's name in messages: "mesh file"
  /// @throws ConfigError, WriteError
  explicit WholeFile(const std::filesystem::path& file, std::string_view kind = {});
  /// Removes what is not finished.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// For what writes to a stream; finish() finds its errors.
  std::FILE* stream() { return stream_.get(); }
  /// @throws WriteError
  void write(std::string_view bytes);
  /// Closes the file and gives it its name. @throws WriteError
  void finish();

 private:
  [[noreturn]] void fail(int error_number);

  std::string what_;
  std::filesystem::path target_;
  std::filesystem::path temporary_;  ///< the target itself where that is a device
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_{nullptr, &std::fclose};
};

/// The temporary name of a file until it is whole.
std::filesystem::path temporary_name(const std::filesystem::path& file);

/// Writes a file whole. Arguments and errors as WholeFile.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes,
                      std::string_view kind = {});

}  // namespace vinerow

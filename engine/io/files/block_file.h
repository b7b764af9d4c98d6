#pragma once
/// Sequential reader of files of any length, with a buffer of fixed size.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace vinerow::io {

/// Kind of file, for messages.
enum class FileKind { kPointCloud, kMesh };

/// Bytes or lines of a point cloud or mesh file, in order. Results of take() and line() are valid
/// until the next call. No allocation after construction.
class BlockFile {
 public:
  static constexpr std::size_t kBytes = 1 << 18;  ///< of the buffer, limit of take() and line()

  /// @throws ConfigError naming the file: missing, not a regular file, empty
  explicit BlockFile(const std::filesystem::path& file, FileKind kind = FileKind::kPointCloud);
  /// Reads from memory instead, as a file of that name. @throws ConfigError if there are no bytes
  BlockFile(const std::filesystem::path& name, std::string bytes);

  const std::filesystem::path& name() const { return file_; }

  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return read_ - (end_ - begin_); }
  std::uint64_t remaining() const { return size_ - std::min(size_, position()); }

  /// The next bytes, at most `count`, without consuming them.
  std::string peek(std::size_t count);
  /// The next `count` bytes, at most kBytes; nullptr if fewer are left.
  const std::uint8_t* take(std::size_t count);
  /// Reads the next line without its end (LF or CR LF); false at the end of the file.
  /// @throws ConfigError if the line is longer than kBytes
  bool line(std::string_view* text);
  std::uint64_t line_number() const { return line_number_; }  ///< of the last line(), from 1
  /// Moves to an offset from the start; beyond the end, take() returns nullptr.
  void seek(std::uint64_t position);
  /// Moves back to the start of a line that has `lines_before` lines before it.
  void seek_line(std::uint64_t position, std::uint64_t lines_before);

  /// "point cloud 'file' sentence" or "mesh file 'file' sentence" as ConfigError.
  [[noreturn]] void fail(const std::string& sentence) const;
  /// "... is not a LAS file: it begins with 'abc', must begin with LASF".
  [[noreturn]] void fail_kind(const std::string& begin, const char* kind, const char* magic) const;

 private:
  void make_buffer();
  bool fill(std::size_t wanted);

  std::filesystem::path file_;
  FileKind kind_ = FileKind::kPointCloud;
  std::unique_ptr<std::istream> stream_;
  std::vector<char> buffer_;
  std::uint64_t size_ = 0;
  std::uint64_t read_ = 0;  // bytes of the file up to end_
  std::size_t begin_ = 0, end_ = 0;
  std::uint64_t line_number_ = 0;
};

}  // namespace vinerow::io

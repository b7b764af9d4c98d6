#pragma once
/// A file of any length through a buffer of fixed size.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace vinerow::io {

/// What a file is called in messages.
enum class FileKind { kPointCloud, kMesh };

/// Bytes or lines of a point cloud's or mesh's file, in order. What take() and line() give is valid
/// until the next call. No heap after construction.
class BlockFile {
 public:
  static constexpr std::size_t kBytes = 1 << 18;  ///< of the buffer: the longest take() and line()

  /// @throws ConfigError naming the file: missing, no regular file, empty
  explicit BlockFile(const std::filesystem::path& file, FileKind kind = FileKind::kPointCloud);
  /// Bytes in memory as if they were a file of that name. @throws ConfigError: no bytes
  BlockFile(const std::filesystem::path& name, std::string bytes);

  const std::filesystem::path& name() const { return file_; }

  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return read_ - (end_ - begin_); }
  std::uint64_t remaining() const { return size_ - std::min(size_, position()); }

  /// The first bytes from here, at most `count`, left where they are.
  std::string peek(std::size_t count);
  /// The next `count` bytes, at most kBytes; nullptr where the file has fewer.
  const std::uint8_t* take(std::size_t count);
  /// The next line without its end (\n or \r\n); false at the end of the file.
  /// @throws ConfigError where the line is longer than kBytes
  bool line(std::string_view* text);
  std::uint64_t line_number() const { return line_number_; }  ///< of the last line(), from 1
  /// Goes to a byte from the start; beyond the end, take() gives nullptr.
  void seek(std::uint64_t position);
  /// Goes back to where a line begins, with so many lines before it.
  void seek_line(std::uint64_t position, std::uint64_t lines_before);

  /// "point cloud 'file' sentence" or "mesh file 'file' sentence" as ConfigError.
  [[noreturn]] void fail(const std::string& sentence) const;
  /// "... is no LAS file: it begins with 'abc', must begin with LASF".
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

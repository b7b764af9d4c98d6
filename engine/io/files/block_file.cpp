#include "engine/io/files/block_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/io/files/yaml.h"

namespace vinerow::io {
namespace {

const char* name_of_kind(FileKind kind) {
  return kind == FileKind::kMesh ? "mesh file" : "point cloud";
}

}  // namespace

BlockFile::BlockFile(const std::filesystem::path& file, FileKind kind) : file_(file), kind_(kind) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw ConfigError(fmt::format("{} '{}' does not exist{}", name_of_kind(kind), file.string(),
                                  nearest_file_hint(file)));
  }
  if (!std::filesystem::is_regular_file(file, error)) fail("is not a file");
  size_ = std::filesystem::file_size(file, error);
  stream_ = std::make_unique<std::ifstream>(file, std::ios::binary);
  if (!*stream_ || error) fail("cannot be read");
  if (size_ == 0) fail("is empty (0 bytes)");
  make_buffer();
}

BlockFile::BlockFile(const std::filesystem::path& name, std::string bytes)
    : file_(name), size_(bytes.size()) {
  if (size_ == 0) fail("is empty (0 bytes)");
  stream_ = std::make_unique<std::istringstream>(std::move(bytes), std::ios::binary);
  make_buffer();
}

/// Small files get a small buffer. One extra byte makes the first fill reach the end of the file.
void BlockFile::make_buffer() {
  buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBytes, size_ + 1)));
}

/// Moves the remaining bytes to the front and reads until `wanted` bytes are available.
bool BlockFile::fill(std::size_t wanted) {
  if (end_ - begin_ >= wanted) return true;
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  while (end_ < std::min(wanted, buffer_.size()) && *stream_) {
    stream_->read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
    end_ += static_cast<std::size_t>(stream_->gcount());
    read_ += static_cast<std::uint64_t>(stream_->gcount());
  }
  return end_ >= wanted;
}

std::string BlockFile::peek(std::size_t count) {
  fill(count);
  return std::string(buffer_.data() + begin_, std::min(count, end_ - begin_));
}

const std::uint8_t* BlockFile::take(std::size_t count) {
  VINEROW_ASSERT(count <= kBytes);
  if (!fill(count)) return nullptr;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(buffer_.data() + begin_);
  begin_ += count;
  return bytes;
}

bool BlockFile::line(std::string_view* text) {
  const auto newline = [&] {
    return static_cast<const char*>(std::memchr(buffer_.data() + begin_, '\n', end_ - begin_));
  };
  const char* found = newline();
  if (found == nullptr) {
    const bool full = fill(kBytes);
    found = newline();
    if (found == nullptr && full) {
      fail(fmt::format("has a line longer than {} bytes: line {}", kBytes, line_number_ + 1));
    }
  }
  if (begin_ == end_) return false;
  const std::size_t length =
      found ? static_cast<std::size_t>(found - (buffer_.data() + begin_)) : end_ - begin_;
  *text = std::string_view(buffer_.data() + begin_, length);
  begin_ += length + (found ? 1 : 0);
  if (text->ends_with('\r')) text->remove_suffix(1);
  ++line_number_;
  return true;
}

void BlockFile::seek(std::uint64_t position) {
  const std::uint64_t here = this->position();
  if (position >= here && position - here <= end_ - begin_) {
    begin_ += static_cast<std::size_t>(position - here);
    return;
  }
  begin_ = end_ = 0;
  // A position beyond the end becomes the end, where take() returns nullptr.
  read_ = std::min(position, size_);
  stream_->clear();
  stream_->seekg(static_cast<std::streamoff>(read_));
}

void BlockFile::seek_line(std::uint64_t position, std::uint64_t lines_before) {
  seek(position);
  line_number_ = lines_before;
}

void BlockFile::fail(const std::string& sentence) const {
  // Control characters of a broken file are escaped, so that they do not reach the terminal.
  std::string shown;
  for (const char c : sentence) {
    const auto byte = static_cast<unsigned char>(c);
    shown += byte >= 0x20 && byte < 0x7f ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  throw ConfigError(fmt::format("{} '{}' {}", name_of_kind(kind_), file_.string(), shown));
}

void BlockFile::fail_kind(const std::string& begin, const char* kind, const char* magic) const {
  fail(fmt::format("is not a {}: it begins with '{}', must begin with {}", kind, begin.substr(0, 4),
                   magic));
}

}  // namespace vinerow::io

#include "engine/core/whole_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "engine/core/error.h"

namespace vinerow {
namespace {

/// True for errors of storing, not of the place.
bool is_storage_failure(int error_number) {
  return error_number == ENOSPC || error_number == EDQUOT || error_number == EFBIG ||
         error_number == EIO;
}

/// A pipe or device cannot be replaced by rename; a link is written through.
bool is_renamed_over(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

std::filesystem::path behind_links(const std::filesystem::path& file) {
  std::error_code failed;
  if (!std::filesystem::is_symlink(file, failed)) return file;
  const std::filesystem::path real = std::filesystem::canonical(file, failed);
  return failed ? file : real;
}

}  // namespace

std::string words_of_write_failure(int error_number) {
  switch (error_number) {
    case ENOSPC:
      return "the disk is full";
    case EDQUOT:
      return "the disk quota is used up";
    case EFBIG:
      return "the file would exceed the size limit (ulimit -f)";
    case 0:
      return "writing failed";
    default:
      return std::strerror(error_number);
  }
}

void throw_cannot_write(const std::string& what, int error_number) {
  const std::string sentence =
      fmt::format("{} cannot be written: {}", what, words_of_write_failure(error_number));
  if (is_storage_failure(error_number)) throw WriteError(sentence);
  throw ConfigError(sentence);
}

std::filesystem::path temporary_name(const std::filesystem::path& file) {
  std::filesystem::path name = file;
  return name += ".part";
}

WholeFile::WholeFile(const std::filesystem::path& file, std::string_view kind)
    : what_(fmt::format("{}{}'{}'", kind, kind.empty() ? "" : " ", file.string())),
      target_(behind_links(file)),
      temporary_(is_renamed_over(target_) ? temporary_name(target_) : target_) {
  std::error_code ignored;
  if (std::filesystem::is_directory(target_, ignored)) fail(EISDIR);
  stream_.reset(std::fopen(temporary_.c_str(), "wb"));
  if (!stream_) fail(errno);
}

WholeFile::~WholeFile() {
  if (!stream_) return;
  stream_.reset();
  std::error_code ignored;
  if (temporary_ != target_) std::filesystem::remove(temporary_, ignored);
}

void WholeFile::write(std::string_view bytes) {
  if (bytes.empty()) return;
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size()) fail(errno);
}

void WholeFile::finish() {
  errno = 0;
  // The stream keeps the error flag of an earlier call, but not its number.
  if (std::ferror(stream_.get()) != 0 || std::fflush(stream_.get()) != 0) fail(errno);
  if (std::fclose(stream_.release()) != 0) fail(errno);
  if (temporary_ == target_) return;
  std::error_code failed;
  std::filesystem::rename(temporary_, target_, failed);
  if (failed) fail(failed.value());
}

void WholeFile::fail(int error_number) {
  std::error_code ignored;
  stream_.reset();
  if (temporary_ != target_) std::filesystem::remove(temporary_, ignored);
  throw_cannot_write(what_, error_number);
}

void write_whole_file(const std::filesystem::path& file, std::string_view bytes,
                      std::string_view kind) {
  WholeFile whole(file, kind);
  whole.write(bytes);
  whole.finish();
}

}  // namespace vinerow

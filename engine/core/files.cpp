#include "engine/core/files.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <system_error>

namespace vinerow {

std::optional<std::string> read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::error_code error;
  if (!stream || std::filesystem::is_directory(file, error)) return std::nullopt;
  // The size is only a hint: pipes and files of /proc do not state it.
  const std::uintmax_t hint = std::filesystem::file_size(file, error);
  constexpr std::size_t kLeast = 4096;
  std::string bytes(error ? kLeast : static_cast<std::size_t>(hint) + 1, '\0');
  std::size_t filled = 0;
  while (stream) {
    if (filled == bytes.size()) bytes.resize(std::max(2 * filled, kLeast));
    stream.read(bytes.data() + filled, static_cast<std::streamsize>(bytes.size() - filled));
    filled += static_cast<std::size_t>(stream.gcount());
  }
  bytes.resize(filled);
  return bytes;
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace vinerow

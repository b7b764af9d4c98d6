#include "engine/run/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "engine/core/error.h"

namespace vinerow::run {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) return;
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw ConfigError(
      fmt::format("folder '{}' is in use by another run: wait until it ends, or give this one a "
                  "folder of its own (--out)",
                  folder.string()));
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

DiskReserve::DiskReserve(const std::filesystem::path& folder, std::size_t bytes) {
  std::string name = (folder / ".reserve_XXXXXX").string();
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) return;
  ::unlink(name.c_str());
  if (::posix_fallocate(descriptor_, 0, static_cast<off_t>(bytes)) != 0) give_back();
}

void DiskReserve::give_back() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace vinerow::run

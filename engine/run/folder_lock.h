#pragma once
/// Lock on a run's folder, and a reserve of disk space for the verdict if the disk is full.

#include <cstddef>
#include <filesystem>

namespace vinerow::run {

/// Lock on a folder for the lifetime of this object or its process. It leaves no file behind. On
/// file systems without locks (some network mounts) it has no effect.
class FolderLock {
 public:
  /// @pre the folder exists. @throws ConfigError if another process or run holds the lock
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

/// Disk space held by an unlinked file, until give_back() or destruction.
class DiskReserve {
 public:
  /// If the space is not available, nothing is reserved; later writes then report the error.
  DiskReserve(const std::filesystem::path& folder, std::size_t bytes);
  ~DiskReserve() { give_back(); }
  DiskReserve(const DiskReserve&) = delete;
  DiskReserve& operator=(const DiskReserve&) = delete;
  void give_back();

 private:
  int descriptor_ = -1;
};

}  // namespace vinerow::run

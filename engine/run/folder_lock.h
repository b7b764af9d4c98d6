#pragma once
/// Keeps two runs out of one folder, and room on the disk for what a run must still say when the
/// disk is full.

#include <cstddef>
#include <filesystem>

namespace vinerow::run {

/// The folder belongs to this object until it goes, or its process does. Nothing is left behind.
/// Where the file system knows no locks (some network mounts) there is none.
class FolderLock {
 public:
  /// @pre the folder exists. @throws ConfigError where another process or run has it
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

/// Disk space of a file without a name, given back when this goes.
class DiskReserve {
 public:
  /// Where the space is not to be had nothing is reserved; who writes then says so.
  DiskReserve(const std::filesystem::path& folder, std::size_t bytes);
  ~DiskReserve() { give_back(); }
  DiskReserve(const DiskReserve&) = delete;
  DiskReserve& operator=(const DiskReserve&) = delete;
  void give_back();

 private:
  int descriptor_ = -1;
};

}  // namespace vinerow::run

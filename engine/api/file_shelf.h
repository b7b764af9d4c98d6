#pragma once
/// Cache of file contents that parts have read, for parts that are built later.
///
/// A reset of a session rebuilds its parts; their file contents stay on the shelf as long as the
/// files do not change.

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <typeindex>
#include <utility>

namespace vinerow {

class FileShelf {
 public:
  /// Returns the value cached under this key, or calls `make()` and caches its result. Thread safe.
  /// Two threads may both call make(); the first result is kept.
  /// @param key  everything that the value depends on: file_mark() of its files, options
  template <class T, class Make>
  std::shared_ptr<const T> get(const std::string& key, Make&& make) {
    const Key full_key{typeid(T), key};
    {
      const std::lock_guard lock(mutex_);
      const auto found = kept_.find(full_key);
      if (found != kept_.end()) return std::static_pointer_cast<const T>(found->second);
    }
    // Without the lock: reading takes long and may query the shelf for other files.
    std::shared_ptr<const void> made = std::make_shared<const T>(make());
    const std::lock_guard lock(mutex_);
    const auto kept = kept_.emplace(full_key, std::move(made)).first;
    return std::static_pointer_cast<const T>(kept->second);
  }

 private:
  using Key = std::pair<std::type_index, std::string>;

  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const void>> kept_;
};

/// Name, size and modification time of a file; for a folder, those of all its contents. A missing
/// file has a mark of its own, so that reading it fails as usual.
std::string file_mark(const std::filesystem::path& path);

/// Cached value from the shelf; without a shelf the result of make().
template <class T, class Make>
std::shared_ptr<const T> keep(FileShelf* shelf, const std::string& key, Make&& make) {
  if (!shelf) return std::make_shared<const T>(make());
  return shelf->get<T>(key, std::forward<Make>(make));
}

}  // namespace vinerow

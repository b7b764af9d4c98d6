#pragma once
/// What parts have read from files, kept for the parts that are built after them.
///
/// A session that begins again builds its parts anew; what they read is on the shelf as long as the
/// files stay as they were.

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
  /// What was put here under this key, or what `make()` returns now. Safe to call from several
  /// threads, which may then both make it: the first one's is kept.
  /// @param key  everything that the value depends on: file_mark() of its files, options
  template <class T, class Make>
  std::shared_ptr<const T> get(const std::string& key, Make&& make) {
    const Key full_key{typeid(T), key};
    {
      const std::lock_guard lock(mutex_);
      const auto found = kept_.find(full_key);
      if (found != kept_.end()) return std::static_pointer_cast<const T>(found->second);
    }
    // Not under the lock: reading takes long, and may ask for other files.
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

/// The file's name, size and time of writing; of a folder, those of all that is in it. A file that
/// is not there has a mark of its own, so that reading it fails as it always does.
std::string file_mark(const std::filesystem::path& path);

/// From the shelf, or made anew where there is none.
template <class T, class Make>
std::shared_ptr<const T> keep(FileShelf* shelf, const std::string& key, Make&& make) {
  if (!shelf) return std::make_shared<const T>(make());
  return shelf->get<T>(key, std::forward<Make>(make));
}

}  // namespace vinerow

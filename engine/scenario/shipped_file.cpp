#include "engine/scenario/shipped_file.h"

#include <dlfcn.h>

namespace vinerow::scenario {
namespace {

namespace fs = std::filesystem;

/// Folder of the file that contains this function: libvinerow.so, or a test program.
fs::path folder_of_library() {
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&find_shipped), &library) == 0) return {};
  std::error_code error;
  return fs::canonical(library.dli_fname, error).parent_path();
}

}  // namespace

fs::path find_shipped(const fs::path& file) {
  std::error_code error;
  if (file.empty() || *file.begin() != "assets" || fs::exists(file, error)) return file;
  constexpr int kLevels = 3;
  fs::path folder = folder_of_library();
  for (int level = 0; level < kLevels && !folder.empty(); ++level, folder = folder.parent_path()) {
    const fs::path shipped = folder / "share/vinerow" / file;
    if (fs::exists(shipped, error)) return shipped;
  }
  return file;
}

}  // namespace vinerow::scenario

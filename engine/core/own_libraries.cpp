#include "engine/core/own_libraries.h"

#include <dlfcn.h>

namespace vinerow {

int own_libraries_first() {
#ifdef __SANITIZE_ADDRESS__
  return 0;
#else
  return RTLD_DEEPBIND;
#endif
}

std::filesystem::path find_own_library(const std::string& name) {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&find_own_library), &info) == 0 || !info.dli_fname) {
    return name;
  }
  const std::filesystem::path folder = std::filesystem::absolute(info.dli_fname).parent_path();
  const std::filesystem::path of_programs = folder.parent_path() / "lib" / name;
  const bool is_of_programs =
      !std::filesystem::exists(folder / name) && std::filesystem::exists(of_programs);
  return is_of_programs ? of_programs : folder / name;
}

}  // namespace vinerow

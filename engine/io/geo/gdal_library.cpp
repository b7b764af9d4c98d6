#include "engine/io/geo/gdal_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "engine/core/error.h"

namespace vinerow::io {
namespace {

/// Stays open until the program ends. Without own_libraries_first(): GDAL and PROJ must call the
/// elementary functions of the program (engine/elementary). The Python package, whose interpreter
/// has loaded others, links GDAL.
GdalLibrary open_gdal() {
  void* library = dlopen(VINEROW_GDAL_FILE, RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) {
    throw ConfigError(fmt::format("geodata need GDAL, which cannot be loaded: {}", dlerror()));
  }
  GdalLibrary found;
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(library, name));
    if (function == nullptr) {
      throw ConfigError(
          fmt::format("geodata need GDAL, but {} has no function {}: is it of the "
                      "version that vinerow was built with?",
                      VINEROW_GDAL_FILE, name));
    }
  };
#define VINEROW_GDAL_FIND(function) find(found.function, #function);
  VINEROW_GDAL_FUNCTIONS(VINEROW_GDAL_FIND)
#undef VINEROW_GDAL_FIND
  return found;
}

}  // namespace

const GdalLibrary& gdal() {
  static const GdalLibrary library = open_gdal();
  return library;
}

}  // namespace vinerow::io

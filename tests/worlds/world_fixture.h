#pragma once
/// Builds worlds by name for tests, with mesh files in a folder of the test.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "engine/api/registry.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "tests/support/paths.h"
#include "worlds/register_worlds.h"

namespace vinerow::test {

inline std::filesystem::path world_cache_folder() {
  return std::filesystem::path(VINEROW_BINARY_DIR) / "test_cache" / "worlds";
}

inline const Registry& world_registry() {
  static const Registry registry = [] {
    ::setenv("VINEROW_CACHE", world_cache_folder().c_str(), 1);
    Registry r;
    worlds::register_worlds(r);
    return r;
  }();
  return registry;
}

inline ParameterSet world_parameters(const std::string& type) {
  return ParameterSet(world_registry().spec(PartKind::kWorld, type).parameters, type);
}

inline std::unique_ptr<WorldModel> make_world(const std::string& type,
                                              const ParameterSet& parameters) {
  parameters.require_complete();
  WorldContext context;
  context.part = "world";
  context.seed = 1;
  return world_registry().make_world(type, parameters, context);
}

inline std::string riseholme_file() {
  return std::string(VINEROW_SOURCE_DIR) + "/assets/worlds/riseholme/riseholme.geojson";
}

/// Writes a file below the system's folder for temporary files, whole or not at all: tests that run
/// beside this one may read the same name.
inline std::string temporary_file(const std::string& name, const std::string& content) {
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_worlds_test";
  std::filesystem::create_directories(folder);
  const auto part = folder / fmt::format("{}.{}", name, ::getpid());
  std::ofstream(part, std::ios::binary) << content;
  std::filesystem::rename(part, folder / name);
  return (folder / name).string();
}

template <class F>
std::string config_error_of(F&& f) {
  try {
    f();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "no error";
}

/// A cube of 1 m with its lower corner in the origin.
inline const char* cube_obj() {
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
}

}  // namespace vinerow::test

#pragma once
/// How a shared library brings parts of its own. In one source file of the plug-in:
///
///   void register_parts(vinerow::Registry& registry) { registry.add_controller(spec, factory); }
///   VINEROW_PLUGIN(register_parts)
///
/// The loader compares the ABI tag compiled into the plug-in with its own and refuses a difference.

#include "engine/api/registry.h"

/// Raised whenever a class or struct in engine/api changes its layout or virtual functions.
#define VINEROW_ABI_VERSION 9

/// ABI tag: our version, and the compiler's C++ ABI, so that a plug-in built otherwise is refused
/// by name.
#define VINEROW_ABI_STRINGIFY_2(x) #x
#define VINEROW_ABI_STRINGIFY(x) VINEROW_ABI_STRINGIFY_2(x)
#define VINEROW_ABI_TAG                                                                       \
  "vinerow-abi-" VINEROW_ABI_STRINGIFY(VINEROW_ABI_VERSION) "-cxxabi-" VINEROW_ABI_STRINGIFY( \
      __GXX_ABI_VERSION)

#define VINEROW_PLUGIN(register_function)                                              \
  extern "C" __attribute__((visibility("default"))) const char* vinerow_plugin_abi() { \
    return VINEROW_ABI_TAG;                                                            \
  }                                                                                    \
  extern "C" __attribute__((visibility("default"))) void vinerow_plugin_register(      \
      vinerow::Registry* registry) {                                                   \
    register_function(*registry);                                                      \
  }

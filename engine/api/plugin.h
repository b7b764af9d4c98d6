#pragma once
/// Entry points of a plug-in: a shared library with parts of its own. One source file of the
/// plug-in contains
///
///   void register_parts(vinerow::Registry& registry) { registry.add_controller(spec, factory); }
///   VINEROW_PLUGIN(register_parts)
///
/// The loader compares the ABI tag compiled into the plug-in (abi.h) with its own. If they differ
/// it rejects the plug-in with one sentence.

#include "engine/api/abi.h"
#include "engine/api/registry.h"

/// Makes a shared library a plug-in. @param register_function  void(vinerow::Registry&)
#define VINEROW_PLUGIN(register_function)                                              \
  extern "C" __attribute__((visibility("default"))) const char* vinerow_plugin_abi() { \
    return VINEROW_ABI_TAG;                                                            \
  }                                                                                    \
  extern "C" __attribute__((visibility("default"))) void vinerow_plugin_register(      \
      vinerow::Registry* registry) {                                                   \
    register_function(*registry);                                                      \
  }

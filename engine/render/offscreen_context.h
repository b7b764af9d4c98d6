#pragma once
/// An OpenGL 3.3 core context without a window. One implementation exists (OSMesa); another, such
/// as EGL surfaceless, would be one more file with the same two functions.

#include <memory>

#include "engine/core/result.h"

namespace vinerow::render {

class OffscreenContext {
 public:
  virtual ~OffscreenContext() = default;
  /// Binds the context to the calling thread. @throws std::runtime_error
  virtual void make_current() = 0;
  /// @pre current
  virtual void* find_function(const char* name) const = 0;
};

/// Mesa's software rasterizer, loaded at run time, so that a machine without it still simulates.
/// The library's name can be given in the environment variable VINEROW_OSMESA.
/// @returns the context, or why there is none
Result<std::unique_ptr<OffscreenContext>> make_osmesa_context();

}  // namespace vinerow::render

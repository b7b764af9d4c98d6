#pragma once
/// OpenGL 3.3 core context without a window. The only implementation is OSMesa; another one, such
/// as EGL surfaceless, would be a further file with the same two functions.

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

/// Creates a context of Mesa's software rasterizer. It is loaded at run time, so that simulations
/// run on machines without it. The environment variable VINEROW_OSMESA overrides the library's
/// name.
/// @returns the context, or the reason for its absence
Result<std::unique_ptr<OffscreenContext>> make_osmesa_context();

}  // namespace vinerow::render

#pragma once
/// Where a frame is drawn: colour, depth and stencil of a size and number of samples, and reading
/// back.

#include "engine/render/gl.h"
#include "engine/render/scene.h"

namespace vinerow::render {

class FrameTarget {
 public:
  explicit FrameTarget(const Gl& gl) : gl_(gl) {}

  /// Makes buffers if size or samples differ from before, binds and clears them.
  /// @throws std::runtime_error if the implementation cannot make them
  void begin(int width, int height, int samples);
  /// Resolves samples and reads the pixels.
  Image read() const;

 private:
  void release();
  void make(GLuint& framebuffer, GLuint& colour, GLuint* depth, int samples) const;

  const Gl& gl_;
  int width_ = 0;
  int height_ = 0;
  int samples_ = 0;
  GLuint framebuffer_ = 0, colour_ = 0, depth_ = 0;
  GLuint resolved_framebuffer_ = 0, resolved_colour_ = 0;  ///< only with several samples
};

}  // namespace vinerow::render

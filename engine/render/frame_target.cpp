#include "engine/render/frame_target.h"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

namespace vinerow::render {

void FrameTarget::make(GLuint& framebuffer, GLuint& colour, GLuint* depth, int samples) const {
  const int count = samples > 1 ? samples : 0;
  gl_.GenFramebuffers(1, &framebuffer);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  const auto attach = [&](GLuint& buffer, GLenum format, GLenum place) {
    gl_.GenRenderbuffers(1, &buffer);
    gl_.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, count, format, width_, height_);
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  };
  attach(colour, GL_RGBA8, GL_COLOR_ATTACHMENT0);
  if (depth != nullptr) attach(*depth, GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL_ATTACHMENT);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error(fmt::format(
        "OpenGL makes no picture of {} x {} pixels with {} samples", width_, height_, samples));
  }
}

void FrameTarget::release() {
  if (framebuffer_ == 0) return;
  const GLuint framebuffers[] = {framebuffer_, resolved_framebuffer_};
  const GLuint buffers[] = {colour_, depth_, resolved_colour_};
  gl_.DeleteFramebuffers(2, framebuffers);
  gl_.DeleteRenderbuffers(3, buffers);
  framebuffer_ = resolved_framebuffer_ = resolved_colour_ = 0;
}

void FrameTarget::begin(int width, int height, int samples) {
  if (width != width_ || height != height_ || samples != samples_) {
    release();
    width_ = width;
    height_ = height;
    samples_ = samples;
    make(framebuffer_, colour_, &depth_, samples);
    if (samples > 1) make(resolved_framebuffer_, resolved_colour_, nullptr, 1);
  }
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_, height_);
  gl_.DepthMask(GL_TRUE);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.ClearColor(0.5f, 0.5f, 0.5f, 1.0f);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

Image FrameTarget::read() const {
  GLuint source = framebuffer_;
  if (samples_ > 1) {
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_framebuffer_);
    gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                        GL_NEAREST);
    source = resolved_framebuffer_;
  }
  gl_.BindFramebuffer(GL_FRAMEBUFFER, source);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  const std::size_t pixels = static_cast<std::size_t>(width_) * height_;
  std::vector<std::uint8_t> rgba(pixels * 4);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  Image image{width_, height_, std::vector<std::uint8_t>(pixels * 3)};
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* from = &rgba[static_cast<std::size_t>(height_ - 1 - y) * width_ * 4];
    std::uint8_t* to = &image.rgb[static_cast<std::size_t>(y) * width_ * 3];
    for (int x = 0; x < width_; ++x) {
      for (int c = 0; c < 3; ++c) to[3 * x + c] = from[4 * x + c];
    }
  }
  return image;
}

}  // namespace vinerow::render

#include "engine/render/frame_target.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace vinerow::render {

void FrameTarget::make() {
  gl_.GenFramebuffers(1, &framebuffer_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const auto attach = [&](GLuint& buffer, GLenum format, GLenum place) {
    gl_.GenRenderbuffers(1, &buffer);
    gl_.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, 0, format, width_ * scale_,
                                       height_ * scale_);
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  };
  attach(colour_, GL_RGBA8, GL_COLOR_ATTACHMENT0);
  attach(depth_, GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL_ATTACHMENT);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error(fmt::format("OpenGL cannot make a picture of {} x {} pixels",
                                         width_ * scale_, height_ * scale_));
  }
}

void FrameTarget::release() {
  if (framebuffer_ == 0) return;
  const GLuint buffers[] = {colour_, depth_};
  gl_.DeleteFramebuffers(1, &framebuffer_);
  gl_.DeleteRenderbuffers(2, buffers);
  framebuffer_ = 0;
}

void FrameTarget::begin(int width, int height, int scale) {
  if (width != width_ || height != height_ || scale != scale_ || framebuffer_ == 0) {
    release();
    width_ = width;
    height_ = height;
    scale_ = scale;
    make();
  }
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_ * scale_, height_ * scale_);
  gl_.DepthMask(GL_TRUE);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.ClearColor(0.5f, 0.5f, 0.5f, 1.0f);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

Image FrameTarget::read() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  const int wide = width_ * scale_;
  const int high = height_ * scale_;
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(wide) * high * 4);
  gl_.ReadPixels(0, 0, wide, high, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  Image image{width_, height_,
              std::vector<std::uint8_t>(static_cast<std::size_t>(width_) * height_ * 3)};
  const float share = 1.0f / static_cast<float>(scale_ * scale_);
  for (int y = 0; y < height_; ++y) {
    // OpenGL's first row is the lowest.
    const std::size_t lowest = static_cast<std::size_t>(height_ - 1 - y) * scale_ * wide * 4;
    std::uint8_t* to = &image.rgb[static_cast<std::size_t>(y) * width_ * 3];
    for (int x = 0; x < width_; ++x) {
      int sum[3] = {0, 0, 0};
      for (int row = 0; row < scale_; ++row) {
        const std::uint8_t* from =
            &rgba[lowest + (static_cast<std::size_t>(row) * wide + x * scale_) * 4];
        for (int k = 0; k < scale_; ++k) {
          for (int c = 0; c < 3; ++c) sum[c] += from[4 * k + c] * from[4 * k + c];
        }
      }
      for (int c = 0; c < 3; ++c) {
        to[3 * x + c] =
            static_cast<std::uint8_t>(std::sqrt(static_cast<float>(sum[c]) * share) + 0.5f);
      }
    }
  }
  return image;
}

std::vector<SeenMark> FrameTarget::take_marks(std::size_t count) const {
  std::vector<SeenMark> marks(count);
  if (count > 0) {
    const int wide = width_ * scale_, high = height_ * scale_;
    std::vector<std::uint8_t> stencil(static_cast<std::size_t>(wide) * high);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl_.ReadPixels(0, 0, wide, high, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencil.data());
    const double share = 1.0 / static_cast<double>(stencil.size());
    for (int y = 0; y < high; ++y) {
      for (int x = 0; x < wide; ++x) {
        const std::size_t number = stencil[static_cast<std::size_t>(y) * wide + x];
        if (number == 0 || number > count) continue;
        SeenMark& mark = marks[number - 1];
        mark.share += share;
        mark.box_px.extend(Eigen::Vector2i(x / scale_, height_ - 1 - y / scale_));
      }
    }
  }
  gl_.Clear(GL_STENCIL_BUFFER_BIT);
  return marks;
}

}  // namespace vinerow::render

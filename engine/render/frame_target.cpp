#include "engine/render/frame_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "engine/core/parallel.h"
#include "engine/render/texture_units.h"

namespace vinerow::render {
namespace {

int sky_pixels(int of_picture) {
  return (of_picture + FrameTarget::kSkyPixels - 1) / FrameTarget::kSkyPixels;
}

}  // namespace

void FrameTarget::make() {
  gl_.GenFramebuffers(1, &framebuffer_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const auto attach = [&](GLuint& texture, TextureUnit unit, GLenum format, GLenum layout,
                          GLenum type, GLenum place) {
    gl_.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl_.GenTextures(1, &texture);
    gl_.BindTexture(GL_TEXTURE_2D, texture);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), pattern_.columns(),
                   pattern_.rows(), 0, layout, type, nullptr);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, place, GL_TEXTURE_2D, texture, 0);
    gl_.ActiveTexture(GL_TEXTURE0 + kUnitImage);
  };
  gl_.GenRenderbuffers(1, &colour_);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, colour_);
  gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, 0, GL_RGBA8, pattern_.columns(),
                                     pattern_.rows());
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  attach(depth_, kUnitDepth, GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
         GL_DEPTH_STENCIL_ATTACHMENT);
  gl_.GenFramebuffers(1, &foliage_framebuffer_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, foliage_framebuffer_);
  attach(albedo_, kUnitAlbedo, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_COLOR_ATTACHMENT0);
  attach(normal_, kUnitNormal, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_COLOR_ATTACHMENT1);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
  const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  gl_.DrawBuffers(2, both);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error(fmt::format("OpenGL cannot make a picture of {} x {} pixels",
                                         pattern_.columns(), pattern_.rows()));
  }
}

void FrameTarget::make_ground() {
  gl_.GenFramebuffers(1, &ground_framebuffer_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, ground_framebuffer_);
  gl_.GenRenderbuffers(1, &ground_depth_);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, ground_depth_);
  gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, 0, GL_DEPTH24_STENCIL8, pattern_.width(),
                                     pattern_.height());
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                              ground_depth_);
  ground_ = attach_colours(kUnitGroundSeen, pattern_.width(), pattern_.height());
}

void FrameTarget::make_sky() {
  gl_.GenFramebuffers(1, &sky_framebuffer_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, sky_framebuffer_);
  sky_ = attach_colours(kUnitSkySeen, sky_pixels(pattern_.width()), sky_pixels(pattern_.height()));
}

GLuint FrameTarget::attach_colours(TextureUnit unit, int width, int height) const {
  GLuint texture = 0;
  gl_.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl_.GenTextures(1, &texture);
  gl_.BindTexture(GL_TEXTURE_2D, texture);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  gl_.ActiveTexture(GL_TEXTURE0 + kUnitImage);
  return texture;
}

void FrameTarget::begin_ground() {
  if (ground_framebuffer_ == 0) make_ground();
  gl_.BindFramebuffer(GL_FRAMEBUFFER, ground_framebuffer_);
  gl_.Viewport(0, 0, pattern_.width(), pattern_.height());
}

void FrameTarget::begin_sky() {
  if (sky_framebuffer_ == 0) make_sky();
  gl_.BindFramebuffer(GL_FRAMEBUFFER, sky_framebuffer_);
  gl_.Viewport(0, 0, sky_pixels(pattern_.width()), sky_pixels(pattern_.height()));
}

void FrameTarget::release() {
  if (sky_framebuffer_ != 0) {
    gl_.DeleteFramebuffers(1, &sky_framebuffer_);
    gl_.DeleteTextures(1, &sky_);
    sky_framebuffer_ = 0;
  }
  if (ground_framebuffer_ != 0) {
    gl_.DeleteFramebuffers(1, &ground_framebuffer_);
    gl_.DeleteRenderbuffers(1, &ground_depth_);
    gl_.DeleteTextures(1, &ground_);
    ground_framebuffer_ = 0;
  }
  if (framebuffer_ == 0) return;
  const GLuint textures[] = {depth_, albedo_, normal_};
  gl_.DeleteFramebuffers(1, &framebuffer_);
  gl_.DeleteFramebuffers(1, &foliage_framebuffer_);
  gl_.DeleteRenderbuffers(1, &colour_);
  gl_.DeleteTextures(3, textures);
  framebuffer_ = 0;
}

void FrameTarget::begin(const SamplePattern& pattern) {
  const bool fits = framebuffer_ != 0 && pattern.columns() == pattern_.columns() &&
                    pattern.rows() == pattern_.rows();
  pattern_ = pattern;
  if (!fits) {
    release();
    make();
  }
  resume();
  gl_.DepthMask(GL_TRUE);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.ClearColor(0.5f, 0.5f, 0.5f, 1.0f);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

void FrameTarget::begin_foliage() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, foliage_framebuffer_);
}

void FrameTarget::resume() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, pattern_.columns(), pattern_.rows());
}

void FrameTarget::sum_row(const std::vector<std::uint8_t>& drawn, int y,
                          std::vector<std::uint32_t>& sums) const {
  std::fill(sums.begin(), sums.end(), 0u);
  const std::size_t stride = static_cast<std::size_t>(pattern_.stride()) * 4;
  // Tap by tap, because compilers vectorize that.
  for (const SamplePattern::Tap& tap : pattern_.taps()) {
    const auto first = static_cast<std::ptrdiff_t>(pattern_.first_of(0, y)) + tap.offset;
    const std::uint8_t* __restrict from = &drawn[4 * static_cast<std::size_t>(first)];
    std::uint32_t* __restrict sum = sums.data();
    const int shift = std::countr_zero(tap.weight);
    for (int x = 0; x < pattern_.width(); ++x, from += stride, sum += 4) {
      for (int c = 0; c < 4; ++c) {
        // The square of a byte fits into 16 bits, whose products are quick.
        const auto square = static_cast<std::uint16_t>(from[c] * from[c]);
        sum[c] += static_cast<std::uint32_t>(square) << shift;
      }
    }
  }
}

Image FrameTarget::read() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  std::vector<std::uint8_t> drawn(static_cast<std::size_t>(pattern_.columns()) * pattern_.rows() *
                                  4);
  gl_.ReadPixels(0, 0, pattern_.columns(), pattern_.rows(), GL_RGBA, GL_UNSIGNED_BYTE,
                 drawn.data());
  const int width = pattern_.width(), height = pattern_.height();
  Image image{width, height,
              std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 3)};
  const float share = 1.0f / static_cast<float>(pattern_.weight_sum());
  constexpr std::size_t kRowsAtOnce = 32;
  for_chunks(static_cast<std::size_t>(height), kRowsAtOnce,
             [&](std::size_t, std::size_t begin, std::size_t end) {
               std::vector<std::uint32_t> sums(static_cast<std::size_t>(width) * 4);
               for (std::size_t y = begin; y < end; ++y) {
                 sum_row(drawn, static_cast<int>(y), sums);
                 std::uint8_t* to = &image.rgb[y * width * 3];
                 for (int x = 0; x < width; ++x) {
                   for (int c = 0; c < 3; ++c) {
                     const float mean = static_cast<float>(sums[4 * x + c]) * share;
                     to[3 * x + c] = static_cast<std::uint8_t>(std::sqrt(mean) + 0.5f);
                   }
                 }
               }
             });
  return image;
}

std::vector<SeenMark> FrameTarget::take_marks(std::size_t count) const {
  std::vector<SeenMark> marks(count);
  if (count > 0) {
    std::vector<std::uint8_t> stencil(static_cast<std::size_t>(pattern_.columns()) *
                                      pattern_.rows());
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl_.ReadPixels(0, 0, pattern_.columns(), pattern_.rows(), GL_STENCIL_INDEX, GL_UNSIGNED_BYTE,
                   stencil.data());
    const int width = pattern_.width(), height = pattern_.height();
    const double share = 1.0 / (double{1} * width * height * pattern_.weight_sum());
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto first = static_cast<std::ptrdiff_t>(pattern_.first_of(x, y));
        for (const SamplePattern::Tap& tap : pattern_.taps()) {
          const std::size_t number = stencil[static_cast<std::size_t>(first + tap.offset)];
          if (number == 0 || number > count) continue;
          SeenMark& mark = marks[number - 1];
          mark.share += share * tap.weight;
          mark.box_px.extend(Eigen::Vector2i(x, y));
        }
      }
    }
  }
  gl_.Clear(GL_STENCIL_BUFFER_BIT);
  return marks;
}

}  // namespace vinerow::render

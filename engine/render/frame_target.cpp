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

/// Adds the squares of a row's pixels, RGBA, of one tap. Tap by tap and with a constant stride,
/// because compilers vectorize that: a third of the time.
/// @param from   the tap of the row's first pixel
/// @param shift  of its weight
template <int kStride>
void add_tap(const std::uint8_t* __restrict from, int shift, std::vector<std::uint32_t>& sums) {
  std::uint32_t* __restrict sum = sums.data();
  for (std::size_t x = 0; x < sums.size() / 4; ++x, from += 4 * kStride, sum += 4) {
    for (int c = 0; c < 4; ++c) {
      // The square of a byte fits into 16 bits, whose products are quick.
      const auto square = static_cast<std::uint16_t>(from[c] * from[c]);
      sum[c] += static_cast<std::uint32_t>(square) << shift;
    }
  }
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

bool FrameTarget::has_marks(const std::vector<std::uint8_t>& stencil, int y) const {
  const auto first = static_cast<std::ptrdiff_t>(pattern_.first_of(0, y));
  const auto last = static_cast<std::ptrdiff_t>(pattern_.first_of(pattern_.width() - 1, y));
  // Not left early, because compilers vectorize that.
  unsigned any = 0;
  for (const SamplePattern::Tap& tap : pattern_.taps()) {
    for (std::ptrdiff_t i = first + tap.offset; i <= last + tap.offset; ++i) {
      any |= stencil[static_cast<std::size_t>(i)];
    }
  }
  return any != 0;
}

void FrameTarget::sum_row(int y, std::vector<std::uint32_t>& sums) const {
  std::fill(sums.begin(), sums.end(), 0u);
  const auto add = pattern_.stride() == 1   ? add_tap<1>
                   : pattern_.stride() == 2 ? add_tap<2>
                                            : add_tap<3>;
  for (const SamplePattern::Tap& tap : pattern_.taps()) {
    const auto first = static_cast<std::ptrdiff_t>(pattern_.first_of(0, y)) + tap.offset;
    add(&drawn_[4 * static_cast<std::size_t>(first)], std::countr_zero(tap.weight), sums);
  }
}

void FrameTarget::read_drawn(GLenum layout, std::size_t bytes_per_pixel,
                             std::vector<std::uint8_t>& drawn) const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.PixelStorei(GL_PACK_ROW_LENGTH, pattern_.columns());
  drawn.resize(static_cast<std::size_t>(pattern_.columns()) * pattern_.rows() * bytes_per_pixel);
  // Band by band: two fifths of a staggered pattern are outside the picture.
  constexpr int kBand = 32;
  for (int row = 0; row < pattern_.rows(); row += kBand) {
    const int rows = std::min(kBand, pattern_.rows() - row);
    const SamplePattern::Columns used = pattern_.used_columns(row, rows);
    const std::size_t first = static_cast<std::size_t>(row) * pattern_.columns() + used.begin;
    gl_.ReadPixels(used.begin, row, used.end - used.begin, rows, layout, GL_UNSIGNED_BYTE,
                   &drawn[bytes_per_pixel * first]);
  }
  gl_.PixelStorei(GL_PACK_ROW_LENGTH, 0);
}

Image FrameTarget::read() {
  read_drawn(GL_RGBA, 4, drawn_);
  const int width = pattern_.width(), height = pattern_.height();
  Image image{width, height,
              std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 3)};
  const float share = 1.0f / static_cast<float>(pattern_.weight_sum());
  constexpr std::size_t kRowsAtOnce = 32;
  for_chunks(static_cast<std::size_t>(height), kRowsAtOnce,
             [&](std::size_t, std::size_t begin, std::size_t end) {
               std::vector<std::uint32_t> sums(static_cast<std::size_t>(width) * 4);
               for (std::size_t y = begin; y < end; ++y) {
                 sum_row(static_cast<int>(y), sums);
                 std::uint8_t* to = &image.rgb[y * width * 3];
                 for (int x = 0; x < width; ++x) {
                   for (int c = 0; c < 3; ++c) {
                     // A signed number becomes a float more quickly.
                     const auto sum = static_cast<int>(sums[static_cast<std::size_t>(4 * x + c)]);
                     const float level = std::sqrt(static_cast<float>(sum) * share) + 0.5f;
                     to[3 * x + c] = static_cast<std::uint8_t>(static_cast<int>(level));
                   }
                 }
               }
             });
  return image;
}

std::vector<SeenMark> FrameTarget::take_marks(std::size_t count) const {
  std::vector<SeenMark> marks(count);
  if (count > 0) {
    std::vector<std::uint8_t> stencil;
    read_drawn(GL_STENCIL_INDEX, 1, stencil);
    const int width = pattern_.width(), height = pattern_.height();
    const double share = 1.0 / (double{1} * width * height * pattern_.weight_sum());
    for (int y = 0; y < height; ++y) {
      if (!has_marks(stencil, y)) continue;
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

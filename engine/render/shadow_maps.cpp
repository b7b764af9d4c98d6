#include "engine/render/shadow_maps.h"

#include <algorithm>
#include <cmath>

namespace vinerow::render {

ShadowMaps::ShadowMaps(const Gl& gl, const Eigen::Vector3d& sun_direction,
                       const Eigen::AlignedBox3d& casters_W)
    : gl_(gl) {
  const Eigen::Vector3d z = -sun_direction.normalized();
  const Eigen::Vector3d helper =
      std::abs(z.z()) > 0.99 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d x = helper.cross(z).normalized();
  R_LW_.row(0) = x;
  R_LW_.row(1) = z.cross(x);
  R_LW_.row(2) = z;

  Eigen::AlignedBox3d box_L;
  for (int i = 0; i < 8; ++i) {
    box_L.extend(
        Eigen::Vector3d(R_LW_ * casters_W.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i))));
  }
  far_.centre_L = box_L.center().head<2>();
  far_.half_m = 0.5 * box_L.sizes().head<2>().maxCoeff() * 1.02 + 1.0;
  z_low_m_ = box_L.min().z() - 5.0;
  z_high_m_ = box_L.max().z() + 5.0;

  kept_ = make_array(1 + kNearSlots);
  shown_ = make_array(2);
  gl_.GenFramebuffers(1, &framebuffer_);
  gl_.GenFramebuffers(1, &source_framebuffer_);
}

GLuint ShadowMaps::make_array(int layers) const {
  GLuint texture = 0;
  gl_.GenTextures(1, &texture);
  gl_.BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  gl_.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT16, kSize, kSize, layers, 0,
                 GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, nullptr);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  return texture;
}

Eigen::Matrix4d ShadowMaps::clip_from_world(const Square& square) const {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = R_LW_;
  matrix.topRightCorner<3, 1>() =
      -Eigen::Vector3d(square.centre_L.x(), square.centre_L.y(), 0.5 * (z_low_m_ + z_high_m_));
  matrix.topRows<2>() /= square.half_m;
  matrix.row(2) /= 0.5 * (z_high_m_ - z_low_m_);
  return matrix;
}

Eigen::Matrix4d ShadowMaps::texture_from_world(const Square& square) const {
  Eigen::Matrix4d to_unit = Eigen::Matrix4d::Identity() * 0.5;
  to_unit.topRightCorner<3, 1>().setConstant(0.5);
  to_unit(3, 3) = 1.0;
  return to_unit * clip_from_world(square);
}

void ShadowMaps::attach(GLuint framebuffer, GLuint texture, int layer) const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl_.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, texture, 0, layer);
  gl_.DrawBuffer(GL_NONE);
  gl_.ReadBuffer(GL_NONE);
}

void ShadowMaps::render(GLuint texture, int layer, const Square& square, bool near, bool clear,
                        const DrawCasters& draw) const {
  attach(framebuffer_, texture, layer);
  gl_.Viewport(0, 0, kSize, kSize);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  if (clear) gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(1.5f, 2.0f);
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(square.half_m);
  draw(clip_from_world(square), {square.centre_L - half, square.centre_L + half}, near);
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
}

void ShadowMaps::copy(int kept_layer, int shown_layer, const Rectangle& part) const {
  attach(source_framebuffer_, kept_, kept_layer);
  attach(framebuffer_, shown_, shown_layer);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, source_framebuffer_);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  gl_.BlitFramebuffer(part.x0, part.y0, part.x1, part.y1, part.x0, part.y0, part.x1, part.y1,
                      GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

/// Restores the static world in a shown layer.
void ShadowMaps::show(int kept_layer, int shown_layer) {
  if (shown_from_[shown_layer] == kept_layer) {
    for (const Rectangle& part : touched_[shown_layer]) copy(kept_layer, shown_layer, part);
  } else {
    copy(kept_layer, shown_layer, {0, 0, kSize, kSize});
    shown_from_[shown_layer] = kept_layer;
  }
  touched_[shown_layer].clear();
}

void ShadowMaps::update(const Eigen::Vector3d& focus_W, double radius_m,
                        const DrawCasters& draw_world, const DrawCasters& draw_vehicles,
                        const std::vector<Eigen::AlignedBox3d>& vehicles_W) {
  if (!far_is_drawn_) {
    render(kept_, 0, far_, false, true, draw_world);
    far_is_drawn_ = true;
  }
  // The near map: the smallest of a few sizes, on a grid of a quarter of its radius.
  double half = 12.0;
  while (half < radius_m) half *= 2.0;
  if (half >= 0.9 * far_.half_m) {
    near_ = far_;
  } else {
    const double grid = 0.25 * half;
    const Eigen::Vector3d focus_L = R_LW_ * focus_W;
    near_.half_m = half;
    near_.centre_L = {std::round(focus_L.x() / grid) * grid, std::round(focus_L.y() / grid) * grid};
  }
  int near_layer = 0;
  ++clock_;
  if (!(near_ == far_)) {
    auto slot = std::find(slots_.begin(), slots_.end(), near_);
    if (slot == slots_.end()) {
      slot = slots_.begin() + (std::min_element(used_.begin(), used_.end()) - used_.begin());
      *slot = near_;
      near_layer = 1 + static_cast<int>(slot - slots_.begin());
      render(kept_, near_layer, near_, true, true, draw_world);
      if (shown_from_[0] == near_layer) shown_from_[0] = -1;
    }
    near_layer = 1 + static_cast<int>(slot - slots_.begin());
    used_[near_layer - 1] = clock_;
  }
  show(near_layer, 0);
  show(0, 1);
  if (vehicles_W.empty()) return;
  for (int layer = 0; layer < 2; ++layer) {
    const Square& square = layer == 0 ? near_ : far_;
    const double texel = 2.0 * square.half_m / kSize;
    bool any = false;
    for (const Eigen::AlignedBox3d& box_W : vehicles_W) {
      Eigen::AlignedBox2d box_px;
      for (int i = 0; i < 8; ++i) {
        const Eigen::Vector3d corner_L =
            R_LW_ * box_W.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
        box_px.extend(Eigen::Vector2d((corner_L.head<2>() - square.centre_L) / texel +
                                      Eigen::Vector2d::Constant(0.5 * kSize)));
      }
      const auto limit = [](double v) {
        return static_cast<int>(std::clamp(v, 0.0, double{kSize}));
      };
      const Rectangle part = {
          limit(std::floor(box_px.min().x()) - 2), limit(std::floor(box_px.min().y()) - 2),
          limit(std::ceil(box_px.max().x()) + 2), limit(std::ceil(box_px.max().y()) + 2)};
      if (part.x0 >= part.x1 || part.y0 >= part.y1) continue;
      touched_[layer].push_back(part);
      any = true;
    }
    if (any) render(shown_, layer, square, layer == 0, false, draw_vehicles);
  }
}

}  // namespace vinerow::render

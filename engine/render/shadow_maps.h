#pragma once
/// Two shadow maps of the sun: one of the whole world, and a finer one around the view's focus.
///
/// World and sun do not move, so the maps of the static world are drawn once and kept. For each
/// frame, only vehicles are drawn into copies, and the touched areas are restored afterwards. The
/// near map is aligned to a fixed grid, so that a picture does not depend on earlier pictures.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <vector>

#include "engine/render/gl.h"

namespace vinerow::render {

class ShadowMaps {
 public:
  static constexpr int kSize = 2048;

  /// Draws objects that cast shadows. @param clip_from_world  of the light
  /// @param rectangle  of the map in light coordinates (see light_from_world), m
  using DrawCasters = std::function<void(const Eigen::Matrix4d& clip_from_world,
                                         const Eigen::AlignedBox2d& rectangle, bool near)>;

  /// @param sun_direction  unit, towards the sun
  /// @param casters_W  box around everything that can cast or receive a shadow
  ShadowMaps(const Gl& gl, const Eigen::Vector3d& sun_direction,
             const Eigen::AlignedBox3d& casters_W);

  /// Fills both maps for a view.
  /// @param focus_W   ground point in the middle of the view
  /// @param radius_m  requested radius of the near map
  /// @param vehicles_W  boxes around the objects that draw_vehicles draws
  void update(const Eigen::Vector3d& focus_W, double radius_m, const DrawCasters& draw_world,
              const DrawCasters& draw_vehicles, const std::vector<Eigen::AlignedBox3d>& vehicles_W);

  /// Rows: x and y across the light, z away from the sun.
  const Eigen::Matrix3d& light_from_world() const { return R_LW_; }
  Eigen::Matrix4d near_texture_from_world() const { return texture_from_world(near_); }
  Eigen::Matrix4d far_texture_from_world() const { return texture_from_world(far_); }
  double near_texel_m() const { return near_.half_m * 2.0 / kSize; }
  double far_texel_m() const { return far_.half_m * 2.0 / kSize; }
  GLuint texture() const { return shown_; }

 private:
  struct Square {
    Eigen::Vector2d centre_L = {0, 0};
    double half_m = 0.0;
    bool operator==(const Square&) const = default;
  };
  struct Rectangle {
    int x0, y0, x1, y1;
  };

  GLuint make_array(int layers) const;
  Eigen::Matrix4d clip_from_world(const Square& square) const;
  Eigen::Matrix4d texture_from_world(const Square& square) const;
  void attach(GLuint framebuffer, GLuint texture, int layer) const;
  void render(GLuint texture, int layer, const Square& square, bool near, bool clear,
              const DrawCasters& draw) const;
  void copy(int kept_layer, int shown_layer, const Rectangle& part) const;
  void show(int kept_layer, int shown_layer);

  static constexpr int kNearSlots = 3;
  const Gl& gl_;
  Eigen::Matrix3d R_LW_;
  double z_low_m_ = 0.0;
  double z_high_m_ = 1.0;
  Square far_;
  Square near_;
  bool far_is_drawn_ = false;
  GLuint kept_ = 0;   ///< layers: far, near slots
  GLuint shown_ = 0;  ///< layers: near, far; with vehicles
  GLuint framebuffer_ = 0;
  GLuint source_framebuffer_ = 0;
  std::array<Square, kNearSlots> slots_{};
  std::array<std::uint64_t, kNearSlots> used_{};
  std::uint64_t clock_ = 0;
  std::array<int, 2> shown_from_{-1, -1};
  std::array<std::vector<Rectangle>, 2> touched_;  ///< by vehicles, in each shown layer
};

}  // namespace vinerow::render

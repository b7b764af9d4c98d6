#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/render/annotations.h"
#include "engine/render/frame_block.h"
#include "engine/render/gl_renderer.h"
#include "engine/render/grass_tufts.h"
#include "engine/render/ribbons.h"
#include "engine/render/texture_units.h"

namespace vinerow::render {

namespace {

constexpr double kNear_m = 0.06;
constexpr double kFar_m = 9000.0;
constexpr double kHazePerMetre = 1.0 / 5200.0;

/// Visible level of a group in this frame.
struct Visible {
  const Drawable* drawable;
  double distance_m;
};

/// Largest distance of the terrain's vertices at which haze and the ground's slow noise are
/// interpolated between them. Waves shorter than two such distances are left out.
constexpr double kFineGround_m = 4.0;

/// Stencil values are bytes.
constexpr std::size_t kMaxMarked = 254;

Eigen::Matrix4d matrix_of(const Pose& X_WM) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = X_WM.q.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = X_WM.p;
  return matrix;
}

}  // namespace

double GlRenderer::ground_height_m(double x, double y) const {
  if (terrain_) return terrain_->height_m(x, y);
  Eigen::AlignedBox3d box;
  for (const Drawable& mesh : ground_meshes_) box.extend(mesh.box_W);
  return box.isEmpty() ? 0.0 : box.center().z();
}

void GlRenderer::draw_mesh(const GpuMesh& mesh) {
  gl_.BindVertexArray(mesh.vertex_array);
  gl_.DrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
  ++statistics_.draw_calls;
  statistics_.triangles += mesh.index_count / 3;
}

void GlRenderer::draw_drawable(const Program& program, const Drawable& drawable) {
  const Eigen::Matrix4f matrix = matrix_of(drawable.X_WM).cast<float>();
  gl_.UniformMatrix4fv(program.world_from_model, 1, GL_FALSE, matrix.data());
  const float* c = drawable.material.colour;
  if (program.material >= 0) gl_.Uniform4f(program.material, c[0], c[1], c[2], c[3]);
  if (program.thicken >= 0) {
    const bool wire = drawable.surface == SurfaceClass::kWire;
    gl_.Uniform1f(program.thicken, wire ? static_cast<float>(1.3 * half_pixel_rad_) : 0.0f);
  }
  if (program.texture_mode >= 0) {
    gl_.Uniform1f(program.texture_mode, static_cast<float>(drawable.material.texture_mode));
    if (drawable.material.image != 0) gl_.BindTexture(GL_TEXTURE_2D, drawable.material.image);
  }
  if (drawable.mesh->closed) {
    gl_.Enable(GL_CULL_FACE);
  } else {
    gl_.Disable(GL_CULL_FACE);
  }
  draw_mesh(*drawable.mesh);
}

void GlRenderer::cast_shadows(const std::vector<const Drawable*>& casters,
                              const Eigen::Matrix4d& clip_from_world) {
  gl_.Disable(GL_CULL_FACE);
  for (const bool cards : {false, true}) {
    const Program& program = cards ? shadow_cards_ : shadow_solid_;
    gl_.UseProgram(program.id);
    for (const Drawable* drawable : casters) {
      if (drawable->leaf_cards != cards) continue;
      const Eigen::Matrix4f matrix = (clip_from_world * matrix_of(drawable->X_WM)).cast<float>();
      gl_.UniformMatrix4fv(program.clip_from_model, 1, GL_FALSE, matrix.data());
      draw_mesh(*drawable->mesh);
    }
  }
}

void GlRenderer::update_shadows(const Camera& camera, const std::vector<Drawable>& vehicles) {
  const Eigen::Vector3d forward = camera.X_WC.q * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d& eye = camera.X_WC.p;
  const double above = std::max(0.3, eye.z() - ground_height_m(eye.x(), eye.y()));
  Eigen::Vector3d focus = eye;
  double radius = 0.0;
  if (camera.orthographic) {
    if (forward.z() < -0.05) focus += forward * (above / -forward.z());
    radius = 0.9 * camera.ortho_height_m;
  } else {
    const double reach =
        std::min(above / std::max(-forward.z(), 0.05), std::max(25.0, 2.5 * above));
    radius = 0.8 * reach + 0.5 * above;
    Eigen::Vector3d ahead(forward.x(), forward.y(), 0.0);
    focus += ahead * std::max(reach, 7.0);
  }
  focus.z() = ground_height_m(focus.x(), focus.y());

  const Eigen::Matrix3d& R_LW = shadows_->light_from_world();
  const auto overlaps = [&](const Eigen::AlignedBox3d& box_W,
                            const Eigen::AlignedBox2d& rectangle) {
    Eigen::AlignedBox2d box_L;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d p =
          R_LW * box_W.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
      box_L.extend(Eigen::Vector2d(p.head<2>()));
    }
    return box_L.intersects(rectangle);
  };
  const ShadowMaps::DrawCasters draw_world = [&](const Eigen::Matrix4d& clip_from_world,
                                                 const Eigen::AlignedBox2d& rectangle, bool near) {
    std::vector<const Drawable*> casters;
    for (std::size_t i = 0; i < first_tree_; ++i) {
      const LodGroup& group = groups_[i];
      // Always the same level: shadows of leaves look alike at any level of detail.
      const std::size_t level = std::min<std::size_t>(group.levels.size() - 1, near ? 1 : 2);
      const Drawable& drawable = group.levels[level];
      if (drawable.surface == SurfaceClass::kWire && !near) continue;
      if (overlaps(drawable.box_W, rectangle)) casters.push_back(&drawable);
    }
    cast_shadows(casters, clip_from_world);
  };
  const ShadowMaps::DrawCasters draw_vehicles = [&](const Eigen::Matrix4d& clip_from_world,
                                                    const Eigen::AlignedBox2d&, bool) {
    std::vector<const Drawable*> casters;
    for (const Drawable& link : vehicles) casters.push_back(&link);
    cast_shadows(casters, clip_from_world);
  };
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Drawable& link : vehicles) boxes.push_back(link.box_W);
  shadows_->update(focus, radius, draw_world, draw_vehicles, boxes);
}

void GlRenderer::upload_frame_block(const Frame& frame, const SamplePattern& pattern,
                                    const Eigen::Matrix4d& clip_from_world) {
  FrameBlock block{};
  const Camera& camera = frame.camera;
  store(block.clip_from_world, clip_from_world);
  store(block.world_from_clip, clip_from_world.inverse());
  if (shadows_) {
    store(block.near_from_world, shadows_->near_texture_from_world());
    store(block.far_from_world, shadows_->far_texture_from_world());
    block.shadow_info[0] = static_cast<float>(shadows_->near_texel_m());
    block.shadow_info[1] = static_cast<float>(shadows_->far_texel_m());
    block.shadow_info[2] = 1.0f;
  }
  const auto haze = [](const Eigen::Vector3f& radiance) {
    return Eigen::Vector3d(radiance.cast<double>());
  };
  store(block.eye, camera.X_WC.p, camera.orthographic ? 0.0 : 1.0);
  store(block.forward, camera.X_WC.q * Eigen::Vector3d::UnitZ());
  store(block.sun_direction, light_.sun_direction_W);
  store(block.sun_irradiance, light_.sun_irradiance, light_.exposure);
  store(block.sky_irradiance, light_.sky_irradiance);
  store(block.ground_irradiance, light_.ground_irradiance);
  store(block.haze_to_sun, haze(light_.atmosphere.horizon_to_sun),
        camera.orthographic ? 0.0 : kHazePerMetre);
  store(block.haze_from_sun, haze(light_.atmosphere.horizon_from_sun));
  block.mask_rect[0] = static_cast<float>(mask_.corner_W.x());
  block.mask_rect[1] = static_cast<float>(mask_.corner_W.y());
  block.mask_rect[2] = static_cast<float>(1.0 / mask_.size_m.x());
  block.mask_rect[3] = static_cast<float>(1.0 / mask_.size_m.y());
  std::copy_n(land_rect_.data(), 4, block.land_rect);
  store(block.soil_look, look_.soil_tint.cast<double>(), look_.bare);
  store(block.grass_look, {look_.grass_brightness, look_.grass_dryness, 0.0});
  const Eigen::Matrix4d drawn_from_clip = pattern.drawn_from_clip();
  block.sampling[0] = static_cast<float>(pattern.lod_bias());
  block.sampling[1] = static_cast<float>(drawn_from_clip(0, 0));
  block.sampling[2] = static_cast<float>(drawn_from_clip(0, 1));
  block.sampling[3] = static_cast<float>(drawn_from_clip(1, 1));
  gl_.BindBuffer(GL_UNIFORM_BUFFER, frame_buffer_);
  gl_.BufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer_);
}

void GlRenderer::draw_objects(const Frame& frame, const Frustum& frustum,
                              const std::vector<Drawable>& links) {
  std::vector<Visible> solid;
  std::vector<Visible> cards;
  for (const LodGroup& group : groups_) {
    if (settings_.cull && !frustum.may_see(group.box_W)) continue;
    const double seen = calc_seen_distance(frame.camera, frame.height, group.box_W);
    const Drawable& drawable = group.levels[pick_lod(seen, static_cast<int>(group.levels.size()))];
    if (!is_drawn_at(drawable.surface, seen)) continue;
    (drawable.leaf_cards ? cards : solid).push_back({&drawable, seen});
  }
  for (const Drawable& link : links) {
    if (settings_.cull && !frustum.may_see(link.box_W)) continue;
    (link.leaf_cards ? cards : solid)
        .push_back({&link, calc_seen_distance(frame.camera, frame.height, link.box_W)});
  }
  // Near objects first: objects hidden by them need not be shaded.
  const auto nearer = [](const Visible& a, const Visible& b) {
    return a.distance_m < b.distance_m;
  };
  std::stable_sort(solid.begin(), solid.end(), nearer);
  std::stable_sort(cards.begin(), cards.end(), nearer);
  const auto draw_all = [this](const Program& program, const std::vector<Visible>& things) {
    gl_.UseProgram(program.id);
    for (const Visible& visible : things) draw_drawable(program, *visible.drawable);
  };
  // Leaves and grass overlap many times: draw what their light depends on, then light the visible
  // ones.
  make_tufts(frame, frustum);
  target_.begin_foliage();
  draw_all(foliage_, cards);
  if (!grid_on_ground_) draw_tufts(grass_);
  target_.resume();
  light_foliage();
  draw_all(surface_, solid);
  if (grid_on_ground_) {
    gl_.UseProgram(grid_grass_.id);
    grid_.set_place(grid_grass_.grid_rect, grid_grass_.grid_size);
    draw_tufts(grid_grass_);
  }
}

void GlRenderer::draw_everywhere(const Program& program) {
  gl_.UseProgram(program.id);
  gl_.Disable(GL_CULL_FACE);
  gl_.BindVertexArray(empty_array_);
  gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  ++statistics_.draw_calls;
}

void GlRenderer::light_foliage() {
  // At the largest depth there is, so that it passes where anything has been drawn. The shader
  // reads the depth buffer against which it is tested, which nothing writes meanwhile.
  gl_.DepthFunc(GL_GREATER);
  gl_.DepthMask(GL_FALSE);
  draw_everywhere(foliage_light_);
  gl_.DepthFunc(GL_LEQUAL);
  gl_.DepthMask(GL_TRUE);
}

void GlRenderer::mark_vehicles(const std::vector<Drawable>& links,
                               const std::vector<int>& vehicle_of_link) {
  // A second time instead of while drawing: with the stencil on, llvmpipe tests the depth of
  // leaves and grass after shading them.
  gl_.Enable(GL_STENCIL_TEST);
  gl_.StencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl_.DepthFunc(GL_EQUAL);
  gl_.DepthMask(GL_FALSE);
  for (const bool cards : {false, true}) {
    const Program& program = cards ? foliage_ : surface_;
    gl_.UseProgram(program.id);
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (links[i].leaf_cards != cards) continue;
      gl_.StencilFunc(GL_ALWAYS, vehicle_of_link[i] + 1, 0xff);
      draw_drawable(program, links[i]);
    }
  }
  gl_.DepthFunc(GL_LEQUAL);
  gl_.DepthMask(GL_TRUE);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.Disable(GL_STENCIL_TEST);
}

void GlRenderer::make_tufts(const Frame& frame, const Frustum& frustum) {
  tuft_indices_.clear();
  if (!terrain_ || !settings_.grass_tufts) return;
  const double seen_scale =
      2.0 * std::tan(0.5 * frame.camera.fov_rad) / frame.height / (2.0 * std::tan(0.48) / 720.0);
  make_grass_tufts({*terrain_, mask_, tracks_, look_.bare}, frame.camera, frustum, seen_scale,
                   tuft_vertices_, tuft_indices_);
  if (tuft_indices_.empty()) return;
  fill_vertices(gl_, tufts_, tuft_vertices_, GL_STREAM_DRAW);
  fill_indices(gl_, tufts_, tuft_indices_, GL_STREAM_DRAW);
}

void GlRenderer::draw_tufts(const Program& program) {
  if (tuft_indices_.empty()) return;
  gl_.UseProgram(program.id);
  gl_.Disable(GL_CULL_FACE);
  draw_mesh(tufts_);
}

void GlRenderer::draw_ground(const Frame& frame, const Frustum& frustum,
                             const SamplePattern& pattern, const Eigen::Matrix4d& clip_from_world) {
  if (grid_on_ground_) {
    draw_ground(frame, frustum, {grid_ground_, grid_ground_, grid_ground_, country_});
    return;
  }
  const GroundPrograms programs{ground_, fine_ground_, ground_, country_};
  if (!pattern.staggered()) {
    draw_ground(frame, frustum, programs);
    return;
  }
  // Its colours change little from sample to sample and cost most of all: they are computed once a
  // pixel, where its middle shows the ground.
  target_.begin_ground();
  // Replaces all depths, which are of the last frame.
  gl_.DepthFunc(GL_ALWAYS);
  draw_everywhere(ground_gaps_);
  gl_.DepthFunc(GL_LEQUAL);
  upload_frame_block(frame, pattern.middles(), clip_from_world);
  draw_ground(frame, frustum, programs);
  target_.resume();
  upload_frame_block(frame, pattern, pattern.drawn_from_clip() * clip_from_world);
  draw_ground(frame, frustum, {ground_seen_, ground_seen_, ground_seen_, ground_seen_});
}

void GlRenderer::draw_ground(const Frame& frame, const Frustum& frustum,
                             const GroundPrograms& programs) {
  gl_.Disable(GL_CULL_FACE);
  const Eigen::Matrix4f identity = Eigen::Matrix4f::Identity();
  const auto use = [&](const Program& program) {
    gl_.UseProgram(program.id);
    if (program.grid_rect >= 0) grid_.set_place(program.grid_rect, program.grid_size);
    gl_.UniformMatrix4fv(program.world_from_model, 1, GL_FALSE, identity.data());
  };
  use(programs.meshes);
  for (const Drawable& mesh : ground_meshes_) {
    if (!settings_.cull || frustum.may_see(mesh.box_W)) draw_drawable(programs.meshes, mesh);
  }
  use(programs.coarse);
  use(programs.fine);
  gl_.Disable(GL_CULL_FACE);
  for (const GpuMesh& chunk : chunks_) {
    if (settings_.cull && !frustum.may_see(chunk.bounds_M)) continue;
    const double seen = calc_seen_distance(frame.camera, frame.height, chunk.bounds_M);
    const int level = pick_terrain_level(seen, terrain_->cell_m);
    const double cell_m = terrain_->cell_m * (1 << level);
    if (cell_m <= kFineGround_m) {
      gl_.UseProgram(programs.fine.id);
      if (programs.fine.cell_octave >= 0) {
        gl_.Uniform1f(programs.fine.cell_octave, static_cast<float>(std::log2(cell_m)));
      }
    } else {
      gl_.UseProgram(programs.coarse.id);
    }
    const GpuMesh& indices = chunk_indices_[level];
    gl_.BindVertexArray(chunk.vertex_array);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.index_buffer);
    gl_.DrawElements(GL_TRIANGLES, indices.index_count, GL_UNSIGNED_INT, nullptr);
    ++statistics_.draw_calls;
    statistics_.triangles += indices.index_count / 3;
  }
  use(programs.country);
  for (const GpuMesh& sector : surroundings_) {
    if (!settings_.cull || frustum.may_see(sector.bounds_M)) draw_mesh(sector);
  }
}

void GlRenderer::draw_sky(const Frame& frame, const SamplePattern& pattern,
                          const Eigen::Matrix4d& clip_from_world) {
  const auto draw = [this](const Program& program) {
    gl_.UseProgram(program.id);
    gl_.Disable(GL_CULL_FACE);
    gl_.BindVertexArray(empty_array_);
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  };
  target_.begin_sky();
  upload_frame_block(frame, pattern.middles(), clip_from_world);
  gl_.Disable(GL_DEPTH_TEST);
  draw(sky_);
  gl_.Enable(GL_DEPTH_TEST);
  target_.resume();
  upload_frame_block(frame, pattern, pattern.drawn_from_clip() * clip_from_world);
  draw(sky_seen_);
}

void GlRenderer::prepare_grid(const Frame& frame) {
  grid_on_ground_ = frame.grid != nullptr && !is_map_view(frame.camera);
  if (frame.grid == nullptr) return;
  if (grid_map_.id == 0) {
    grid_map_ = make_program("grid_map", shaders::grid_map());
    grid_ground_ = make_program("grid_ground", shaders::ground(true, has_land_));
    grid_grass_ = make_program("grid_grass", shaders::grass_on_grid());
  }
  grid_.show(frame.grid);
  gl_.ActiveTexture(GL_TEXTURE0 + kUnitImage);
}

void GlRenderer::draw_grid_map() {
  gl_.UseProgram(grid_map_.id);
  grid_.set_place(grid_map_.grid_rect, grid_map_.grid_size);
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Enable(GL_BLEND);
  gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl_.BindVertexArray(empty_array_);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  ++statistics_.draw_calls;
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
}

void GlRenderer::draw_ribbon(const std::vector<RibbonVertex>& vertices) {
  gl_.BindBuffer(GL_ARRAY_BUFFER, ribbon_buffer_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(RibbonVertex)),
                 vertices.data(), GL_STREAM_DRAW);
  gl_.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
  ++statistics_.draw_calls;
  statistics_.triangles += static_cast<std::int64_t>(vertices.size() / 3);
}

void GlRenderer::cover_unused(const SamplePattern& pattern) {
  // The triangle left of the picture, and its mirror image through the middle. Two drawn pixels
  // stay between them and the picture.
  const Eigen::Matrix4d drawn_from_clip = pattern.drawn_from_clip();
  const double gap = 4.0 / pattern.columns();
  const Eigen::Vector4d lower = drawn_from_clip * Eigen::Vector4d(-1, -1, 0, 1);
  const Eigen::Vector4d upper = drawn_from_clip * Eigen::Vector4d(-1, 1, 0, 1);
  const Eigen::Vector2d corners[] = {
      {lower.x() - gap, -1.0}, {upper.x() - gap, 1.0}, {upper.x() - gap, -1.0}};
  std::vector<RibbonVertex> vertices;
  for (const float side : {1.0f, -1.0f}) {
    for (const Eigen::Vector2d& corner : corners) {
      RibbonVertex vertex{};
      vertex.clip[0] = side * static_cast<float>(corner.x());
      vertex.clip[1] = side * static_cast<float>(corner.y());
      vertex.clip[2] = -1.0f;  // nearer than everything
      vertex.clip[3] = 1.0f;
      vertex.along_px = -1.0f;
      vertices.push_back(vertex);
    }
  }
  gl_.UseProgram(ribbon_.id);
  gl_.Disable(GL_CULL_FACE);
  gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl_.BindVertexArray(ribbon_array_);
  draw_ribbon(vertices);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void GlRenderer::draw_lines(const Frame& frame, const SamplePattern& pattern,
                            const Eigen::Matrix4d& clip_from_world) {
  gl_.UseProgram(ribbon_.id);
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_BLEND);
  gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl_.DepthMask(GL_FALSE);
  // The stencil prevents a line from being blended twice at joints and crossings.
  gl_.Enable(GL_STENCIL_TEST);
  gl_.StencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  gl_.BindVertexArray(ribbon_array_);
  GLint number = 0;
  for (const Polyline& line : frame.lines) {
    std::vector<RibbonVertex> vertices =
        make_ribbon(line, terrain_ ? &*terrain_ : nullptr, clip_from_world, frame.camera,
                    frame.width, frame.height);
    if (vertices.empty()) continue;
    transform(vertices, pattern.drawn_from_clip());
    number = number % 255 + 1;
    gl_.StencilFunc(GL_NOTEQUAL, number, 0xff);
    draw_ribbon(vertices);
    if (line.hidden_alpha <= 0.0f) continue;
    // The visible part of a line has priority where it crosses a hidden part of the same line: same
    // number.
    set_alpha(vertices, line.hidden_alpha);
    gl_.DepthFunc(GL_GREATER);
    draw_ribbon(vertices);
    gl_.DepthFunc(GL_LEQUAL);
  }
  gl_.Disable(GL_STENCIL_TEST);
  gl_.Disable(GL_BLEND);
  gl_.DepthMask(GL_TRUE);
}

Image GlRenderer::draw(const Frame& frame) {
  if (frame.width < 1 || frame.height < 1 || frame.width > 8192 || frame.height > 8192) {
    throw std::runtime_error(
        fmt::format("a picture of {} x {} pixels cannot be drawn: each side is 1 to 8192",
                    frame.width, frame.height));
  }
  context_->make_current();
  statistics_ = {};
  std::vector<Drawable> vehicles;
  std::vector<int> vehicle_of_link;
  for (std::size_t v = 0; v < frame.vehicles.size(); ++v) {
    const VehicleDrawing& drawing = frame.vehicles[v];
    if (drawing.links == nullptr) continue;
    const std::size_t count = std::min(drawing.links->size(), drawing.X_WL.size());
    for (std::size_t i = 0; i < count; ++i) {
      const VehicleLink& link = (*drawing.links)[i];
      if (!link.mesh || link.mesh->triangles.empty()) continue;
      vehicles.push_back(
          store_.make_drawable(link.mesh, drawing.X_WL[i], SurfaceClass::kVehicle, link.material));
      vehicle_of_link.push_back(static_cast<int>(std::min(v, kMaxMarked)));
    }
  }
  const SamplePattern pattern(frame.width, frame.height, frame.samples);
  half_pixel_rad_ = frame.camera.orthographic ? 0.0
                                              : std::tan(0.5 * frame.camera.fov_rad) /
                                                    frame.height * pattern.spacing_px();
  const double aspect = double{1} * frame.width / frame.height;
  const double near_m = frame.camera.orthographic ? 0.1 : kNear_m;
  const double far_m = frame.camera.orthographic ? 3000.0 : kFar_m;
  const Eigen::Matrix4d clip_from_world = calc_clip_from_world(frame.camera, aspect, near_m, far_m);
  const Frustum frustum(clip_from_world);

  gl_.FrontFace(GL_CCW);
  gl_.CullFace(GL_BACK);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LEQUAL);
  prepare_grid(frame);
  if (shadows_) update_shadows(frame.camera, vehicles);
  upload_frame_block(frame, pattern, pattern.drawn_from_clip() * clip_from_world);
  target_.begin(pattern);
  if (pattern.staggered()) cover_unused(pattern);
  draw_objects(frame, frustum, vehicles);
  draw_hedges(frame.camera, frustum);
  draw_ground(frame, frustum, pattern, clip_from_world);
  draw_sky(frame, pattern, clip_from_world);
  mark_vehicles(vehicles, vehicle_of_link);
  const std::vector<SeenMark> seen =
      target_.take_marks(std::min(frame.vehicles.size(), kMaxMarked));
  for (const SeenMark& mark : seen) statistics_.vehicle_shares.push_back(mark.share);
  if (frame.grid != nullptr && !grid_on_ground_) draw_grid_map();
  draw_lines(frame, pattern, clip_from_world);
  Image image = target_.read();
  check_gl(gl_, "drawing a frame");
  annotate(frame, seen, image);
  return image;
}

}  // namespace vinerow::render

#pragma once
/// OpenGL renderer, the implementation behind make_renderer(). gl_renderer_world.cpp uploads the
/// world, gl_renderer_frame.cpp draws frames.

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "engine/imaging/daylight.h"
#include "engine/imaging/ground_look.h"
#include "engine/imaging/ground_mask.h"
#include "engine/render/drawables.h"
#include "engine/render/frame_target.h"
#include "engine/render/grid_overlay.h"
#include "engine/render/land_use.h"
#include "engine/render/offscreen_context.h"
#include "engine/render/ribbons.h"
#include "engine/render/shaders.h"
#include "engine/render/shadow_maps.h"
#include "engine/render/terrain_mesh.h"

namespace vinerow::render {

/// Linked program and the locations of its uniforms (-1: no such uniform).
struct Program {
  GLuint id = 0;
  GLint world_from_model = -1;
  GLint clip_from_model = -1;
  GLint material = -1;
  GLint texture_mode = -1;
  GLint thicken = -1;
  GLint cell_octave = -1;
  GLint grid_rect = -1;
  GLint grid_size = -1;
};

class GlRenderer final : public Renderer {
 public:
  GlRenderer(std::unique_ptr<OffscreenContext> context, const WorldModel& world,
             const RendererSettings& settings);
  Image draw(const Frame& frame) override;
  FrameStatistics statistics() const override { return statistics_; }

 private:
  Program make_program(const char* name, const shaders::Pair& sources) const;
  void make_programs(const Scenery& scenery);
  void make_textures();
  void make_terrain(const WorldModel& world);
  void make_shadows();
  void make_scenery(const Scenery& scenery);
  void upload_land_use(const LandUse& land);
  void add_trees(const Scenery& scenery);

  void update_shadows(const Camera& camera, const std::vector<Drawable>& vehicles);
  void cast_shadows(const std::vector<const Drawable*>& casters,
                    const Eigen::Matrix4d& clip_from_world);
  /// @param clip_from_world  of the drawn pixels
  void upload_frame_block(const Frame& frame, const SamplePattern& pattern,
                          const Eigen::Matrix4d& clip_from_world);
  /// Sets the depth of drawn pixels outside the picture so that nothing is drawn there.
  void cover_unused(const SamplePattern& pattern);
  void draw_objects(const Frame& frame, const Frustum& frustum, const std::vector<Drawable>& links);
  /// Colours of the leaves, which must be all that has been drawn so far.
  void light_foliage();
  /// Sets the stencil of the visible parts of vehicles to their numbers, from 1, and leaves 0
  /// elsewhere.
  void mark_vehicles(const std::vector<Drawable>& links, const std::vector<int>& vehicle_of_link);
  /// Draws the four corners that a program makes of gl_VertexID.
  void draw_everywhere(const Program& program);
  /// The ground, by the way that fits the pattern.
  void draw_ground(const Frame& frame, const Frustum& frustum, const SamplePattern& pattern,
                   const Eigen::Matrix4d& clip_from_world);
  /// Programs that draw the ground.
  struct GroundPrograms {
    const Program &meshes, &fine, &coarse, &country;
  };
  void draw_ground(const Frame& frame, const Frustum& frustum, const GroundPrograms& programs);
  void make_tufts(const Frame& frame, const Frustum& frustum);
  void draw_tufts(const Program& program);
  void draw_hedges(const Camera& camera, const Frustum& frustum);
  void draw_sky(const Frame& frame, const SamplePattern& pattern,
                const Eigen::Matrix4d& clip_from_world);
  /// Prepares the texture and programs of the frame's grid; they are created for the first frame
  /// with a grid.
  void prepare_grid(const Frame& frame);
  void draw_grid_map();
  void draw_ribbon(const std::vector<RibbonVertex>& vertices);
  void draw_lines(const Frame& frame, const SamplePattern& pattern,
                  const Eigen::Matrix4d& clip_from_world);
  void draw_drawable(const Program& program, const Drawable& drawable);
  void draw_mesh(const GpuMesh& mesh);
  double ground_height_m(double x, double y) const;

  std::unique_ptr<OffscreenContext> context_;
  const RendererSettings settings_;
  Gl gl_;
  imaging::SceneLight light_;
  imaging::GroundMask mask_;
  imaging::GroundLook look_;
  std::vector<SceneryTrack> tracks_;
  std::optional<HeightField> terrain_;
  DrawableStore store_;
  FrameTarget target_;
  std::vector<LodGroup> groups_;         ///< all except ground; the scenery's trees are last
  std::size_t first_tree_ = 0;           ///< shadows of groups from this index on are in LandUse
  std::vector<Drawable> ground_meshes_;  ///< meshes of class kTerrain
  std::vector<GpuMesh> chunks_;
  std::array<GpuMesh, kTerrainLevels> chunk_indices_;
  std::vector<GpuMesh> surroundings_;
  std::vector<GpuMesh> hedges_, stems_;  ///< one per field of the scenery
  Eigen::Vector4f land_rect_ = {0, 0, 0, 0};
  bool has_land_ = false;
  std::unique_ptr<ShadowMaps> shadows_;
  Program sky_, sky_seen_, ground_, fine_ground_, country_, ground_gaps_, ground_seen_, surface_,
      foliage_, foliage_light_, grass_, ribbon_, shadow_solid_, shadow_cards_;
  GridOverlay grid_;
  Program hedge_, stem_;
  Program grid_map_, grid_ground_, grid_grass_;  ///< made by prepare_grid
  bool grid_on_ground_ = false;                  ///< in this frame
  GLuint frame_buffer_ = 0;
  GLuint empty_array_ = 0;
  GpuMesh tufts_;
  std::vector<GpuVertex> tuft_vertices_;
  std::vector<std::uint32_t> tuft_indices_;
  GLuint ribbon_array_ = 0;
  GLuint ribbon_buffer_ = 0;
  double half_pixel_rad_ = 0.0;  ///< half the distance of drawn pixels, in this frame
  FrameStatistics statistics_;
};

}  // namespace vinerow::render

#include <cstddef>
#include <stdexcept>
#include <utility>

#include "engine/api/map.h"
#include "engine/render/builtin_textures.h"
#include "engine/render/gl_renderer.h"
#include "engine/render/ribbons.h"
#include "engine/render/texture_units.h"

namespace vinerow::render {

GlRenderer::GlRenderer(std::unique_ptr<OffscreenContext> context, const WorldModel& world,
                       const RendererSettings& settings)
    : context_(std::move(context)),
      settings_(settings),
      gl_(load_gl([this](const char* name) { return context_->find_function(name); })),
      light_(imaging::make_light(world.daylight)),
      mask_(imaging::make_ground_mask(world.rows)),
      look_(imaging::look_of(world.soil)),
      tracks_(world.scenery.tracks),
      terrain_(world.terrain),
      store_(gl_),
      target_(gl_),
      grid_(gl_) {
  make_programs(world.scenery);
  gl_.GenBuffers(1, &frame_buffer_);
  gl_.GenVertexArrays(1, &empty_array_);
  tufts_ = make_gpu_mesh(gl_);
  make_textures();
  std::vector<MeshInstance> objects;
  for (const MeshInstance& instance : world.meshes) {
    if (instance.surface != SurfaceClass::kTerrain) {
      objects.push_back(instance);
    } else if (instance.visible && instance.mesh) {
      ground_meshes_.push_back(
          store_.make_drawable(instance.mesh, instance.X_WM, instance.surface, instance.material));
    }
  }
  groups_ = store_.make_groups(objects);
  first_tree_ = groups_.size();
  make_terrain(world);
  if (settings_.shadows) make_shadows();
  make_scenery(world.scenery);

  gl_.GenVertexArrays(1, &ribbon_array_);
  gl_.GenBuffers(1, &ribbon_buffer_);
  gl_.BindVertexArray(ribbon_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, ribbon_buffer_);
  const auto attribute = [&](GLuint place, GLint size, GLenum type, GLboolean unit,
                             std::size_t at) {
    gl_.EnableVertexAttribArray(place);
    gl_.VertexAttribPointer(place, size, type, unit, sizeof(RibbonVertex),
                            reinterpret_cast<const void*>(at));
  };
  attribute(0, 4, GL_FLOAT, GL_FALSE, offsetof(RibbonVertex, clip));
  attribute(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(RibbonVertex, colour));
  attribute(2, 1, GL_FLOAT, GL_FALSE, offsetof(RibbonVertex, along_px));
  gl_.BindVertexArray(0);
  check_gl(gl_, "uploading the world");
}

Program GlRenderer::make_program(const char* name, const shaders::Pair& sources) const {
  Program program;
  program.id = build_program(gl_, name, sources.vertex, sources.fragment);
  const auto place = [&](const char* uniform) {
    return gl_.GetUniformLocation(program.id, uniform);
  };
  program.world_from_model = place("world_from_model");
  program.clip_from_model = place("clip_from_model");
  program.material = place("material");
  program.texture_mode = place("texture_mode");
  program.thicken = place("thicken");
  program.cell_octave = place("cell_octave");
  program.grid_rect = place("grid_rect");
  program.grid_size = place("grid_size");
  return program;
}

void GlRenderer::make_programs(const Scenery& scenery) {
  sky_ = make_program("sky", shaders::sky());
  sky_seen_ = make_program("sky_seen", shaders::sky_seen());
  has_land_ = !scenery.empty() && terrain_;
  ground_ = make_program("ground", shaders::ground(false, has_land_));
  fine_ground_ = make_program("fine_ground", shaders::ground(false, has_land_, true));
  country_ = make_program("country", shaders::country());
  ground_gaps_ = make_program("ground_gaps", shaders::ground_gaps());
  ground_seen_ = make_program("ground_seen", shaders::ground_seen());
  surface_ = make_program("surface", shaders::surface());
  foliage_ = make_program("foliage", shaders::foliage());
  foliage_light_ = make_program("foliage_light", shaders::foliage_light());
  grass_ = make_program("grass", shaders::grass());
  ribbon_ = make_program("ribbon", shaders::ribbon());
  shadow_solid_ = make_program("shadow_solid", shaders::shadow_solid());
  shadow_cards_ = make_program("shadow_cards", shaders::shadow_cards());
}

void GlRenderer::make_textures() {
  const auto unit = [&](TextureUnit u) { gl_.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(u)); };
  unit(kUnitNoise);
  upload_texture(gl_, imaging::mip_chain(noise_texture()), false);
  unit(kUnitGround);
  upload_texture(gl_, imaging::mip_chain(ground_texture()), false);
  // Its levels are read where a texel is about as large as a drawn pixel: reading one instead of
  // four saves 5 % of a picture, whose error against 64 samples grows by 2 %.
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
  unit(kUnitMask);
  upload_texture(gl_, imaging::mip_chain(mask_.pixels), true);
  unit(kUnitLeaves);
  std::vector<std::vector<imaging::Pixels>> layers;
  for (int layer = 0; layer < kCardLayers; ++layer) {
    layers.push_back(imaging::mip_chain_with_coverage(card_texture(layer)));
  }
  upload_texture_array(gl_, layers);

  unit(kUnitSky);
  GLuint sky = 0;
  gl_.GenTextures(1, &sky);
  gl_.BindTexture(GL_TEXTURE_2D, sky);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, imaging::Atmosphere::kAzimuths,
                 imaging::Atmosphere::kElevations, 0, GL_RGB, GL_FLOAT,
                 light_.atmosphere.sky.data());
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  unit(kUnitImage);
}

void GlRenderer::make_terrain(const WorldModel& world) {
  Eigen::AlignedBox2d rectangle;
  double level_height_m = 0.0;
  if (terrain_) {
    const int columns = (terrain_->columns - 2) / kChunkCells + 1;
    const int rows = (terrain_->rows - 2) / kChunkCells + 1;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        chunks_.push_back(upload_mesh(gl_, make_terrain_chunk(*terrain_, column, row)));
      }
    }
    for (int level = 0; level < kTerrainLevels; ++level) {
      gl_.GenBuffers(1, &chunk_indices_[level].index_buffer);
      fill_indices(gl_, chunk_indices_[level], make_chunk_indices(level), GL_STATIC_DRAW);
    }
    rectangle.extend(terrain_->corner_W);
    rectangle.extend(terrain_->corner_W +
                     Eigen::Vector2d(terrain_->width_m(), terrain_->depth_m()));
  } else if (!ground_meshes_.empty()) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const MeshInstance& instance : world.meshes) {
      if (instance.surface != SurfaceClass::kTerrain || !instance.mesh) continue;
      for (const Eigen::Vector3f& v : instance.mesh->vertices) {
        const Eigen::Vector3d p = instance.X_WM * v.cast<double>();
        rectangle.extend(Eigen::Vector2d(p.head<2>()));
        sum += p.z();
        ++count;
      }
    }
    level_height_m = count > 0 ? sum / static_cast<double>(count) : 0.0;
  }
  if (rectangle.isEmpty() || !settings_.distant_hills) return;
  for (const PreparedMesh& sector :
       make_surroundings(rectangle, terrain_ ? &*terrain_ : nullptr, level_height_m)) {
    surroundings_.push_back(upload_mesh(gl_, sector));
  }
}

void GlRenderer::make_shadows() {
  Eigen::AlignedBox3d casters;
  for (const LodGroup& group : groups_) casters.extend(group.box_W);
  // Vehicles also cast shadows on open ground, as far as the map is fine enough.
  Eigen::AlignedBox3d ground;
  for (const GpuMesh& chunk : chunks_) ground.extend(chunk.bounds_M);
  for (const Drawable& mesh : ground_meshes_) ground.extend(mesh.box_W);
  if (casters.isEmpty()) casters = ground;
  if (casters.isEmpty()) casters = {Eigen::Vector3d(-30, -30, -5), Eigen::Vector3d(30, 30, 10)};
  if (!ground.isEmpty()) {
    Eigen::AlignedBox3d reach = casters;
    reach.min().head<2>().array() -= 30.0;
    reach.max().head<2>().array() += 30.0;
    reach.min().z() = std::min(reach.min().z(), ground.min().z());
    reach.max().z() = std::max(reach.max().z(), ground.max().z());
    casters = reach;
  }
  casters.max().z() += 3.0;
  shadows_ = std::make_unique<ShadowMaps>(gl_, light_.sun_direction_W, casters);
  gl_.ActiveTexture(GL_TEXTURE0 + kUnitShadow);
  gl_.BindTexture(GL_TEXTURE_2D_ARRAY, shadows_->texture());
  gl_.ActiveTexture(GL_TEXTURE0 + kUnitImage);
}

Result<std::unique_ptr<Renderer>> make_renderer(const WorldModel& world,
                                                const RendererSettings& settings) {
  Result<std::unique_ptr<OffscreenContext>> context = make_osmesa_context();
  if (!context) return Failure{context.reason()};
  try {
    std::unique_ptr<OffscreenContext> current = std::move(context).value();
    current->make_current();
    return std::unique_ptr<Renderer>(
        std::make_unique<GlRenderer>(std::move(current), world, settings));
  } catch (const std::runtime_error& error) {
    return Failure{error.what()};
  }
}

}  // namespace vinerow::render

#pragma once
/// What a picture shows, as plain data: the world, the vehicles' links, and lines drawn over it.
///
/// How meshes become pictures (the agreement with worlds/ and vehicles/):
/// - Names that differ only in a suffix "#lod0", "#lod1", "#lod2" are alternatives of one thing;
/// the
///   nearest gets #lod0. kWire, kTrunk and kPost are left out one after the other with distance.
/// - Instances that share a TriangleMesh pointer share one vertex buffer. Keep canopy chunks at
/// about
///   4-8 m of row, so that culling and levels of detail can do their work.
/// - A mesh without normals gets them with a crease angle of 40 deg. Closed meshes are drawn
///   one-sided, open ones two-sided.
/// - Material.leaf_cards: quads (or any pieces that share vertices), uv 0..1 over each card with
/// the
///   stem at v = 0, normals of the canopy's volume more than of the card (soft shading). Vertex
///   colours are the leaves' linear RGB (times Material.colour), darker inside; without them leaves
///   are green. The renderer chooses a picture by the card's edge length: one leaf below 0.22 m, a
///   spray of a dozen leaves up to 0.7 m, a clump of sixty above.
/// - Material.texture: "builtin:vine_leaf", "builtin:tree_leaf" (both need leaf_cards),
///   "builtin:wood", "builtin:bark" (grain along the mesh's z axis, no uvs needed), or a PNG file
///   with uvs (row 0 of the image at v = 1). What cannot be read is drawn in Material.colour.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/vehicle.h"
#include "engine/core/result.h"

namespace vinerow::render {

/// A vehicle at one instant.
struct VehicleDrawing {
  const std::vector<VehicleLink>* links = nullptr;
  std::vector<Pose> X_WL;  ///< same order
  std::string name = {};
};

/// A line over the ground or in the air (trail, plan, sensor ray), drawn as a ribbon of constant
/// pixel width. Where the terrain is a height field, no part of it is drawn lower than 4 cm above
/// the ground.
struct Polyline {
  std::vector<Eigen::Vector3d> points_W;
  std::vector<float> fade;             ///< share of alpha at each point; empty: 1 at all of them
  Eigen::Vector3f colour = {1, 1, 0};  ///< as seen on the screen (sRGB), not lit
  float width_px = 3.0f;
  float alpha = 1.0f;
  float hidden_alpha = 0.0f;  ///< of what lies behind something else; 0: is not seen
  bool dashed = false;
  bool pairs = false;  ///< two points each are a piece of their own (LineList)
};

struct Camera {
  Pose X_WC;              ///< x right, y down, z forward (optical frame)
  double fov_rad = 0.96;  ///< vertical
  bool orthographic = false;
  double ortho_height_m = 50.0;  ///< of the picture, for orthographic cameras
};

/// What a colour stands for.
struct LegendEntry {
  std::string text;
  Eigen::Vector3f colour = {1, 1, 1};  ///< sRGB, as of the lines
};

/// A named place: a ring around what is there unless that is larger, or an arrow at the picture's
/// edge where it lies outside.
struct Marker {
  Eigen::Vector3d p_W = {0, 0, 0};
  double radius_m = 0.0;  ///< of what is there
  std::string text;
  Eigen::Vector3f colour = {1, 1, 1};  ///< sRGB, as of the lines
};

struct Frame {
  Camera camera;
  std::vector<VehicleDrawing> vehicles;
  std::vector<Polyline> lines;
  /// Drawn over the ground, in views from above over everything; null: none. Held by the renderer
  /// until another is shown, so that its texture is made once.
  std::shared_ptr<const OccupancyGrid> grid;
  /// First line larger; lower left, or in the first other corner where it hides no vehicle.
  std::vector<std::string> caption;
  std::vector<LegendEntry> legend;  ///< below the caption's lines
  std::vector<Marker> markers;
  bool show_scale = false;  ///< scale bar and north arrow, in orthographic views from above
  int width = 1280;
  int height = 720;
  int samples = 4;  ///< pixels drawn for each of the picture: 1, 4 (smooth edges) or 9
};

struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< top row first
};

struct RendererSettings {
  bool cull = true;  ///< off: everything is sent to the rasterizer (tests compare)
  bool shadows = true;
  bool grass_tufts = true;    ///< cards of grass near the camera
  bool distant_hills = true;  ///< ground continues beyond the terrain to the horizon
};

/// What the last frame cost.
struct FrameStatistics {
  int draw_calls = 0;
  std::int64_t triangles = 0;
  /// Share of the picture where a vehicle is what is seen, not counting text and lines; order of
  /// Frame::vehicles, of the first 254.
  std::vector<double> vehicle_shares;
};

/// Draws frames of one world. Geometry is uploaded once. The picture is a function of world and
/// frame alone, whatever was drawn before. Not thread safe; several renderers may exist.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// @throws std::runtime_error when GL reports an error or the size is not in [1, 8192]
  virtual Image draw(const Frame& frame) = 0;
  virtual FrameStatistics statistics() const = 0;
};

/// @returns the renderer, or why there is none ("libOSMesa.so.8 cannot be loaded: ...")
Result<std::unique_ptr<Renderer>> make_renderer(const WorldModel& world,
                                                const RendererSettings& settings = {});

/// Fast compression, no time stamps: the same image gives the same file.
/// Whole or not at all. @throws WriteError, ConfigError when the file cannot be written
/// @param words  stored with the picture (chunks tEXt), by keyword; see read_png_words() in png.h
void write_png(const std::string& file, const Image& image,
               const std::map<std::string, std::string>& words = {});

/// Digest of size and pixels.
std::string image_digest(const Image& image);

}  // namespace vinerow::render

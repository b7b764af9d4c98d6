#pragma once
/// Contents of a picture as plain data: the world, the vehicles' links, and lines drawn over them.
///
/// Conventions for the meshes of worlds/ and vehicles/:
/// - Names that differ only in a suffix "#lod0", "#lod1", "#lod2" are levels of detail of one
///   object; #lod0 is used at the shortest distance. kWire, kTrunk and kPost are omitted one after
///   the other with distance.
/// - Instances that share a TriangleMesh pointer share one vertex buffer. Keep canopy chunks at
///   about 4-8 m of row, which suits culling and levels of detail.
/// - A mesh without normals gets them with a crease angle of 40 deg. Closed meshes are drawn
///   one-sided, open ones two-sided.
/// - Material.leaf_cards: quads (or any pieces that share vertices), uv 0..1 over each card with
///   the stem at v = 0, normals closer to the canopy's volume than to the card (soft shading).
///   Vertex colours are the leaves' linear RGB (times Material.colour), darker inside; without them
///   leaves are green. The renderer chooses a picture by the card's edge length: one leaf below
///   0.22 m, a spray of a dozen leaves up to 0.7 m, a clump of sixty above.
/// - Material.texture: "builtin:vine_leaf", "builtin:tree_leaf" (both need leaf_cards),
///   "builtin:wood", "builtin:bark" (grain along the mesh's z axis, no uvs needed), or a PNG file
///   with uvs (row 0 of the image at v = 1). If it cannot be read, Material.colour is used.

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
  std::vector<Pose> X_WL;  ///< in the order of `links`
  std::string name = {};
};

/// A line over the ground or in the air (trail, plan, sensor ray), drawn as a ribbon of constant
/// pixel width. Where the terrain is a height field, no part of it is drawn lower than 4 cm above
/// the ground.
struct Polyline {
  std::vector<Eigen::Vector3d> points_W;
  std::vector<float> fade;             ///< share of alpha at each point; empty: 1 at all of them
  Eigen::Vector3f colour = {1, 1, 0};  ///< sRGB, not lit
  float width_px = 3.0f;
  float alpha = 1.0f;
  float hidden_alpha = 0.0f;  ///< alpha of parts hidden by objects; 0: invisible
  bool dashed = false;
  bool pairs = false;  ///< each two points are a separate segment (LineList)
};

struct Camera {
  Pose X_WC;              ///< x right, y down, z forward (optical frame)
  double fov_rad = 0.96;  ///< vertical
  bool orthographic = false;
  double ortho_height_m = 50.0;  ///< of the picture, for orthographic cameras
};

/// Meaning of a colour.
struct LegendEntry {
  std::string text;
  Eigen::Vector3f colour = {1, 1, 1};  ///< sRGB, as of the lines
};

/// Named place: a ring around the object there unless the object is larger, or an arrow at the
/// picture's edge if the place is outside.
struct Marker {
  Eigen::Vector3d p_W = {0, 0, 0};
  double radius_m = 0.0;  ///< of the object
  std::string text;
  Eigen::Vector3f colour = {1, 1, 1};  ///< sRGB, as of the lines
};

struct Frame {
  Camera camera;
  std::vector<VehicleDrawing> vehicles;
  std::vector<Polyline> lines;
  /// Grid drawn over the ground, or over everything in views from above; null: no grid. The
  /// renderer holds it until another grid is shown, so that its texture is created once.
  std::shared_ptr<const OccupancyGrid> grid;
  /// The first line is larger. The caption is in the lower left corner, or in the first other
  /// corner where it hides no vehicle.
  std::vector<std::string> caption;
  std::vector<LegendEntry> legend;  ///< below the caption's lines
  std::vector<Marker> markers;
  bool show_scale = false;  ///< scale bar and north arrow, in orthographic views from above
  int width = 1280;
  int height = 720;
  /// Drawn pixels per pixel of the picture: 1, 2 (sample_pattern.h), 4 or 9.
  int samples = 2;
};

struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< top row first
};

struct RendererSettings {
  bool cull = true;  ///< false: everything is rasterized (for comparison in tests)
  bool shadows = true;
  bool grass_tufts = true;    ///< grass cards near the camera
  bool distant_hills = true;  ///< ground continues beyond the terrain to the horizon
};

/// Cost of the last frame.
struct FrameStatistics {
  int draw_calls = 0;
  std::int64_t triangles = 0;
  /// Visible share of the picture of each vehicle, ignoring text and lines; in the order of
  /// Frame::vehicles, for the first 254.
  std::vector<double> vehicle_shares;
};

/// Renderer for one world. Geometry is uploaded once. The picture depends only on world and frame,
/// not on earlier frames. Not thread safe; several renderers may exist.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// @throws std::runtime_error if GL reports an error or the size is not in [1, 8192]
  virtual Image draw(const Frame& frame) = 0;
  virtual FrameStatistics statistics() const = 0;
};

/// @returns the renderer, or the reason for its absence ("libOSMesa.so.8 cannot be loaded: ...")
Result<std::unique_ptr<Renderer>> make_renderer(const WorldModel& world,
                                                const RendererSettings& settings = {});

/// Writes a PNG atomically, with fast compression and without time stamps: equal images give equal
/// files.
/// @throws WriteError, ConfigError if the file cannot be written
/// @param words  stored with the picture (chunks tEXt), by keyword; see engine/imaging/png.h
void write_png(const std::string& file, const Image& image,
               const std::map<std::string, std::string>& words = {});

/// Digest of size and pixels.
std::string image_digest(const Image& image);

}  // namespace vinerow::render

#pragma once
/// GLSL 3.30 sources, one pair per kind of surface.

#include <string>

namespace vinerow::render::shaders {

/// Factors of the square, fourth and eighth root of x whose sum is x to the power of 1/2.2, the
/// gamma of displays, within 0.66 of 255 levels for x in 0..1 (minimax fit). Roots are cheaper than
/// a power.
inline constexpr double kGammaRoots[] = {0.83519, 0.21166, -0.0443};

struct Pair {
  std::string vertex;
  std::string fragment;
};

/// Colours of the sky without the sun, at few pixels, and the sky as it is seen with them.
Pair sky();
Pair sky_seen();
/// Terrain, optionally with the occupancy grid and with the scenery's fields and tracks.
/// @param fine  for triangles of a few metres: what changes slowly is computed at their corners
Pair ground(bool with_grid = false, bool with_land = false, bool fine = false);
/// Where the ground may be seen, for FrameTarget::begin_ground(): depth of what is before it.
Pair ground_gaps();
/// The ground by the colours that it has there.
Pair ground_seen();
Pair country();        ///< the land beyond the terrain
Pair surface();        ///< posts, trunks, vehicles, anything opaque
Pair foliage();        ///< albedo and normal of alpha-tested leaf cards
Pair grass();          ///< the same of tufts near the camera
Pair foliage_light();  ///< light on what foliage() and grass() have drawn
Pair grass_on_grid();  ///< tufts with the occupancy grid, lit at once
Pair hedge();          ///< rows of the scenery
Pair stems();          ///< stems below the rows
Pair grid_map();       ///< the occupancy grid over a view from above
Pair ribbon();         ///< lines in clip space
Pair shadow_solid();
Pair shadow_cards();

/// Declarations and functions shared by the shaders: frame block, light, haze, tone.
const std::string& frame_block();
const std::string& light_functions();
/// The same without shadows, also for vertex shaders.
const std::string& tone_functions();
/// The haze alone, also for vertex shaders.
const std::string& haze_functions();
const std::string& grass_colour();
/// Non-repeating noises and textures of the ground: untiled(), value_noise(), grass_tone().
const std::string& untiled_noise();
/// float octave_of(vec2 q): resolution at which q is seen, for fragment shaders.
const std::string& pixel_octave();
/// vec3 leaf_light(albedo, n, p, sun): radiance of leaves.
const std::string& leaf_light();
/// vec3 grass_light(albedo, n, p, sun, up): radiance of blades of grass.
const std::string& grass_light();
/// What the alpha of foliage()'s and grass()'s albedo says: 1 for leaves, for grass the share of
/// its height times kMostGrass.
inline constexpr char kFoliageMarks[] = "const float kMostGrass = 0.75;\n";
/// Land land_at(...): fields and tracks at a position; include it after the ground's inputs.
const std::string& land_use();
/// vec4 grid_tint(vec2 place): colour and opacity of the occupancy grid.
const std::string& grid_tint();

}  // namespace vinerow::render::shaders

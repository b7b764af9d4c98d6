#include "engine/render/shaders.h"

namespace vinerow::render::shaders {

const std::string& grid_tint() {
  static const std::string text = R"(
uniform sampler2D grid_cells;  // R: occupied share; G: depth inside the occupied area / 2 m
uniform vec4 grid_rect;        // xy: corner in m; zw: 1 / size of the texture in m
uniform vec4 grid_size;        // xy: of the grid in m; z: of a texel in m

// Colour (sRGB) and opacity of the grid at a point: a rim between occupied and free cells, at
// least 6 cm and about 1.5 pixels wide, and inside it a fill that fades with depth, so that the
// country outside a parcel stays visible. The last cells continue beyond the grid.
vec4 grid_tint(vec2 q) {
  vec2 local = q - grid_rect.xy;
  vec2 inside = clamp(local, vec2(0.5 * grid_size.z), grid_size.xy - 0.5 * grid_size.z);
  vec2 cell = texture(grid_cells, inside * grid_rect.zw).rg;
  float depth = 2.0 * cell.g + length(local - inside);
  float taken = smoothstep(0.2, 0.5, cell.r);
  float pixel = 0.5 * (length(dFdx(q)) + length(dFdy(q)));
  float wide = max(0.06, 1.5 * pixel);
  float rim = 1.0 - smoothstep(0.7 * wide, 1.3 * wide, depth);
  float fill = 0.42 * (1.0 - smoothstep(0.5, 2.0, depth));
  vec3 tint = mix(vec3(0.40, 0.28, 1.0), vec3(0.30, 0.12, 0.92), rim);
  return vec4(tint, taken * mix(fill, 0.85, rim));
}
)";
  return text;
}

Pair grid_map() {
  const std::string vertex = frame_block() + R"(
out vec2 place;
void main() {
  vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0;
  place = (world_from_clip * vec4(corner, 0.0, 1.0)).xy;
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";
  const std::string fragment = frame_block() + grid_tint() + R"(
in vec2 place;
out vec4 colour;
void main() {
  colour = grid_tint(place);
}
)";
  return {vertex, fragment};
}

}  // namespace vinerow::render::shaders

#include "engine/render/shaders.h"

namespace vinerow::render::shaders {

namespace {

/// A triangle over the whole picture.
const char* const kSkyCorners = R"(
vec2 sky_corner() {
  return vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0;
}

vec3 sky_direction(vec2 corner) {
  vec4 far_point = world_from_clip * vec4(corner, 1.0, 1.0);
  vec4 near_point = world_from_clip * vec4(corner, -1.0, 1.0);
  return far_point.xyz / far_point.w - near_point.xyz / near_point.w;
}
)";

}  // namespace

Pair sky() {
  const std::string vertex = frame_block() + kSkyCorners + R"(
out vec3 direction;
void main() {
  vec2 corner = sky_corner();
  direction = sky_direction(corner);
  gl_Position = vec4(corner, 1.0, 1.0);
}
)";
  const std::string fragment = frame_block() + tone_functions() + R"(
in vec3 direction;
out vec4 colour;
uniform sampler2D sky_table;   // u: azimuth from the sun / pi, v: sqrt(elevation / 90 deg)
uniform sampler2D noise_tile;
const float kFiner = -2.0;  // as finely as in the picture, whose pixels are a quarter as large

void main() {
  vec3 d = normalize(direction);
  float elevation = asin(clamp(d.z, 0.0, 1.0));
  float cos_azimuth = dot(normalize(d.xy + vec2(1e-5)), normalize(sun_direction.xy + vec2(1e-5)));
  vec2 uv = vec2(acos(clamp(cos_azimuth, -1.0, 1.0)) * kOneOverPi, sqrt(elevation / 1.5707963));
  uv = uv * (47.0 / 48.0) + 0.5 / 48.0;
  vec3 radiance = texture(sky_table, uv).rgb;

  // Fair-weather clouds on a plane: thin veils high up, brighter where they face the sun.
  float away = 1.0 / (max(d.z, 0.0) + 0.10);
  vec2 p = d.xy * away * 0.115 + vec2(0.37, 0.11);
  float cover = texture(noise_tile, p, kFiner).b * 0.72 + texture(noise_tile, p * 3.1 + 0.4, kFiner).b * 0.28;
  float lit = texture(noise_tile, p + sun_direction.xy * 0.018, kFiner).b * 0.72 + 0.14;
  float cloud = smoothstep(0.53, 0.86, cover) * smoothstep(0.015, 0.20, d.z);
  vec3 sunlit = sun_irradiance.rgb * 0.16 + sky_irradiance.rgb * 0.22;
  vec3 shaded = sun_irradiance.rgb * 0.075 + sky_irradiance.rgb * 0.20;
  float relief = clamp(0.5 + 3.0 * (cover - lit), 0.0, 1.0);
  radiance = mix(radiance, mix(shaded, sunlit, relief), cloud * 0.85);

  // The glow of the haze around the sun.
  float toward = dot(d, sun_direction.xyz);
  radiance += sun_irradiance.rgb * (0.22 * pow(max(toward, 0.0), 900.0));

  // The horizon fades into the same haze that hides the far hills.
  float low = exp(-max(d.z, 0.0) * 22.0) * 0.75;
  radiance = mix(radiance, haze_colour(d), d.z < 0.0 ? 0.75 : low);
  colour = vec4(to_screen(radiance), 1.0 - 0.9 * cloud);
}
)";
  return {vertex, fragment};
}

Pair sky_seen() {
  const std::string vertex = frame_block() + kSkyCorners + R"(
out vec3 direction;
out vec2 place;
void main() {
  vec2 corner = sky_corner();
  direction = sky_direction(corner);
  float y = corner.y / sampling.w;
  place = 0.5 + 0.5 * vec2((corner.x - sampling.z * y) / sampling.y, y);
  gl_Position = vec4(corner, 1.0, 1.0);
}
)";
  const std::string fragment = frame_block() + R"(
in vec3 direction;
in vec2 place;
out vec4 colour;
uniform sampler2D sky_seen;  // a: share of the sun's disc that clouds leave

void main() {
  vec4 seen = texture(sky_seen, place);
  float disc = smoothstep(0.999968, 0.999988, dot(normalize(direction), sun_direction.xyz));  // 0.27 deg
  colour = vec4(mix(seen.rgb, vec3(1.0), disc * seen.a), 1.0);
}
)";
  return {vertex, fragment};
}

namespace {

/// The ground has one drawn pixel in each of the picture's, so that shadows need all of their taps.
const char* const kAllTaps = "#define ALL_TAPS\n";

const char* const kGroundVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 world_from_model;
out vec3 p_W;
out vec3 n_W;
#ifdef SLOW_AT_VERTICES
uniform float cell_octave;  // binary logarithm of the distance between vertices, in m
out vec4 macro;
out vec2 broad;
out vec4 haze;
#endif
void main() {
  p_W = (world_from_model * vec4(position, 1.0)).xyz;
  n_W = mat3(world_from_model) * normal;
#ifdef SLOW_AT_VERTICES
  macro = macro_noise(p_W.xy, cell_octave);
  broad = broad_tone(p_W.xy);
  haze = haze_before(p_W);
#endif
  gl_Position = clip_from_world * vec4(p_W, 1.0);
}
)";

const char* const kGroundInputs = R"(
in vec3 p_W;
in vec3 n_W;
out vec4 colour;
uniform sampler2D ground_tile;  // R grass, G dryness, B soil, A height
uniform sampler2D row_mask;     // distances / 2.55 m: R to a row, G to the middle of an alley; B in an alley

// What changes slowly from place to place.
#ifdef SLOW_AT_VERTICES
in vec4 macro;
in vec2 broad;
in vec4 haze;
#define SLOW(at_vertices, here) at_vertices
#else
#define SLOW(at_vertices, here) here
#endif

// Functions shared by terrain and country: noises, turf and soil at a point.
struct Turf {
  vec4 macro, meso, detail;
  vec3 grass, soil;
  float scar;  // share of bare soil in dry places
};

Turf turf_at(vec2 q) {
  Turf t;
  float octave = octave_of(q);
  t.macro = SLOW(macro, macro_noise(q, octave));
  t.meso = meso_noise(q, octave);
  vec4 fine = untiled_sharp(ground_tile, q * 0.476, octave + kTileOctaves - 1.07, kGroundMean);
  vec4 wide = untiled_sharp(ground_tile, mat2(0.54, 0.84, -0.84, 0.54) * q * 0.171 + 0.7,
                      octave + kTileOctaves - 2.55, kGroundMean);
  t.detail = mix(fine, wide, 0.38);
  t.grass = grass_albedo(t.detail.r * 1.15, t.detail.g + grass_look.y, grass_tone(SLOW(broad, broad_tone(q)), octave, t.macro, t.meso)) * grass_look.x;
  t.soil = mix(vec3(0.098, 0.066, 0.043), vec3(0.335, 0.255, 0.176), t.detail.b * 0.9 + 0.25 * (t.meso.r - 0.5)) * soil_look.rgb;
  t.scar = 0.6 * smoothstep(0.70, 0.98, t.meso.r * 0.5 + t.macro.g * 0.40 + (0.5 - t.detail.a) * 0.7);
  // Partly covered soil is bare where the noise is low.
  t.scar = max(t.scar, smoothstep(1.05 - 1.2 * soil_look.a, 1.45 - 1.35 * soil_look.a, 0.5 * t.meso.r + 0.3 * t.detail.b + 0.2 * t.macro.g));
  return t;
}

float turf_relief(Turf t, float bare) {
  return 0.80 + 0.35 * (t.detail.a + t.detail.r * (1.0 - bare) * 0.4);
}
)";

/// Colours of the country from afar.
const char* const kPatchwork = R"(
// Fields about 190 m long on a grid that is bent, in strips that are shifted against each other.
vec3 patchwork(vec2 q, float octave, vec4 regions, vec4 trees) {
  vec2 bent = q + 150.0 * vec2(value_noise(q * 0.0031, 11u), value_noise(q * 0.0031 + 0.5, 12u));
  vec2 p = mat2(0.87, 0.5, -0.5, 0.87) * bent * vec2(1.0 / 190.0, 1.0 / 130.0);
  ivec2 cell = ivec2(0, int(floor(p.y)));
  p.x += float(mixed_bits(cell, 13u) & 255u) / 256.0;
  cell.x = int(floor(p.x));
  uint h = mixed_bits(cell, 14u);
  float kind = float(h & 255u) / 255.0, shade = float((h >> 8) & 255u) / 255.0;
  vec3 green = mix(vec3(0.070, 0.096, 0.036), vec3(0.112, 0.130, 0.056), shade);
  vec3 straw = mix(vec3(0.150, 0.134, 0.072), vec3(0.225, 0.190, 0.108), shade);
  float dry = smoothstep(0.62, 0.66, kind + 0.5 * (regions.r - 0.5));
  vec3 field = mix(green, straw, dry) * (0.85 + 0.3 * trees.g);
  // Hedges and grass between them, hidden if smaller than a pixel.
  vec2 edge = min(fract(p), 1.0 - fract(p)) * vec2(190.0, 130.0);
  float hedge = 1.0 - smoothstep(2.0, 4.5 + exp2(octave), min(edge.x, edge.y) + 3.0 * (trees.a - 0.5));
  vec3 seam = mix(vec3(0.150, 0.140, 0.095), vec3(0.045, 0.062, 0.028), smoothstep(0.45, 0.55, trees.r));
  return mix(mix(field, seam, hedge * 0.7), vec3(0.118, 0.120, 0.058), smoothstep(4.0, 7.0, octave));
}
)";

/// Blends the grid over a shader's `seen`.
const char* const kApplyGrid = R"(
  vec4 tint = grid_tint(p_W.xy);
  seen = mix(seen, tint.rgb, tint.a);
)";

/// Effect of the scenery's fields and tracks on grass and soil.
const char* const kApplyLand = R"(
  Land land = land_at(q, t, octave_of(q), ragged * 0.6);
  grass = mix(grass, land.grass * 0.92, max(smoothstep(1.2, 1.6, d.y), 1.0 - mask.b) * (1.0 - strip));
  bare = max(bare, land.bare);
)";
const char* const kApplyTrack = R"(
  vec3 gravel = vec3(0.300, 0.258, 0.190) * (0.62 + 0.45 * t.detail.b + 0.18 * t.meso.r);
  albedo = mix(albedo, gravel, land.track);
)";

}  // namespace

Pair ground(bool with_grid, bool with_land, bool fine) {
  const std::string begin = frame_block() + kAllTaps + (fine ? "#define SLOW_AT_VERTICES\n" : "");
  const std::string fragment = begin + light_functions() + grass_colour() + untiled_noise() +
                               pixel_octave() + kGroundInputs + (with_grid ? grid_tint() : "") +
                               (with_land ? land_use() : "") + R"(
void main() {
  vec3 n = normalize(n_W);
  vec2 q = p_W.xy;
  Turf t = turf_at(q);
  vec2 uv = (q - mask_rect.xy) * mask_rect.zw;
  vec3 mask = texture(row_mask, uv).rgb;  // far from everything at its border
  vec2 d = mask.rg * 2.55;

  // Bare strip under the vines with ragged edges and weeds; wheel tracks next to it.
  float ragged = (t.meso.a - 0.5) * 0.26 + (t.detail.a - 0.5) * 0.30;
  float strip = 1.0 - smoothstep(0.24, 0.44, d.x + ragged);
  strip *= 1.0 - 0.6 * smoothstep(0.50, 0.75, t.meso.g + 0.5 * (t.detail.a - 0.5));
  float track = 1.0 - smoothstep(0.05, 0.24, abs(d.y - 0.60) + 0.7 * ragged);
  track *= 0.75 * mask.b * smoothstep(0.25, 0.75, t.meso.r + 0.4 * t.detail.a);
  float steep = smoothstep(0.45, 0.75, 1.0 - n.z + 0.3 * (t.meso.r - 0.5));
  float bare = max(max(strip, track), max(t.scar, steep));
  bare = clamp(bare + (0.5 - t.detail.a) * 0.9 * bare * (1.0 - bare) * 2.0, 0.0, 1.0);

  // The mown middle of an alley is lighter, the fringe at the vines taller and darker.
  vec3 grass = t.grass * (0.88 + 0.18 * mask.b * smoothstep(0.9, 0.2, d.y));
)" + (with_land ? kApplyLand : "") +
                               R"(
  vec3 albedo = mix(grass, t.soil, bare);
)" + (with_land ? kApplyTrack : "") +
                               R"(

  float sun = sun_visibility(p_W, n, 0.0);
)" + (with_land ? "  sun *= land.sun;\n" : "") +
                               R"(
  vec3 light = sun_irradiance.rgb * (max(dot(n, sun_direction.xyz), 0.0) * sun) + ambient(n) * turf_relief(t, bare);
  // The foot of the vines sees little sky.
  light *= 1.0 - 0.22 * (1.0 - smoothstep(0.0, 0.8, d.x));
  vec3 seen = finish_in(albedo * light * kOneOverPi, SLOW(haze, haze_before(p_W)));
)" + (with_grid ? kApplyGrid : "") +
                               R"(
  colour = vec4(seen, 1.0);
}
)";
  return {begin + haze_functions() + untiled_noise() + kGroundVertex, fragment};
}

Pair ground_gaps() {
  // Where other things hide the ground it gets the colour of shaded turf, of so little weight that
  // it counts only where no pixel beside shows any ground: in gaps between leaves.
  const std::string vertex = frame_block() + tone_functions() + R"(
flat out vec4 trace;
void main() {
  const float weight = 8.0 / 255.0;
  const vec3 turf = vec3(0.045, 0.050, 0.022);
  trace = weight * vec4(to_screen(turf * ambient(vec3(0.0, 0.0, 1.0)) * kOneOverPi), 1.0);
  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0, 0.0, 1.0);
}
)";
  const std::string fragment = R"(#version 330 core
flat in vec4 trace;
out vec4 colour;
uniform sampler2D frame_depth;
void main() {
  // The middle of a pixel in the staggered pattern (sample_pattern.h).
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int height = textureSize(frame_depth, 0).y >> 1;
  gl_FragDepth = texelFetch(frame_depth, ivec2(pixel.x + height - pixel.y, 2 * pixel.y + 1), 0).r;
  colour = trace;
}
)";
  return {vertex, fragment};
}

Pair ground_seen() {
  const std::string vertex = frame_block() + R"(
layout(location = 0) in vec3 position;
uniform mat4 world_from_model;
void main() {
  gl_Position = clip_from_world * (world_from_model * vec4(position, 1.0));
}
)";
  const std::string fragment = R"(#version 330 core
out vec4 colour;
uniform sampler2D ground_seen;
void main() {
  // A middle has its own colour, a corner the mean of the four around it.
  vec2 size = vec2(textureSize(ground_seen, 0)), drawn = gl_FragCoord.xy - 0.5;
  vec2 place = vec2(drawn.x + 0.5 * drawn.y - size.y, 0.5 * drawn.y);
  vec4 seen = texture(ground_seen, place / size);
  colour = vec4(seen.rgb / seen.a, 1.0);
}
)";
  return {vertex, fragment};
}

Pair country() {
  const std::string fragment = frame_block() + kAllTaps + light_functions() + grass_colour() +
                               untiled_noise() + pixel_octave() + kGroundInputs + kPatchwork + R"(
void main() {
  vec3 n = normalize(n_W);
  vec2 q = p_W.xy;
  Turf t = turf_at(q);
  vec3 albedo = mix(t.grass * 0.88, t.soil, t.scar);

  // Farther away fields and dark woods take turns over hundreds of metres.
  float far = smoothstep(80.0, 700.0, length(p_W - eye.xyz));
  vec4 regions = texture(noise_tile, q * 0.00071 + 0.2);
  vec4 trees = texture(noise_tile, q * 0.0051 + 0.6);
  vec3 field = patchwork(q, octave_of(q), regions, trees);
  float woods = smoothstep(0.52, 0.60, regions.a * 0.50 + trees.r * 0.30 + trees.a * 0.10 + t.macro.b * 0.10);
  field = mix(field, vec3(0.036, 0.052, 0.026) * (0.55 + 0.9 * trees.a), woods * 0.9);
  albedo = mix(albedo, field, far * 0.9);

  float sun = sun_visibility(p_W, n, 0.0);
  vec3 light = sun_irradiance.rgb * (max(dot(n, sun_direction.xyz), 0.0) * sun) + ambient(n) * turf_relief(t, t.scar);
  colour = vec4(finish_in(albedo * light * kOneOverPi, SLOW(haze, haze_before(p_W))), 1.0);
}
)";
  return {frame_block() + haze_functions() + untiled_noise() + kGroundVertex, fragment};
}

namespace {

std::string grass_vertex() {
  return frame_block() + untiled_noise() + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 tint;  // r: brightness, g: dryness, b: height above ground / 0.5 m, a: layer
out vec3 p_W;
out vec3 n_W;
out vec3 card;
out vec2 tone;
out vec2 shade;
void main() {
  p_W = position;
  n_W = normal;
  card = vec3(uv, floor(tint.a * 255.0 + 0.5));
  vec2 q = position.xy;
  const float octave = -20.0;  // the finest
  tone = grass_tone(broad_tone(q), octave, macro_noise(q, octave), meso_noise(q, octave));
  shade = tint.rg;
  gl_Position = clip_from_world * vec4(p_W, 1.0);
}
)";
}

const char* const kGrassInputs = R"(
in vec3 p_W;
in vec3 n_W;
in vec3 card;
in vec2 tone;
in vec2 shade;
uniform sampler2DArray leaf_cards;

vec3 albedo_of(vec4 blade) {
  float brightness = clamp(blade.r * shade.r * 1.25, 0.0, 1.0);
  return grass_albedo(brightness, (blade.g - 0.2) / 0.6 * 0.7 + shade.g * 0.3 + grass_look.y, tone) * grass_look.x;
}
)";

}  // namespace

Pair grass() {
  return {grass_vertex(), frame_block() + kFoliageMarks + grass_colour() + kGrassInputs + R"(
layout(location = 0) out vec4 albedo;  // as foliage()'s
layout(location = 1) out vec4 normal;

void main() {
  vec4 blade = texture(leaf_cards, card, sampling.x);
  if (blade.a < 0.5) discard;
  albedo = vec4(sqrt(albedo_of(blade)), kMostGrass * card.y);
  normal = vec4(0.5 + 0.5 * normalize(n_W), 1.0);
}
)"};
}

Pair grass_on_grid() {
  return {grass_vertex(), frame_block() + light_functions() + grass_colour() + grass_light() +
                              grid_tint() + kGrassInputs + R"(
out vec4 colour;

void main() {
  vec4 blade = texture(leaf_cards, card, sampling.x);
  if (blade.a < 0.5) discard;
  vec3 n = normalize(n_W);
  vec3 seen = finish(grass_light(albedo_of(blade), n, p_W, sun_visibility(p_W, n, 0.03), card.y), p_W);
)" + kApplyGrid + R"(
  colour = vec4(seen, 1.0);
}
)"};
}

}  // namespace vinerow::render::shaders

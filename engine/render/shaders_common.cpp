#include <fmt/format.h>

#include <array>

#include "engine/render/builtin_textures.h"
#include "engine/render/shaders.h"

namespace vinerow::render::shaders {

const std::string& frame_block() {
  static const std::string text = R"(#version 330 core
layout(std140) uniform FrameBlock {
  mat4 clip_from_world;
  mat4 world_from_clip;
  mat4 near_from_world;    // shadow maps: world to texture coordinates and depth
  mat4 far_from_world;
  vec4 eye;                // xyz; w: 1 perspective, 0 orthographic
  vec4 forward;            // xyz: viewing direction
  vec4 sun_direction;      // xyz: towards the sun
  vec4 sun_irradiance;     // rgb; a: exposure
  vec4 sky_irradiance;     // on an upward surface
  vec4 ground_irradiance;  // on a downward surface
  vec4 haze_to_sun;        // rgb; a: density in 1/m
  vec4 haze_from_sun;      // rgb
  vec4 mask_rect;          // xy: corner in m; zw: 1 / size
  vec4 shadow_info;        // texel of the near and far map in m; z: 1 when there are shadows
  vec4 land_rect;          // of the scenery's fields, as mask_rect
  vec4 soil_look;          // tint of bare soil; share of the ground that is bare
  vec4 grass_look;         // brightness, addition to dryness
  vec4 sampling;           // x: addition to the level of detail of textures; y, z, w: clip space of
                           // the drawn pixels from the picture's, (y x + z y, w y)
};
)";
  return text;
}

const std::string& haze_functions() {
  static const std::string text = R"(
vec3 haze_colour(vec3 direction) {
  float towards = 0.5 + 0.5 * dot(normalize(direction.xy + vec2(1e-5)), normalize(sun_direction.xy + vec2(1e-5)));
  return mix(haze_from_sun.rgb, haze_to_sun.rgb, towards * towards);
}

// Haze between p and the eye: what it adds, and the share of the light from p that it leaves.
vec4 haze_before(vec3 p) {
  vec3 ray = p - eye.xyz;
  float share = exp(-haze_to_sun.a * length(ray));
  return vec4(haze_colour(ray) * (1.0 - share), share);
}
)";
  return text;
}

const std::string& tone_functions() {
  static const std::string text = haze_functions() +
                                  fmt::format("const vec3 kGammaRoots = vec3({}, {}, {});\n",
                                              kGammaRoots[0], kGammaRoots[1], kGammaRoots[2]) +
                                  R"(
const float kOneOverPi = 0.31830989;

vec3 ambient(vec3 n) {
  float up = 0.5 + 0.5 * n.z;
  vec3 side = sun_irradiance.rgb * (0.05 * (1.0 - abs(n.z)) * (0.5 + 0.5 * dot(n, sun_direction.xyz)));
  return mix(ground_irradiance.rgb, sky_irradiance.rgb, up) + side;
}

vec3 view_direction(vec3 p) {
  return eye.w > 0.5 ? normalize(p - eye.xyz) : forward.xyz;
}

vec3 display_gamma(vec3 x) {
  vec3 r2 = sqrt(x), r4 = sqrt(r2);
  return kGammaRoots.x * r2 + kGammaRoots.y * r4 + kGammaRoots.z * sqrt(r4);
}

// Filmic curve after K. Narkowicz, "ACES filmic tone mapping curve", 2015, then display gamma.
vec3 to_screen(vec3 radiance) {
  vec3 x = radiance * sun_irradiance.a;
  x = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
  return display_gamma(clamp(x, 0.0, 1.0));
}

vec3 finish_in(vec3 radiance, vec4 haze) {
  return to_screen(radiance * haze.a + haze.rgb);
}

// Light from p at the eye, after the haze in between.
vec3 finish(vec3 radiance, vec3 p) {
  return finish_in(radiance, haze_before(p));
}
)";
  return text;
}

const std::string& light_functions() {
  static const std::string text = tone_functions() + R"(
uniform sampler2DArrayShadow shadow_maps;

// Share of the sun's disc seen from p: 0 in shadow, 1 in light. The point is moved along its normal
// by about a texel and a half, against shadows of a surface on itself.
float sun_visibility(vec3 p, vec3 n, float lift) {
  if (shadow_info.z < 0.5) return 1.0;
  float slope = 1.0 - clamp(dot(n, sun_direction.xyz), 0.0, 1.0);
  vec3 q = p + n * (shadow_info.x * (0.6 + 1.6 * slope)) + sun_direction.xyz * (0.02 + lift);
  vec3 c = (near_from_world * vec4(q, 1.0)).xyz;
  float layer = 0.0;
  vec2 edge = abs(c.xy - 0.5);
  if (max(edge.x, edge.y) > 0.495) {
    q = p + n * (shadow_info.y * (0.6 + 1.6 * slope)) + sun_direction.xyz * (0.03 + lift);
    c = (far_from_world * vec4(q, 1.0)).xyz;
    layer = 1.0;
  }
  // Four taps around the point, corners of a turned square. No loop, which llvmpipe runs slowly.
  const float radius = 1.15 / 2048.0;
#ifdef ALL_TAPS
  vec2 diagonal = radius * vec2(0.4, 1.0), other = radius * vec2(1.0, -0.4);
  float share = 0.25 * (texture(shadow_maps, vec4(c.xy + diagonal, layer, c.z)) +
                        texture(shadow_maps, vec4(c.xy - diagonal, layer, c.z)) +
                        texture(shadow_maps, vec4(c.xy + other, layer, c.z)) +
                        texture(shadow_maps, vec4(c.xy - other, layer, c.z)));
#else
  // Each drawn pixel takes one diagonal, and rows take turns, so that the mean over two rows is that
  // of all four.
  vec2 diagonal = radius * ((int(gl_FragCoord.y) & 1) == 0 ? vec2(0.4, 1.0) : vec2(1.0, -0.4));
  float share = 0.5 * (texture(shadow_maps, vec4(c.xy + diagonal, layer, c.z)) +
                       texture(shadow_maps, vec4(c.xy - diagonal, layer, c.z)));
#endif
  edge = abs(c.xy - 0.5);
  return max(edge.x, edge.y) > 0.499 ? 1.0 : share;
}
)";
  return text;
}

const std::string& grass_colour() {
  static const std::string text = R"(
// Colour of grass: brightness and dryness of the blade, 0..1; macro: slow noise over the field.
vec3 grass_albedo(float brightness, float dryness, vec2 macro) {
  float lush = smoothstep(0.25, 0.75, macro.x);
  vec3 deep = mix(vec3(0.050, 0.062, 0.022), vec3(0.030, 0.054, 0.017), lush);
  vec3 light = mix(vec3(0.225, 0.232, 0.095), vec3(0.135, 0.192, 0.062), lush);
  vec3 straw = vec3(0.34, 0.285, 0.160);
  float dry = clamp(dryness * 0.75 + (macro.y - 0.55) * 0.75 - 0.12, 0.0, 0.8);
  vec3 green = mix(deep, light, brightness);
  return mix(green, straw * (0.25 + 0.95 * brightness), dry);
}
)";
  return text;
}

namespace {

/// The mean of a texture as GLSL text "vec4(...)".
std::string mean_of(const imaging::Pixels& texture) {
  std::array<double, 4> sum{};
  for (std::size_t i = 0; i < texture.rgba.size(); ++i) sum[i % 4] += texture.rgba[i];
  const double scale = 4.0 / 255.0 / static_cast<double>(texture.rgba.size());
  return fmt::format("vec4({:.4f}, {:.4f}, {:.4f}, {:.4f})", scale * sum[0], scale * sum[1],
                     scale * sum[2], scale * sum[3]);
}

}  // namespace

const std::string& untiled_noise() {
  static const std::string text = "const vec4 kNoiseMean = " + mean_of(noise_texture()) +
                                  ";\nconst vec4 kGroundMean = " + mean_of(ground_texture()) +
                                  R"(;
uniform sampler2D noise_tile;

const float kTileOctaves = 9.0;  // textures of ground and noise have 2^9 pixels a side

uint mixed_bits(ivec2 cell, uint seed) {
  uint h = uint(cell.x) * 0x8da6b343u ^ uint(cell.y) * 0xd8163841u ^ seed * 0xcb1ab31fu;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  h *= 0x297a2d39u;
  return h ^ (h >> 15);
}

vec2 place_in_tile(ivec2 cell) {
  uint h = mixed_bits(cell, 7u);
  return vec2(h & 0xffffu, h >> 16) * (1.0 / 65536.0);
}

// Triangle of a skewed grid around a point: its corners, and their shares, which add up to 1.
struct Triangle {
  ivec2 a, b, c;
  vec3 share;
};

Triangle triangle_at(vec2 uv) {
  vec2 skewed = mat2(1.0, 0.0, -0.57735027, 1.15470054) * uv * 2.2;
  vec2 cell = floor(skewed);
  vec2 f = skewed - cell;
  float rest = 1.0 - f.x - f.y;
  float upper = rest < 0.0 ? 1.0 : 0.0;
  float side = 2.0 * upper - 1.0;
  ivec2 corner = ivec2(cell);
  int u = int(upper);
  return Triangle(corner + ivec2(u, u), corner + ivec2(u, 1 - u), corner + ivec2(1 - u, u),
                  vec3(-rest * side, upper - f.y * side, upper - f.x * side));
}

// A texture without end: at the corners of a grid of triangles it is shifted by random amounts, and
// between them the three are blended so that contrast stays. After E. Heitz, F. Neyret, "High-
// performance by-example noise using a histogram-preserving blending operator", 2018.
// lod, mean: of the texture.
vec4 untiled(sampler2D tile, vec2 uv, float lod, vec4 mean) {
  Triangle t = triangle_at(uv);
  vec3 w = t.share * t.share;
  w /= w.x + w.y + w.z;
  vec4 sum = w.x * textureLod(tile, uv + place_in_tile(t.a), lod) +
             w.y * textureLod(tile, uv + place_in_tile(t.b), lod) +
             w.z * textureLod(tile, uv + place_in_tile(t.c), lod);
  return clamp(mean + (sum - mean) * inversesqrt(dot(w, w)), 0.0, 1.0);
}

// The same with narrow borders, for textures whose blending would be visible. The smallest share
// counts only about the middle of a triangle: it is left out, and with it a third of the reads.
vec4 untiled_sharp(sampler2D tile, vec2 uv, float lod, vec4 mean) {
  Triangle t = triangle_at(uv);
  vec3 w = t.share;
  bool no_a = w.x <= w.y && w.x <= w.z;
  bool no_b = !no_a && w.y <= w.z;
  vec2 v = vec2(no_a ? w.z : w.x, no_b ? w.z : w.y);
  v *= v;
  v *= v;
  v *= v;
  v /= v.x + v.y;
  vec4 sum = v.x * textureLod(tile, uv + place_in_tile(no_a ? t.c : t.a), lod) +
             v.y * textureLod(tile, uv + place_in_tile(no_b ? t.c : t.b), lod);
  return clamp(mean + (sum - mean) * inversesqrt(dot(v, v)), 0.0, 1.0);
}

// Smooth value noise, 0..1, over cells of one unit.
float value_noise(vec2 q, uint seed) {
  vec2 cell = floor(q);
  vec2 f = q - cell;
  f = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  ivec2 i = ivec2(cell);
  vec4 h = vec4(mixed_bits(i, seed), mixed_bits(i + ivec2(1, 0), seed),
                mixed_bits(i + ivec2(0, 1), seed), mixed_bits(i + ivec2(1, 1), seed)) * (1.0 / 4294967296.0);
  return mix(mix(h.x, h.y, f.x), mix(h.z, h.w, f.x), f.y);
}

// octave: binary logarithm of a pixel's size on the ground, in m.
vec4 macro_noise(vec2 q, float octave) {
  return untiled(noise_tile, q * 0.0163, octave + kTileOctaves - 5.94, kNoiseMean);
}

vec4 meso_noise(vec2 q, float octave) {
  return untiled(noise_tile, mat2(0.8, 0.6, -0.6, 0.8) * q * 0.098 + 0.3, octave + kTileOctaves - 3.35, kNoiseMean);
}

// Lushness and dryness of the field over tens and hundreds of metres, about 0.
vec2 broad_tone(vec2 q) {
  return vec2(0.40, 0.34) * (vec2(value_noise(q * 0.021, 3u), value_noise(q * 0.0173 + 0.5, 4u)) * 0.5 +
                             vec2(value_noise(q * 0.0067, 5u), value_noise(q * 0.0057 + 0.5, 6u)) * 0.5 - 0.5);
}

// Lushness and dryness of the field, 0..1 about 0.5: over metres, tens and hundreds of metres.
vec2 grass_tone(vec2 broad, float octave, vec4 macro, vec4 meso) {
  float shown = 1.0 - smoothstep(4.0, 6.0, octave);
  vec2 tone = vec2(macro.r * 0.6 + meso.g * 0.4, macro.g * 0.65 + meso.r * 0.35);
  return tone + shown * broad;
}
)";
  return text;
}

const std::string& pixel_octave() {
  static const std::string text = R"(
float octave_of(vec2 q) {
  vec2 dx = dFdx(q), dy = dFdy(q);
  return 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1e-12)) + sampling.x;
}
)";
  return text;
}

}  // namespace vinerow::render::shaders

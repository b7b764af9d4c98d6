#include "engine/render/shaders.h"

namespace vinerow::render::shaders {

const std::string& land_use() {
  static const std::string text = R"(
uniform sampler2D land_tile;    // R field, G distance to a track / 5.1 m, B in a field 0.5, among its rows 1, A shade of trees
uniform sampler2D field_table;  // three texels a field: normal, offset, pitch of rows; look; section of rows

struct Land {
  vec3 grass;   // or stubble
  float bare;   // share of bare soil
  float track;  // share of gravel
  float sun;    // share of sunlight between rows and trees
};

// ragged: a noise about 0, m
Land land_at(vec2 q, Turf t, float octave, float ragged) {
  Land land = Land(t.grass, 0.0, 0.0, 1.0);
  vec2 uv = (q - land_rect.xy) * land_rect.zw;
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return land;
  vec4 here = texture(land_tile, uv);
  ivec2 size = textureSize(land_tile, 0);
  int field = int(texelFetch(land_tile, min(ivec2(uv * vec2(size)), size - 1), 0).r * 255.0 + 0.5);
  vec4 rows = texelFetch(field_table, ivec2(0, max(field - 1, 0)), 0);
  vec4 look = texelFetch(field_table, ivec2(1, max(field - 1, 0)), 0);
  vec4 section = texelFetch(field_table, ivec2(2, max(field - 1, 0)), 0);
  float inside = field > 0 ? smoothstep(0.03, 0.47, here.b + 0.8 * ragged) : 0.0;
  float planted = field > 0 && rows.w > 0.0 ? smoothstep(0.65, 0.85, here.b + 0.4 * ragged) : 0.0;

  vec2 tone = grass_tone(SLOW(broad, broad_tone(q)), octave, t.macro, t.meso) * 0.75 + 0.125 + (look.x - 0.5) * vec2(-0.55, 0.45);
  vec3 grass = grass_albedo(t.detail.r * 1.15, t.detail.g + grass_look.y, tone) * (look.w * grass_look.x);
  float furrow = 0.5 + 0.5 * sin((dot(q, rows.xy) - rows.z) * 2.1);
  float seen = exp2(octave);
  furrow = mix(furrow, 0.5, smoothstep(0.4, 1.5, seen));
  vec3 stubble = vec3(0.315, 0.255, 0.145) * (0.55 + 0.35 * t.detail.r + 0.25 * t.meso.g + 0.10 * furrow);
  grass = mix(grass * (0.96 + 0.08 * furrow), stubble, look.z * (0.85 + 0.15 * t.detail.a));
  land.grass = mix(t.grass, grass, inside);

  // Bare strips under the vines; from afar only their average remains.
  float pitch = max(rows.w, 0.1);
  float x = (dot(q, rows.xy) - rows.z) / pitch;
  float away = abs(x - floor(x + 0.5)) * pitch;
  float strip = 1.0 - smoothstep(0.24 - 0.5 * seen, 0.44 + 0.5 * seen, away + ragged);
  strip = mix(strip, 0.68 / pitch, smoothstep(0.4, 1.2, seen));
  float other = mod(floor(x), 2.0);
  float tilled = look.y > 0.75 ? 1.0 : look.y > 0.25 ? mix(other, 0.5, smoothstep(0.8, 2.4, seen)) : 0.0;
  tilled *= 0.55 + 0.45 * smoothstep(0.25, 0.6, t.meso.g);
  land.bare = planted * max(strip, tilled);

  // Shadows of the rows: the ray to the sun hits a row between its foot and its top.
  float lean = dot(sun_direction.xy, rows.xy) / max(sun_direction.z, 0.1);
  float at = x * pitch + ragged;
  float foot = at + section.y * lean, top = at + section.z * lean;
  float low = min(foot, top) - section.x, high = max(foot, top) + section.x;
  float shaded = smoothstep(-0.1 - seen, 0.1 + seen, high - ceil(low / pitch) * pitch);
  shaded = mix(shaded, min((high - low) / pitch, 1.0), smoothstep(0.4, 1.2, seen));
  // Light comes through between the leaves.
  shaded *= mix(0.62, 0.92, smoothstep(0.35, 0.62, t.meso.a + 0.6 * (t.detail.a - 0.5)));
  land.sun = (1.0 - planted * shaded) * (1.0 - 0.85 * smoothstep(0.2, 0.8, here.a + 1.2 * ragged));

  // Field tracks: two ruts in gravel and worn grass.
  float side = here.g * 5.1;
  float rut = 1.0 - smoothstep(0.18, 0.50 + 0.5 * seen, abs(side - 0.80) + ragged);
  float worn = 1.0 - smoothstep(1.1, 1.9, side + 2.5 * ragged);
  land.track = clamp(max(rut * 0.9, worn * 0.42), 0.0, 1.0);
  return land;
}
)";
  return text;
}

namespace {

const char* const kHedgeVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv_in;
layout(location = 3) in vec4 tint;
out vec3 p_W;
out vec3 n_W;
out vec2 uv;
out vec3 leaf_colour;
flat out float row;
void main() {
  p_W = position;
  n_W = normal;
  uv = uv_in;
  leaf_colour = tint.rgb * tint.rgb;
  row = floor(tint.a * 255.0 + 0.5);
  gl_Position = clip_from_world * vec4(p_W, 1.0);
}
)";

}  // namespace

Pair hedge() {
  const std::string fragment = frame_block() + light_functions() + leaf_light() + R"(
in vec3 p_W;
in vec3 n_W;
in vec2 uv;
in vec3 leaf_colour;
flat in float row;
out vec4 colour;
uniform sampler2D noise_tile;

void main() {
  // Bunches of leaves along and around the row, no two rows alike.
  vec2 q = vec2(uv.x, uv.y * 1.7) + row * vec2(7.31, 3.17);
  vec4 bunch = texture(noise_tile, q * 0.07, sampling.x);
  vec4 leaves = texture(noise_tile, q.yx * 0.19, sampling.x);
  vec4 vigour = texture(noise_tile, q * vec2(0.021, 0.0), sampling.x);
  float leaf = 0.5 * bunch.a + 0.5 * leaves.a;
  if (leaf + 0.3 * vigour.g < 0.56) discard;
  vec3 n = normalize(n_W);
  n = normalize(n + 1.6 * vec3(leaves.r - 0.5, leaves.g - 0.5, bunch.r - 0.5));
  float height = 1.0 - abs(uv.y);
  vec3 albedo = leaf_colour * (0.20 + 1.75 * leaf * leaf + 0.25 * leaves.b) * mix(0.45, 1.1, smoothstep(0.0, 0.9, height));
  albedo *= mix(vec3(0.88, 0.95, 1.0), vec3(1.15, 1.06, 0.95), smoothstep(0.35, 0.65, vigour.r));
  colour = vec4(finish(leaf_light(albedo, n, p_W, sun_visibility(p_W, n, 0.25)), p_W), 1.0);
}
)";
  return {frame_block() + kHedgeVertex, fragment};
}

Pair stems() {
  const std::string fragment = frame_block() + light_functions() + R"(
in vec3 p_W;
in vec3 n_W;
in vec2 uv;
flat in float row;
out vec4 colour;

// Round stems in the row's plane, as wide as they are seen from the eye.
void main() {
  const float pitch = 1.1, radius = 0.035;
  float number = floor(uv.x / pitch);
  float jitter = 0.4 * (fract(number * 0.618034 + row * 0.37) - 0.5);
  float x = uv.x - (number + 0.5) * pitch - jitter;
  vec2 toward = normalize(view_direction(p_W).xy + vec2(1e-5));
  float across = x * dot(toward, normalize(n_W.xy)) / radius;
  if (abs(across) > 1.0) discard;
  vec3 n = vec3(vec2(-toward.y, toward.x) * across - toward * sqrt(1.0 - across * across), 0.0);
  vec3 bark = vec3(0.105, 0.080, 0.060) * (0.7 + 0.6 * fract(number * 0.7548777 + row * 0.13));
  float sun = 0.55 * max(dot(n, sun_direction.xyz), 0.0);  // through the leaves above
  colour = vec4(finish(kOneOverPi * bark * (sun_irradiance.rgb * sun + ambient(n)), p_W), 1.0);
}
)";
  return {frame_block() + kHedgeVertex, fragment};
}

}  // namespace vinerow::render::shaders

#include "engine/render/shaders.h"

namespace vinerow::render::shaders {

namespace {

const char* const kMeshVertex = R"(
invariant gl_Position;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv_in;
layout(location = 3) in vec4 tint;  // rgb; a: card layer
uniform mat4 world_from_model;
uniform float thicken;  // m per m of distance: wires get no thinner than a pixel
out vec3 p_W;
out vec3 n_W;
out vec3 p_M;
out vec2 uv;
flat out float layer;
out vec3 vertex_colour;
void main() {
  p_M = position;
  p_W = (world_from_model * vec4(position, 1.0)).xyz;
  n_W = mat3(world_from_model) * normal;
  if (thicken > 0.0) p_W += n_W * (thicken * length(p_W - eye.xyz));
  uv = uv_in;
  layer = floor(tint.a * 255.0 + 0.5);
  vertex_colour = tint.rgb * tint.rgb;
  gl_Position = clip_from_world * vec4(p_W, 1.0);
}
)";

}  // namespace

Pair surface() {
  const std::string fragment = frame_block() + light_functions() + R"(
in vec3 p_W;
in vec3 n_W;
in vec3 p_M;
in vec2 uv;
flat in float layer;
in vec3 vertex_colour;
out vec4 colour;
uniform sampler2D image;
uniform vec4 material;       // rgb, a: roughness
uniform float texture_mode;  // 0 none, 1 by uv, 2 grain along z of the mesh

float fifth_power(float x) {
  return x * x * x * x * x;
}

void main() {
  vec3 n = normalize(n_W);
  vec3 v = -view_direction(p_W);
  if (!gl_FrontFacing) n = -n;
  vec3 albedo = material.rgb * vertex_colour;
  if (texture_mode > 1.5) {
    albedo *= pow(texture(image, vec2((p_M.x + p_M.y) * 4.0, p_M.z * 0.8), sampling.x).rgb, vec3(2.2)) * 3.4;
  } else if (texture_mode > 0.5) {
    albedo *= pow(texture(image, uv, sampling.x).rgb, vec3(2.2));
  }
  float sun = sun_visibility(p_W, n, 0.0);
  float n_l = max(dot(n, sun_direction.xyz), 0.0);

  // Specular: GGX with F0 = 0.04 and the visibility approximation of Karis (SIGGRAPH 2013 course).
  float rough = clamp(material.a, 0.08, 1.0);
  float a2 = rough * rough * rough * rough;
  vec3 h = normalize(sun_direction.xyz + v);
  float n_h = max(dot(n, h), 0.0);
  float n_v = max(dot(n, v), 0.02);
  float denominator = n_h * n_h * (a2 - 1.0) + 1.0;
  float k = (rough + 1.0) * (rough + 1.0) * 0.125;
  float visible = 0.25 / ((n_l * (1.0 - k) + k) * (n_v * (1.0 - k) + k));
  float fresnel = 0.04 + 0.96 * fifth_power(1.0 - max(dot(h, v), 0.0));
  float specular = min(a2 * kOneOverPi / (denominator * denominator) * visible * fresnel, 8.0);

  // Mirror image of sky and ground, blurred by roughness.
  vec3 r = reflect(-v, n);
  float sky_share = smoothstep(-0.15 - 0.5 * rough, 0.15 + 0.5 * rough, r.z);
  vec3 mirrored = mix(ground_irradiance.rgb, mix(haze_from_sun.rgb * 2.6, sky_irradiance.rgb, clamp(r.z, 0.0, 1.0)), sky_share) * kOneOverPi;
  float edge = 0.04 + (max(1.0 - rough, 0.04) - 0.04) * fifth_power(1.0 - n_v);

  vec3 radiance = albedo * kOneOverPi * (sun_irradiance.rgb * (n_l * sun) + ambient(n));
  radiance += sun_irradiance.rgb * (specular * n_l * sun) + mirrored * edge;
  colour = vec4(finish(radiance, p_W), 1.0);
}
)";
  return {frame_block() + kMeshVertex, fragment};
}

const std::string& leaf_light() {
  static const std::string text = R"(
// Radiance of leaves at p of whose sun they see a share.
vec3 leaf_light(vec3 albedo, vec3 n, vec3 p, float sun) {
  vec3 v = -view_direction(p);
  float n_l = dot(n, sun_direction.xyz);
  // Leaves transmit about a third of the light, yellower than the reflected light.
  float front = max((n_l + 0.25) / 1.25, 0.0);
  float toward = max(dot(-v, sun_direction.xyz), 0.0);
  float through = max((0.35 - n_l) / 1.35, 0.0) * (0.35 + 1.1 * toward * toward * toward);
  vec3 transmitted = albedo * vec3(1.25, 1.22, 0.55);
  vec3 h = normalize(sun_direction.xyz + v);
  float n_h = max(dot(n, h), 0.0);
  float n_h2 = n_h * n_h, n_h4 = n_h2 * n_h2, n_h16 = n_h4 * n_h4 * n_h4 * n_h4;
  float gloss = n_h16 * n_h4 * n_h2 * 0.03;

  vec3 direct = sun_irradiance.rgb * sun;
  vec3 radiance = kOneOverPi * (albedo * (direct * front + ambient(n)) + transmitted * direct * through);
  return radiance + direct * gloss;
}
)";
  return text;
}

const std::string& grass_light() {
  static const std::string text = R"(
// Radiance of a blade of grass at p, of whose sun it sees a share; up: share of its height.
vec3 grass_light(vec3 albedo, vec3 n, vec3 p, float sun, float up) {
  float through = pow(clamp(dot(view_direction(p), sun_direction.xyz), 0.0, 1.0), 3.0) * up;
  float lit = max(dot(n, sun_direction.xyz), 0.0) * (0.75 + 0.35 * up) + 0.55 * through;
  vec3 light = sun_irradiance.rgb * (lit * sun) + ambient(n) * (0.6 + 0.4 * up);
  return albedo * light * kOneOverPi;
}
)";
  return text;
}

Pair foliage() {
  // Of the canopy's volume: its normal and two directions across, in which leaves are tilted.
  const std::string vertex = frame_block() + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv_in;
layout(location = 3) in vec4 tint;
uniform mat4 world_from_model;
uniform vec4 material;
out vec3 card;
out vec3 n_W;
out vec3 t_W;
out vec3 b_W;
out vec3 leaf_colour;
void main() {
  card = vec3(uv_in, floor(tint.a * 255.0 + 0.5));
  n_W = normalize(mat3(world_from_model) * normal);
  t_W = normalize(vec3(n_W.y, -n_W.x, 0.02));
  b_W = cross(n_W, t_W);
  leaf_colour = sqrt(material.rgb) * tint.rgb;
  gl_Position = clip_from_world * (world_from_model * vec4(position, 1.0));
}
)";
  return {vertex, frame_block() + R"(
in vec3 card;
in vec3 n_W;
in vec3 t_W;
in vec3 b_W;
in vec3 leaf_colour;
layout(location = 0) out vec4 albedo;  // rgb: square root, which keeps dark leaves apart; a: kMostGrass
layout(location = 1) out vec4 normal;
uniform sampler2DArray leaf_cards;

void main() {
  vec4 leaf = texture(leaf_cards, card, sampling.x);
  if (leaf.a < 0.5) discard;
  vec2 tilt = (leaf.gb - 0.5) * 2.2;
  albedo = vec4(leaf_colour * sqrt(0.30 + 1.40 * leaf.r), 1.0);
  normal = vec4(0.5 + 0.25 * (n_W + t_W * tilt.x + b_W * tilt.y), 1.0);
}
)"};
}

Pair foliage_light() {
  // A little larger than the picture, for drawn pixels on its edge.
  const std::string vertex = frame_block() + R"(
void main() {
  vec2 corner = (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0) * 1.002;
  gl_Position = vec4(dot(sampling.yz, corner), sampling.w * corner.y, 1.0, 1.0);
}
)";
  const std::string fragment =
      frame_block() + kFoliageMarks + light_functions() + leaf_light() + grass_light() + R"(
out vec4 colour;
uniform sampler2D frame_depth;
uniform sampler2D frame_albedo;
uniform sampler2D frame_normal;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 seen = texelFetch(frame_albedo, pixel, 0);
  vec3 n = normalize(texelFetch(frame_normal, pixel, 0).xyz - 0.5);
  float depth = texelFetch(frame_depth, pixel, 0).r;
  vec2 place = gl_FragCoord.xy / vec2(textureSize(frame_depth, 0));
  vec4 p = world_from_clip * vec4(2.0 * vec3(place, depth) - 1.0, 1.0);
  vec3 p_W = p.xyz / p.w;
  bool is_grass = seen.a < 0.5 * (1.0 + kMostGrass);
  float sun = sun_visibility(p_W, n, is_grass ? 0.03 : 0.10);
  vec3 albedo = seen.rgb * seen.rgb;
  vec3 radiance = is_grass ? grass_light(albedo, n, p_W, sun, seen.a / kMostGrass) : leaf_light(albedo, n, p_W, sun);
  colour = vec4(finish(radiance, p_W), 1.0);
}
)";
  return {vertex, fragment};
}

Pair ribbon() {
  const std::string vertex = R"(#version 330 core
layout(location = 0) in vec4 position;  // clip space
layout(location = 1) in vec4 tint;
layout(location = 2) in float along;    // pixels from the line's start, or -1 for solid lines
out vec4 line_colour;
out float distance_px;
void main() {
  line_colour = tint;
  distance_px = along;
  gl_Position = position;
}
)";
  const std::string fragment = R"(#version 330 core
in vec4 line_colour;
in float distance_px;
out vec4 colour;
void main() {
  if (distance_px >= 0.0 && fract(distance_px / 18.0) > 0.58) discard;
  colour = line_colour;
}
)";
  return {vertex, fragment};
}

namespace {

const char* const kShadowVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 2) in vec2 uv_in;
layout(location = 3) in vec4 tint;
uniform mat4 clip_from_model;
out vec3 card;
void main() {
  card = vec3(uv_in, floor(tint.a * 255.0 + 0.5));
  gl_Position = clip_from_model * vec4(position, 1.0);
}
)";

}  // namespace

Pair shadow_solid() {
  return {kShadowVertex, "#version 330 core\nvoid main() {}\n"};
}

Pair shadow_cards() {
  return {kShadowVertex, R"(#version 330 core
in vec3 card;
uniform sampler2DArray leaf_cards;
void main() {
  if (texture(leaf_cards, card).a < 0.5) discard;
}
)"};
}

}  // namespace vinerow::render::shaders

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
  vec4 shadow_info;        // texel of the near and far map in m; z: 1 when there are shadows; w: taps
};
)";
  return text;
}

const std::string& light_functions() {
  static const std::string text = R"(
uniform sampler2DArrayShadow shadow_maps;

const float kOneOverPi = 0.31830989;

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
  // Four taps around the place. A picture that is drawn with several pixels for one lets each of
  // them take one tap; the mean is the same.
  int taps = int(shadow_info.w + 0.5);
  ivec2 parity = ivec2(gl_FragCoord.xy) & 1;
  int first = taps > 1 ? 0 : parity.x + 2 * parity.y;
  float sum = 0.0;
  for (int i = first; i < first + taps; ++i) {
    vec2 side = vec2((i & 1) == 0 ? -0.5 : 0.5, (i & 2) == 0 ? -0.5 : 0.5);
    vec2 turned = vec2(side.x * 1.4 - side.y * 0.6, side.x * 0.6 + side.y * 1.4) * (1.15 / 2048.0);
    sum += texture(shadow_maps, vec4(c.xy + turned, layer, c.z));
  }
  edge = abs(c.xy - 0.5);
  return max(edge.x, edge.y) > 0.499 ? 1.0 : sum / float(taps);
}

vec3 ambient(vec3 n) {
  float up = 0.5 + 0.5 * n.z;
  vec3 side = sun_irradiance.rgb * (0.05 * (1.0 - abs(n.z)) * (0.5 + 0.5 * dot(n, sun_direction.xyz)));
  return mix(ground_irradiance.rgb, sky_irradiance.rgb, up) + side;
}

vec3 view_direction(vec3 p) {
  return eye.w > 0.5 ? normalize(p - eye.xyz) : forward.xyz;
}

vec3 haze_colour(vec3 direction) {
  float towards = 0.5 + 0.5 * dot(normalize(direction.xy + vec2(1e-5)), normalize(sun_direction.xy + vec2(1e-5)));
  return mix(haze_from_sun.rgb, haze_to_sun.rgb, towards * towards);
}

// Filmic curve after K. Narkowicz, "ACES filmic tone mapping curve", 2015, then display gamma.
vec3 to_screen(vec3 radiance) {
  vec3 x = radiance * sun_irradiance.a;
  x = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
  return pow(clamp(x, 0.0, 1.0), vec3(1.0 / 2.2));
}

// What reaches the eye from p through the haze between.
vec3 finish(vec3 radiance, vec3 p) {
  vec3 ray = p - eye.xyz;
  float share = exp(-haze_to_sun.a * length(ray));
  return to_screen(mix(haze_colour(ray), radiance, share));
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

}  // namespace vinerow::render::shaders

#include <mobil/systems/render/shaders.h>

#include <initializer_list>
#include <string>
#include <string_view>

namespace mobil::inline v0_3 {
namespace {

const char* const head = R"(#version 300 es
precision highp float;
precision highp sampler2DShadow;
layout(std140) uniform Frame {
  mat4 clip_from_world;
  mat4 shadow_from_world;
  vec4 eye;
  vec4 facing;
  vec4 light;
  vec4 fill;
  vec4 picture;
};
)";

// Fraction of the key light that reaches a point: the mean of depth comparisons on a small disc, each interpolated by
// the sampler.
const char* const shadow = R"(
uniform sampler2DShadow shadow_map;
const vec2 disc[8] = vec2[8](vec2(0.35, 0.05), vec2(-0.25, 0.40), vec2(-0.30, -0.35), vec2(0.30, -0.65),
                             vec2(0.75, 0.55), vec2(-0.15, 0.95), vec2(-0.90, 0.10), vec2(-0.50, -0.85));
float lit(vec3 p, float texels, bool faces_lamp) {
  vec3 s = (shadow_from_world * vec4(p, 1.0)).xyz;
  bool within = light.w > 0.0 && faces_lamp && all(lessThan(abs(s.xy - 0.5), vec2(0.5)));
  int count = within ? SAMPLES : 0;
  float sum = within ? 0.0 : float(SAMPLES);
  for (int i = 0; i < count; ++i) sum += texture(shadow_map, vec3(s.xy + disc[i] * (texels * fill.w), s.z));
  return sum / float(SAMPLES);
}
)";

// Key, fill and sky light, a soft highlight and a brighter rim, computed in linear light, then tone-mapped and encoded.
const char* const shade = R"(
vec3 encode(vec3 c) { return pow(c, vec3(1.0 / 2.2)); }

vec3 shade(vec3 albedo, float wetness, vec3 n, vec3 p, float key) {
  vec3 v = normalize(eye.xyz - p);
  float sky = 0.5 + 0.5 * n.y;
  vec3 ambient = mix(vec3(0.27, 0.235, 0.21), vec3(0.50, 0.55, 0.62), sky);
  ambient *= mix(0.55, 1.0, clamp(p.y * 2.5 + 0.25, 0.0, 1.0));
  float k = dot(n, light.xyz);
  float diffuse = max((k + 0.12) / 1.12, 0.0) * key;
  float back = max(dot(n, fill.xyz), 0.0);
  vec3 colour = albedo * (ambient + vec3(2.05, 1.95, 1.80) * diffuse + vec3(0.24, 0.29, 0.36) * back);
  vec3 h = normalize(light.xyz + v);
  float gloss = mix(26.0, 70.0, wetness);
  float highlight = pow(max(dot(n, h), 0.0), gloss) * clamp(k * 4.0, 0.0, 1.0) * key;
  float rim = pow(1.0 - clamp(dot(n, v), 0.0, 1.0), 4.0);
  colour += vec3(1.0, 0.97, 0.93) * (highlight * mix(0.07, 0.42, wetness));
  colour += vec3(0.55, 0.62, 0.70) * (rim * mix(0.10, 0.26, wetness) * (0.35 + 0.65 * sky));
  return encode(1.0 - exp(-1.15 * colour));
}
)";

// Muscle, aponeurosis and tendon. Fibres are streaks of noise along them, in coarse and fine bundles, each of which
// fades as it becomes thinner than a pixel. Tendons and aponeuroses begin between bundles.
const char* const flesh = R"(
uniform vec3 fibres;
uniform vec3 tendon_albedo;
float scatter(vec2 cell) {
  vec3 q = fract(cell.xyx * 0.1031);
  q += dot(q, q.yzx + 33.33);
  return fract((q.x + q.y) * q.z);
}
float bundles(vec2 at, vec2 size, vec2 footprint) {
  vec2 p = at / size, cell = floor(p), f = p - cell;
  float seen = 1.0 - smoothstep(0.35, 0.9, max(footprint.x / size.x, footprint.y / size.y));
  if (seen <= 0.0) return 0.0;
  f = f * f * (3.0 - 2.0 * f);
  vec2 low = vec2(scatter(cell), scatter(cell + vec2(0.0, 1.0)));
  vec2 high = vec2(scatter(cell + vec2(1.0, 0.0)), scatter(cell + vec2(1.0, 1.0)));
  vec2 across = mix(low, high, f.x);
  return seen * (2.0 * mix(across.x, across.y, f.y) - 1.0);
}
// Returns the albedo, and the wetness.
vec4 flesh(vec4 muscle, vec4 tissue) {
  vec2 at = tissue.xy * fibres.xy;
  float s = sin(fibres.z), c = cos(fibres.z);
  at = vec2(c * at.x + s * at.y, c * at.y - s * at.x);
  vec2 footprint = fwidth(at);
  float coarse = 0.0, fine = 0.0;
  if (fibres.x > 0.0) {
    coarse = bundles(at, vec2(0.035, 0.0022), footprint);
    fine = bundles(at, vec2(0.010, 0.0006), footprint);
  }
  float streak = 0.65 * coarse + 0.35 * fine;
  float tendon = smoothstep(0.0, 1.0, tissue.z + coarse * tissue.z * (1.0 - tissue.z));
  float sheet = clamp(tissue.w + 1.2 * streak * tissue.w * (1.0 - tissue.w), 0.0, 1.0);
  vec3 red = muscle.rgb * (1.0 + 0.28 * streak);
  vec3 ivory = tendon_albedo * (1.0 + 0.06 * streak);
  float pearl = sheet * (1.0 - tendon);
  float wet = muscle.w + 0.4 * pearl + 0.2 * streak * (1.0 - tendon);
  return vec4(mix(red, ivory, max(tendon, 0.6 * sheet)), clamp(wet, 0.0, 1.0));
}
)";

// Background: bright at the horizon, slightly darker above, below and towards the picture's edges.
const char* const room = R"(
vec3 room() {
  vec2 at = gl_FragCoord.xy / picture.xy;
  vec3 colour = mix(vec3(0.80, 0.815, 0.83), vec3(0.54, 0.60, 0.67), smoothstep(0.25, 1.15, at.y));
  vec2 off = (at - vec2(0.5, 0.5)) * vec2(1.1, 0.9);
  return colour * (1.0 - 0.42 * dot(off, off));
}
)";

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string whole;
  for (const std::string_view part : parts) whole += part;
  return whole;
}

std::string samples(int count) {
  return "#define SAMPLES " + std::to_string(count) + "\n";
}

}  // namespace

std::string mesh_vertex_source() {
  return joined({head, R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in mat4x3 placement;
layout(location = 9) in vec4 tissue;
uniform float outward;
out vec3 world;
out vec3 world_normal;
out vec3 corner;
out vec4 tissues;
void main() {
  tissues = tissue;
  mat3 m = mat3(placement[0], placement[1], placement[2]);
  world = m * position + placement[3];
  vec3 squared = vec3(dot(m[0], m[0]), dot(m[1], m[1]), dot(m[2], m[2]));
  world_normal = m * (normal / squared) * outward;
  int i = gl_VertexID % 3;
  corner = vec3(i == 0, i == 1, i == 2);
  gl_Position = clip_from_world * vec4(world, 1.0);
}
)"});
}

std::string mesh_fragment_source() {
  return joined({head, samples(4), shadow, shade, flesh, R"(
uniform vec4 albedo;
uniform float opacity;
in vec3 world;
in vec3 world_normal;
in vec4 tissues;
out vec4 colour;
void main() {
  vec3 n = normalize(world_normal);
  float key = lit(world + n * (1.6 * light.w), 1.6, dot(n, light.xyz) > -0.12);
  vec4 own = flesh(albedo, tissues);
  colour = vec4(shade(own.rgb, own.w, n, world, key), opacity);
}
)"});
}

std::string wireframe_fragment_source() {
  return joined({head, shade, R"(
uniform vec4 albedo;
in vec3 world;
in vec3 world_normal;
in vec3 corner;
out vec4 colour;
void main() {
  vec3 pixels = corner / fwidth(corner);
  float nearest = min(pixels.x, min(pixels.y, pixels.z));
  float cover = 1.0 - smoothstep(0.25, 1.25, nearest);
  if (cover < 0.05) discard;
  vec3 n = normalize(world_normal);
  bool front = dot(n, eye.xyz - world) > 0.0;
  colour = vec4(shade(albedo.rgb, 0.0, front ? n : -n, world, 1.0), cover * (front ? 1.0 : 0.45));
}
)"});
}

// A line segment is a strip with the outline of a stadium, half a disc at each end.
std::string line_vertex_source() {
  return joined({head, R"(
layout(location = 6) in vec3 from;
layout(location = 7) in vec3 to;
uniform vec2 width;
out vec3 world;
out vec2 across;
out vec3 side;
out vec3 along;
void main() {
  int column = gl_VertexID / 2;
  bool far = column >= 3;
  float angle = float(far ? 5 - column : column) * 0.785398163;
  vec3 base = far ? to : from;
  vec3 d = to - from;
  d = dot(d, d) > 0.0 ? normalize(d) : vec3(0.0, 1.0, 0.0);
  vec3 toward = facing.xyz - base * facing.w;
  vec3 s = cross(d, toward);
  s = dot(s, s) > 1e-12 ? normalize(s) : vec3(1.0, 0.0, 0.0);
  float radius = 0.5 * (width.x + width.y * picture.z * distance(eye.xyz, base));
  across = vec2((far ? 1.0 : -1.0) * cos(angle), ((gl_VertexID & 1) == 0 ? 1.0 : -1.0) * sin(angle));
  world = base + radius * (across.x * d + across.y * s);
  side = s;
  along = d;
  gl_Position = clip_from_world * vec4(world, 1.0);
}
)"});
}

std::string line_fragment_source() {
  return joined({head, shade, R"(
uniform vec4 albedo;
in vec3 world;
in vec2 across;
in vec3 side;
in vec3 along;
out vec4 colour;
void main() {
  vec3 s = normalize(side), d = normalize(along);
  float rise = sqrt(max(1.0 - dot(across, across), 0.0));
  vec3 n = normalize(across.x * d + across.y * s + rise * cross(s, d));
  colour = vec4(shade(albedo.rgb, 0.2, n, world, 1.0), 1.0);
}
)"});
}

// A ball is the disc of its silhouette as seen from `facing`. The fragment shader intersects a ray with the sphere.
std::string point_vertex_source() {
  return joined({head, "#define POINT_VERTICES ", std::to_string(point_vertices), R"(
layout(location = 8) in vec3 centre;
uniform float radius;
out vec3 world;
flat out vec3 middle;
void main() {
  vec3 toward = facing.xyz - centre * facing.w;
  float away = length(toward);
  vec3 w = toward / away;
  vec3 u = normalize(cross(abs(w.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), w));
  float size = radius;
  if (facing.w == 1.0 && away > 1.01 * radius) size *= away * inversesqrt(away * away - radius * radius);
  float angle = float(gl_VertexID) * (6.283185307 / float(POINT_VERTICES));
  world = centre + size * (cos(angle) * u + sin(angle) * cross(w, u));
  middle = centre;
  gl_Position = clip_from_world * vec4(world, 1.0);
}
)"});
}

std::string point_fragment_source() {
  return joined({head, shade, R"(
uniform vec4 albedo;
uniform float radius;
in vec3 world;
flat in vec3 middle;
out vec4 colour;
void main() {
  vec3 ray = normalize(world - eye.xyz);
  vec3 away = eye.xyz - middle;
  float b = dot(ray, away);
  float inside = b * b - dot(away, away) + radius * radius;
  vec3 p = eye.xyz + ray * (-b - sqrt(max(inside, 0.0)));
  vec4 clip = clip_from_world * vec4(p, 1.0);
  gl_FragDepth = clamp(0.5 * clip.z / clip.w + 0.5, 0.0, 1.0);
  colour = vec4(shade(albedo.rgb, 0.35, normalize(p - middle), p, 1.0), 1.0);
}
)"});
}

std::string depth_fragment_source() {
  return joined({head, "void main() {}\n"});
}

std::string ground_vertex_source() {
  return joined({head, R"(
out vec3 world;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  world = vec3(eye.x + corner.x * eye.w, 0.0, eye.z + corner.y * eye.w);
  gl_Position = clip_from_world * vec4(world, 1.0);
}
)"});
}

// The coverage of a pixel's footprint by grid lines is the difference of their running integral at its two ends, so
// distant lines fade to an even tone without shimmering.
std::string ground_fragment_source() {
  return joined({head, samples(8), shadow, room, R"(
in vec3 world;
out vec4 colour;
float grid(vec2 p, vec2 footprint, float spacing, float width) {
  vec2 x = p / spacing + 0.5 * width / spacing;
  vec2 w = max(footprint / spacing, 1e-4);
  float duty = width / spacing;
  vec2 low = x - 0.5 * w, high = x + 0.5 * w;
  vec2 covered = (floor(high) * duty + min(fract(high), duty) - floor(low) * duty - min(fract(low), duty)) / w;
  return 1.0 - (1.0 - covered.x) * (1.0 - covered.y);
}
void main() {
  vec2 p = world.xz;
  vec2 footprint = fwidth(p);
  float away = distance(world, eye.xyz);
  float fine = grid(p, footprint, 0.2, 0.004) * (1.0 - smoothstep(0.15, 0.55, away / eye.w));
  float coarse = grid(p, footprint, 1.0, 0.012);
  vec3 floor_colour = vec3(0.70, 0.705, 0.71);
  floor_colour *= 1.0 - 0.22 * fine;
  floor_colour *= 1.0 - 0.48 * coarse;
  floor_colour *= mix(vec3(0.40, 0.43, 0.48), vec3(1.0), lit(world, 3.0, true));
  vec3 far = room();
  colour = vec4(pow(mix(floor_colour, far, smoothstep(0.25, 0.95, away / eye.w)), vec3(1.0 / 2.2)), 1.0);
}
)"});
}

std::string background_vertex_source() {
  return joined({head, R"(
void main() {
  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 1.0, 1.0);
}
)"});
}

std::string background_fragment_source() {
  return joined({head, room, R"(
out vec4 colour;
void main() { colour = vec4(pow(room(), vec3(1.0 / 2.2)), 1.0); }
)"});
}

}  // namespace mobil::inline v0_3

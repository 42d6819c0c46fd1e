// GLSL. Attributes: a vertex has position, normal, uv, tint; an instance has the rows of its place, its color and
// `extra` (texture scale x and y, lit, layer); lit is 2 for a ground whose texture no program has chosen, 3 if its
// colour neither.
#pragma once

namespace breve::render {

// A texture, projected along the axes of a shape.
inline constexpr const char* kTiles = R"(
vec4 tiles(sampler2D image, vec3 own, vec3 own_normal, vec2 tile) {
  vec3 w = pow(abs(normalize(own_normal)), vec3(6));
  w /= w.x + w.y + w.z;
  vec3 p = own / vec3(max(tile.x, 1e-6), max(tile.y, 1e-6), max(tile.x, 1e-6));
  return w.x * texture(image, vec2(p.z, -own.y / max(tile.y, 1e-6))) +
         w.y * texture(image, vec2(p.x, own.z / max(tile.y, 1e-6))) +
         w.z * texture(image, vec2(p.x, -own.y / max(tile.y, 1e-6)));
}
)";

// Colours that are written, as numbers of light.
inline constexpr const char* kLinear = R"(
vec3 linear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
)";

// Fog hides by distance from the eye; where there is no eye, by depth.
inline constexpr const char* kFog = R"(
uniform vec3 eye, sight, fog_color;  // sight: of an orthographic view, else 0; the colour is linear
uniform float fog_start, fog_end, fog_power;
float away_of(vec3 at) { return sight == vec3(0) ? length(eye - at) : dot(at - eye, sight); }
float fog_of(float away) {
  if (fog_power <= 0.0) return 0.0;
  return 1.0 - pow(1.0 - clamp((away - fog_start) / max(fog_end - fog_start, 1e-6), 0.0, 1.0), fog_power);
}
)";

// Bodies have a program for each combination of `disc`, `textured`, `holes` (of the texture), `shadows`, `mirror` (0.0
// or 1.0) and `mode` (0: plain colours, 1: lights, 2: studio), which are macros: a renderer in software computes both
// sides of every `if` whose condition is a uniform.
inline constexpr const char* kBodyVertex = R"(
in vec3 position, normal, tint;
in vec4 row0, row1, row2, color, extra;
uniform mat4 view, projection, shadow_matrix;
uniform float outline, layers, tinted, shadow_texel_slope, shadow_clear;
uniform vec3 right, up;
uniform vec4 clip_plane;
out vec2 corner;
out vec3 world, world_normal, own, own_normal;
out vec4 surface, shadow_place;
flat out float lit;
flat out vec2 tile;
flat out vec2 reach;
void main() {
  vec3 x = vec3(row0.x, row1.x, row2.x), y = vec3(row0.y, row1.y, row2.y), z = vec3(row0.z, row1.z, row2.z);
  vec3 scale = vec3(length(x), length(y), length(z));
  vec4 p = vec4(position, 1);
  world = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
  corner = position.xy * 1.06;
  if (disc > 0.5) world = vec3(row0.w, row1.w, row2.w) + scale.x * (right * corner.x + up * corner.y);
  if (outline > 0.0) {
    vec3 out_way = mat3(x / scale.x, y / scale.y, z / scale.z) * sign(position) * step(1e-4, abs(position));
    vec3 round_way = world - vec3(row0.w, row1.w, row2.w);
    bool boxlike = dot(abs(normal), vec3(1)) < 1.001;
    world += outline * (boxlike ? out_way : normalize(round_way + vec3(1e-9)));
  }
  // The cofactors of the place's matrix turn normals.
  world_normal = cross(y, z) * normal.x + cross(z, x) * normal.y + cross(x, y) * normal.z;
  own = position * scale;
  own_normal = normal / max(scale, vec3(1e-12));
  surface = vec4(tinted > 0.5 ? tint : color.rgb, color.a);
  lit = extra.z;
  tile = extra.xy;
  // Some texels along the normal, more than the soft edge reaches, lie clear of the face itself: a face that the light
  // grazes does not shade itself in stripes. A square has the place of the sphere's middle, from which each pixel goes along
  // its own normal.
  vec3 middle = vec3(row0.w, row1.w, row2.w);
  shadow_place = shadow_matrix * vec4(disc > 0.5 ? middle : world, 1);
  float off = shadow_clear * shadow_texel_slope * shadow_place.w;
  reach = vec2(scale.x, scale.x + off);
  if (disc < 0.5) shadow_place = shadow_matrix * vec4(world + off * normalize(world_normal), 1);
  gl_ClipDistance[0] = dot(vec4(world, 1), clip_plane);
  gl_Position = projection * (view * vec4(world, 1));
  // In a flat world what was made later lies on top, and an outline below its own body.
  if (layers > 0.0) gl_Position.z = gl_Position.w * (1.0 - 2.0 * (extra.w + (outline > 0.0 ? 0.5 : 1.0)) / layers);
}
)";

inline constexpr const char* kBodyFragment = R"(
in vec3 world, world_normal, own, own_normal;
in vec4 surface, shadow_place;
flat in float lit;
flat in vec2 tile;
flat in vec2 reach;  // of a square: the sphere's radius, and the same with the distance that clears its shadow
uniform vec3 sky, ground, horizon, key;
uniform vec3 light_place[8], light_ambient[8], light_diffuse[8], light_specular[8];
uniform int lights;
uniform float outline, fill, haze_start, haze_end, mirror_height;
in vec2 corner;
uniform mat4 shadow_matrix;
uniform float shadow_ring, shadow_bias;  // ring: a part of the map
uniform int shadow_samples;
uniform vec3 right, up;
uniform vec2 picture;
uniform sampler2D image, reflection;
uniform sampler2DShadow shadow_map;
out vec4 result;

float lit_part(vec3 n) {
  if (shadows < 0.5) return 1.0;
  vec4 place = disc > 0.5 ? shadow_place + shadow_matrix * vec4(reach.y * n, 0) : shadow_place;
  vec3 p = place.xyz / place.w * 0.5 + 0.5;
  if (place.w <= 0.0 || any(lessThan(p.xy, vec2(0))) || any(greaterThan(p.xy, vec2(1)))) return 1.0;
  p.z = min(p.z, 0.999999) - shadow_bias;  // what is behind the frustum is shaded by what is in it
  // A turned ring of places: soft edges with few samples.
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  // From the outside in. Where half of them agree, the rest would agree: most of the picture is lit or shaded wholly.
  // The number is a uniform: a loop of known length would be unrolled, and all of it computed.
  float sum = 0.0, count = float(shadow_samples), seen = 0.0;
  for (int i = shadow_samples - 1; i >= 0; --i) {
    float a = turn + 2.3999632 * float(i);
    vec2 way = sqrt((float(i) + 0.5) / count) * shadow_ring * vec2(cos(a), sin(a));
    sum += texture(shadow_map, vec3(p.xy + way, p.z));
    seen += 1.0;
    if (2 * i == shadow_samples && (sum == 0.0 || sum == seen)) break;
  }
  return sum / seen;
}

void main() {
  vec3 n = normalize(world_normal), at = world;
  float cover = 1.0;
  if (disc > 0.5) {
    float away_from_center = length(corner);
    cover = clamp((1.0 - away_from_center) / max(fwidth(away_from_center), 1e-5) + 0.5, 0.0, 1.0);
    if (cover < 0.125) discard;
    float out_of_it = sqrt(max(0.0, 1.0 - away_from_center * away_from_center));
    vec3 out_way = cross(right, up);
    n = normalize(right * corner.x + up * corner.y + out_way * out_of_it);
    at = world + reach.x * out_of_it * out_way;  // on the sphere that the square stands for
  }
  vec3 to_eye = normalize(eye - world);
  if (sight != vec3(0)) to_eye = -sight;
  if (disc < 0.5 && dot(n, to_eye) < 0.0 && !gl_FrontFacing) n = -n;
  vec4 c = vec4(linear(surface.rgb), surface.a);
  if (textured > 0.5) {
    // The ground has a faint pattern and colour where no program has chosen them, so that moving bodies stand out.
    vec4 pattern = tiles(image, own, own_normal, tile);
    bool quiet = lit > 1.5 && fill > 0.5;
    c *= quiet ? mix(vec4(1), pattern, vec4(vec3(0.38), 1)) : pattern;
    if (holes > 0.5 && c.a < 0.01) discard;
  }
  if (lit > 2.5 && fill > 0.5) c.rgb = mix(vec3(dot(c.rgb, vec3(0.21, 0.72, 0.07))), c.rgb, 0.62);
  if (outline > 0.0) c.rgb *= 0.16;
  vec3 color = c.rgb;
  if (lit > 0.5 && outline == 0.0 && mode == 1) {
    vec3 irradiance = vec3(0), shine = vec3(0);
    for (int i = 0; i < lights; ++i) {
      vec3 to_light = normalize(light_place[i] - at);
      float facing = max(0.0, dot(n, to_light));
      float seen = i == 0 && facing > 0.0 ? lit_part(n) : 1.0;
      irradiance += light_ambient[i] + light_diffuse[i] * facing * seen;
      vec3 halfway = normalize(to_light + to_eye);
      shine += (light_specular[i] + fill * 0.18) * seen * step(0.0001, facing) * pow(max(0.0, dot(n, halfway)), 60.0);
    }
    irradiance += fill * mix(ground, sky, 0.5 + 0.5 * n.y) * 0.20;
    color = c.rgb * irradiance + shine;
  } else if (lit > 0.5 && outline == 0.0 && mode == 2) {
    float wrap = 0.5 + 0.5 * dot(n, key);
    float rim = pow(1.0 - max(0.0, dot(n, to_eye)), 3.0);
    vec3 halfway = normalize(key + to_eye);
    color = c.rgb * (0.14 + 1.0 * wrap * wrap + 0.16 * mix(ground, sky, 0.5 + 0.5 * n.y)) + 0.10 * rim * sky +
            0.16 * pow(max(0.0, dot(n, halfway)), 40.0);
  }
  if (mirror > 0.0 && n.y > 0.9 && abs(world.y - mirror_height) < 1e-2) {
    vec4 seen = texture(reflection, gl_FragCoord.xy / picture);
    float slant = mix(0.22, 0.75, pow(1.0 - max(0.0, dot(n, to_eye)), 4.0));
    color = mix(color, seen.rgb, mirror * slant * seen.a);
  }
  float away = away_of(world);
  color = mix(color, fog_color, fog_of(away));
  if (haze_end > 0.0) color = mix(color, horizon, smoothstep(haze_start, haze_end, away));
  result = vec4(color, disc > 0.5 ? cover : c.a);
}
)";

inline constexpr const char* kDepthVertex = R"(
in vec3 position;
in vec4 row0, row1, row2;
uniform mat4 shadow_matrix;
uniform vec3 eye;
uniform float disc;
out vec2 corner;
void main() {
  vec4 p = vec4(position, 1);
  vec3 world = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
  corner = position.xy;
  if (disc > 0.5) {  // a sphere: a square through its middle, towards the light, of which the shader keeps a circle
    vec3 center = vec3(row0.w, row1.w, row2.w), way = center - eye;
    vec3 right = normalize(cross(abs(way.y) > 0.9 * length(way) ? vec3(1, 0, 0) : vec3(0, 1, 0), way));
    // The cone from the light that touches the sphere is a little wider there than the sphere.
    float radius = length(vec3(row0.x, row1.x, row2.x)), sine = radius / max(length(way), 1.01 * radius);
    world = center + radius * inversesqrt(1.0 - sine * sine) * (right * corner.x + normalize(cross(way, right)) * corner.y);
  }
  gl_Position = shadow_matrix * vec4(world, 1);
}
)";
inline constexpr const char* kDepthFragment = R"(
in vec2 corner;
uniform float disc;
void main() {
  if (disc > 0.5 && dot(corner, corner) > 1.0) discard;
}
)";

// What a texture with holes leaves of a body.
inline constexpr const char* kHolesVertex = R"(
in vec3 position, normal;
in vec4 row0, row1, row2, color, extra;
uniform mat4 shadow_matrix;
out vec3 own, own_normal;
flat out vec2 tile;
flat out float alpha;
void main() {
  vec4 p = vec4(position, 1);
  vec3 scale = vec3(length(vec3(row0.x, row1.x, row2.x)), length(vec3(row0.y, row1.y, row2.y)),
                    length(vec3(row0.z, row1.z, row2.z)));
  own = position * scale;
  own_normal = normal / max(scale, vec3(1e-12));
  tile = extra.xy;
  alpha = color.a;
  gl_Position = shadow_matrix * vec4(dot(row0, p), dot(row1, p), dot(row2, p), 1);
}
)";
inline constexpr const char* kHolesFragment = R"(
in vec3 own, own_normal;
flat in vec2 tile;
flat in float alpha;
uniform sampler2D image;
void main() {
  // KEEP IN STEP: what `casts` in shadow.cpp says of bodies without a texture.
  if (alpha * tiles(image, own, own_normal, tile).a <= 0.3) discard;
}
)";

inline constexpr const char* kBackdropVertex = R"(
uniform vec3 right, up, back;
uniform float slope, aspect;
out vec3 way;
out vec2 place;
void main() {
  place = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  way = right * place.x * slope * aspect + up * place.y * slope - back;
  gl_Position = vec4(place, 1, 1);
}
)";

inline constexpr const char* kBackdropFragment = R"(
in vec3 way;
in vec2 place;
uniform vec3 color, horizon, zenith;
uniform int kind;  // 0: one colour, 1: sky, 2: image, 3: mountains, 4: sky box
uniform float flat_view;
uniform vec2 scroll;
uniform sampler2D image, side0, side1, side2, side3, side4, side5;
out vec4 result;

float chance(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }
float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(chance(i), chance(i + vec2(1, 0)), f.x), mix(chance(i + vec2(0, 1)), chance(i + vec2(1, 1)), f.x), f.y);
}
float layers(vec2 p) {
  float sum = 0.0, part = 0.5;
  for (int i = 0; i < 5; ++i, p = p * 2.03 + 7.1, part *= 0.5) sum += part * noise(p);
  return sum;
}
vec3 sky_at(float height) {
  return height < 0.0 ? horizon : mix(horizon, zenith, 1.0 - exp(-2.6 * height));
}
/// Ridges about the horizon, each paler and higher than the one in front of it.
vec3 mountains(vec3 d) {
  float height = d.y / max(length(d.xz), 1e-4), angle = atan(d.x, d.z);
  vec2 round_place = vec2(sin(angle), cos(angle));
  float cloud = smoothstep(0.45, 0.85, layers(d.xz / max(d.y + 0.08, 0.02) * 0.9)) * smoothstep(0.02, 0.25, d.y);
  vec3 c = mix(sky_at(d.y), vec3(0.93, 0.95, 0.97), 0.8 * cloud);
  for (int i = 0; i < 3; ++i) {
    float top = 0.30 - 0.085 * float(i);
    float ridge = top * layers(round_place * (2.5 + 1.7 * float(i)) + 11.0 * float(i)) * 1.15 - 0.012;
    vec3 rock = mix(mix(vec3(0.16, 0.20, 0.27), horizon, 0.62 - 0.2 * float(i)), vec3(0.9, 0.93, 0.97),
                    i == 0 ? 0.75 * smoothstep(0.10, 0.17, height) : 0.0);
    c = mix(c, rock, smoothstep(0.0, 0.003, ridge - height));
  }
  return mix(c, vec3(0.20, 0.24, 0.22), smoothstep(0.0, 0.25, -height - 0.02) * 0.6);
}
vec3 box(vec3 d) {
  vec3 a = abs(d);
  if (a.z >= a.x && a.z >= a.y)
    return d.z < 0.0 ? texture(side0, vec2(d.x, -d.y) / a.z * 0.5 + 0.5).rgb
                     : texture(side1, vec2(-d.x, -d.y) / a.z * 0.5 + 0.5).rgb;
  if (a.x >= a.y)
    return d.x < 0.0 ? texture(side2, vec2(-d.z, -d.y) / a.x * 0.5 + 0.5).rgb
                     : texture(side3, vec2(d.z, -d.y) / a.x * 0.5 + 0.5).rgb;
  return d.y > 0.0 ? texture(side4, vec2(d.x, d.z) / a.y * 0.5 + 0.5).rgb
                   : texture(side5, vec2(d.x, -d.z) / a.y * 0.5 + 0.5).rgb;
}
void main() {
  vec3 d = normalize(way);
  vec3 c = color;
  if (kind == 1) c = flat_view > 0.5 ? mix(color, zenith, 0.12 * dot(place, place)) : sky_at(d.y);
  if (kind == 2) c = texture(image, vec2(place.x, -place.y) * 0.5 + 0.5 + scroll).rgb;
  if (kind == 3) c = mountains(d);
  if (kind == 4) c = box(d);
  // A little noise, so that the steps of eight bits are not seen as bands.
  if (kind != 0) c += c * (chance(gl_FragCoord.xy) - 0.5) * 0.012;
  result = vec4(c, 1);
}
)";

inline constexpr const char* kLineVertex = R"(
in vec4 row0, row1, color;  // from and width, to and pattern
uniform mat4 view, projection;
uniform vec2 picture;
uniform float near;
out float along, across;
out vec3 at;
flat out float pattern, half_width;
flat out vec4 paint;
void main() {
  vec3 from = row0.xyz, to = row1.xyz;
  vec4 a = projection * (view * vec4(row0.xyz, 1)), b = projection * (view * vec4(row1.xyz, 1));
  // The part behind the camera is cut off.
  if (a.w < near && b.w < near) { gl_Position = vec4(2, 2, 2, 1); return; }
  if (a.w < near) {
    float part = (near - a.w) / (b.w - a.w);
    a = mix(a, b, part);
    from = mix(from, to, part);
  }
  if (b.w < near) {
    float part = (near - b.w) / (a.w - b.w);
    b = mix(b, a, part);
    to = mix(to, from, part);
  }
  vec2 pa = a.xy / a.w * picture * 0.5, pb = b.xy / b.w * picture * 0.5;
  float size = length(pb - pa);
  vec2 way = size > 1e-4 ? (pb - pa) / size : vec2(1, 0);
  vec2 side = vec2(-way.y, way.x);
  half_width = 0.5 * max(row0.w, 1.0);
  bool last = gl_VertexID % 2 == 1;
  across = (gl_VertexID / 2 == 1 ? 1.0 : -1.0) * (half_width + 0.5);
  along = last ? size : 0.0;
  at = last ? to : from;
  vec4 p = last ? b : a;
  gl_Position = p + vec4(side * across / picture * 2.0 * p.w, -2e-5 * p.w, 0);
  pattern = row1.w;
  paint = color;
}
)";

inline constexpr const char* kLineFragment = R"(
in float along, across;
in vec3 at;
flat in float pattern, half_width;
flat in vec4 paint;
out vec4 result;
void main() {
  int bit = int(mod(along * 0.5, 16.0));
  if ((int(pattern) >> bit & 1) == 0) discard;
  vec3 color = mix(linear(paint.rgb), fog_color, fog_of(away_of(at)));
  result = vec4(color, paint.a * clamp(half_width + 0.5 - abs(across), 0.0, 1.0));
}
)";

inline constexpr const char* kSpriteVertex = R"(
in vec4 row0, row1, color;  // center and size; heading, point
uniform mat4 view, projection;
uniform vec2 picture;
out vec2 corner;
flat out vec4 paint;
flat out vec3 at;
flat out float point;
void main() {
  at = row0.xyz;
  corner = vec2(gl_VertexID % 2, gl_VertexID / 2) * 2.0 - 1.0;
  float c = cos(row1.x), s = sin(row1.x);
  vec2 turned = vec2(c * corner.x - s * corner.y, s * corner.x + c * corner.y);
  vec4 p = view * vec4(row0.xyz, 1);
  point = row1.y;
  paint = color;
  if (point > 0.5) {
    gl_Position = projection * p;
    gl_Position.xy += corner * row0.w / picture * gl_Position.w;
  } else {
    p.xy += turned * row0.w * 0.5;
    gl_Position = projection * p;
  }
}
)";

inline constexpr const char* kSpriteFragment = R"(
in vec2 corner;
flat in vec4 paint;
flat in vec3 at;
flat in float point;
uniform sampler2D image;
uniform float glow;
out vec4 result;
void main() {
  vec4 c = vec4(linear(paint.rgb), paint.a);
  if (point > 0.5) {
    if (dot(corner, corner) > 1.0) discard;
  } else {
    c *= texture(image, vec2(corner.x, -corner.y) * 0.5 + 0.5);
  }
  // Fog dims a light map, which is added to the picture; other sprites take its colour.
  float fog = fog_of(away_of(at));
  result = glow > 0.5 ? vec4(c.rgb, c.a * (1.0 - fog)) : vec4(mix(c.rgb, fog_color, fog), c.a);
}
)";

inline constexpr const char* kPlainVertex = R"(
in vec3 position;
in vec4 color;
uniform mat4 view, projection;
out vec4 paint;
out vec3 at;
void main() {
  paint = color;
  at = position;
  gl_Position = projection * (view * vec4(position, 1));
}
)";
inline constexpr const char* kPlainFragment = R"(
in vec4 paint;
in vec3 at;
out vec4 result;
void main() { result = vec4(mix(linear(paint.rgb), fog_color, fog_of(away_of(at))), paint.a); }
)";

inline constexpr const char* kSheetVertex = R"(
uniform mat4 view, projection;
uniform vec3 corner, across, along;
out vec2 place;
out vec3 at;
void main() {
  place = vec2(gl_VertexID % 2, gl_VertexID / 2);
  at = corner + across * place.x + along * place.y;
  gl_Position = projection * (view * vec4(at, 1));
}
)";
inline constexpr const char* kSheetFragment = R"(
in vec2 place;
in vec3 at;
uniform sampler2D image;
uniform float least, most;  // alpha of the cells that are drawn
out vec4 result;
void main() {
  vec4 c = texture(image, place);
  if (c.a < least || c.a >= most) discard;
  result = vec4(mix(c.rgb, fog_color, fog_of(away_of(at))), c.a);
}
)";

inline constexpr const char* kTextVertex = R"(
in vec4 row0, row1, color;  // place and size in pixels from the top left; the same in the image, or a plate if its width is 0
uniform vec2 picture;
out vec2 place, inside;
flat out vec4 paint;
flat out vec3 plate;
void main() {
  vec2 corner = vec2(gl_VertexID % 2, gl_VertexID / 2);
  vec2 p = row0.xy + row0.zw * corner;
  place = row1.xy + row1.zw * corner;
  inside = row0.zw * corner;
  plate = vec3(row0.zw, row1.z > 0.0 ? 0.0 : 1.0);
  paint = color;
  gl_Position = vec4(p.x / picture.x * 2.0 - 1.0, 1.0 - p.y / picture.y * 2.0, 0, 1);
}
)";
inline constexpr const char* kTextFragment = R"(
in vec2 place, inside;
flat in vec4 paint;
flat in vec3 plate;
uniform sampler2D image;
out vec4 result;
void main() {
  float cover = texture(image, place).r;
  if (plate.z > 0.5) {
    float round_by = min(min(plate.x, plate.y) * 0.3, 10.0);
    vec2 q = abs(inside - plate.xy * 0.5) - plate.xy * 0.5 + round_by;
    cover = clamp(0.5 - (length(max(q, vec2(0))) + min(max(q.x, q.y), 0.0) - round_by), 0.0, 1.0);
  }
  result = vec4(linear(paint.rgb), paint.a * cover);
}
)";

}  // namespace breve::render

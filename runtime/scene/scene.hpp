// What there is to see in a world at one moment, as plain data: whoever draws it needs nothing else. Lengths are the
// program's own units; colours are red, green, blue and alpha from 0 to 1, encoded as sRGB, as scripts give them.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <numbers>
#include <string>
#include <vector>

#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"
#include "runtime/scene/plot.hpp"

namespace breve {

using Vector3f = Eigen::Vector3f;
using Vector4f = Eigen::Vector4f;
using Transform = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;  // world = transform * (x, y, z, 1)

inline constexpr std::uint32_t kNoTexture = 0xffffffffU;

/// Triangles that many instances share, counter-clockwise seen from outside.
struct SceneMesh {
  enum class Form : std::uint8_t { Sphere, Box, Round, Facets, Ground } form = Form::Facets;
  std::vector<Vector3f> positions, normals;
  std::vector<Eigen::Vector2f> uvs;
  std::vector<Vector3f> colors;  // of each vertex, in place of the instance's; empty: none
  std::vector<std::uint32_t> indices;
  std::uint64_t revision = 0;         // another number when its content is another
  Vector3f reach = Vector3f::Zero();  // no vertex is farther from the origin along an axis
  bool two_sided = false;
};

struct SceneTexture {
  ObjectId image;
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // rows from the top
  std::uint64_t revision = 0;      // another number when the pixels are others
  bool clear = false;              // some pixels let through what is behind them
};

/// What of a look no program has chosen: a renderer may draw it quieter, so that moving bodies stand out.
enum class Unchosen : std::uint8_t { Nothing, Texture, TextureAndColor };

struct SceneInstance {
  ObjectId object{};
  Transform transform = Transform::Zero();  // rotation and scale, then location
  Vector4f color = Vector4f::Zero();
  std::uint32_t mesh = 0, texture = kNoTexture;
  Eigen::Vector2f texture_scale{1.0F, 1.0F};  // length units of a tile
  bool shadow = true;                         // it casts one
  bool fixed = false;  // a Stationary or Terrain: it catches shadows, and does not decide what is framed
  bool lit = true;
  Unchosen unchosen = Unchosen::Nothing;
};

struct SceneLine {
  Vector3f from = Vector3f::Zero(), to = Vector3f::Zero();
  Vector4f color = Vector4f::Zero();
  float width = 1;                 // pixels
  std::uint16_t pattern = 0xffff;  // bit i: two pixels of it are drawn
};

/// Drawn over all else, with a head at `to`.
struct SceneArrow {
  Vector3f from = Vector3f::Zero(), to = Vector3f::Zero();
  Vector4f color = Vector4f::Zero();
};

/// A picture that faces the camera, or a point.
struct SceneSprite {
  ObjectId object;
  Vector3f center = Vector3f::Zero();
  float size = 1;     // its side, length units; of a point: its diameter in pixels
  float heading = 0;  // rad, counter-clockwise on the screen
  Vector4f color = Vector4f::Zero();
  std::uint32_t texture = kNoTexture;
  bool glow = false;   // added to what is behind it
  bool point = false;  // a disc of `size` pixels
};

/// A rectangle of coloured cells: a flat grid of patches.
struct SceneSheet {
  ObjectId object;
  Vector3f corner = Vector3f::Zero(), across = Vector3f::Zero(),
           along = Vector3f::Zero();  // the low corner and the two sides
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> rgba;  // row after row from the corner, along `across` first
  std::uint64_t revision = 0;
  bool clear = false;  // some cells let through what is behind them
};

struct SceneVertex {
  Vector3f position = Vector3f::Zero();
  Vector4f color = Vector4f::Zero();
};

/// Text that belongs to a place in the world.
struct SceneLabel {
  ObjectId object;
  Vector3f location = Vector3f::Zero();  // the text stands above it
  std::string text;
};

/// Text over the picture.
struct SceneText {
  std::string text;
  float x = 0, y = 0;  // -1 to 1, of the baseline's begin
  Vector3f color = Vector3f::Zero();
};

struct SceneCamera {
  ObjectId object;  // null: the main one
  Vector3 target{0, 0, 0}, offset{0, 0, 30};
  double pitch = 0, yaw = 0;                           // rad
  double field_of_view = 40 * std::numbers::pi / 180;  // rad, vertical
  double far_plane = 500;
  bool automatic = false;     // the program has set none: whoever draws frames the whole scene
  bool orthographic = false;  // of a flat world: half the height is distance * tan(field of view / 2)
  bool text = true;
  double x = 0, y = 0, width = 0, height = 0;  // a sub-window, pixels from the lower left; the main one: all 0
};

struct SceneLight {
  Vector3 position{0, 0, 0};
  Vector3f ambient = Vector3f::Zero(), diffuse = Vector3f::Zero(), specular = Vector3f::Zero();
};

struct SceneFog {
  bool enabled = false;
  float start = 10, end = 40, intensity = 0.1F;
  Vector3f color = Vector3f::Zero();
};

struct SceneBackdrop {
  Vector3f color = Vector3f::Zero();
  std::uint32_t texture = kNoTexture;
  float scroll_x = 0, scroll_y = 0;  // texture widths by which it has slid
  bool mountains = false;
  std::array<std::uint32_t, 6> skybox{kNoTexture, kNoTexture, kNoTexture, kNoTexture, kNoTexture, kNoTexture};
};

struct SceneFlags {
  bool lighting = false, shadows = false, reflections = false, outline = false, text = true;
  bool blur = false;
  float blur_factor = 0.1F;
  float text_scale = 1;
  std::uint64_t clears = 0;
  bool every_frame = true;  // else a window may leave out pictures
};

/// Room is kept from one moment to the next. Meshes and textures keep their numbers as long as something uses them.
struct Scene {
  int dimension = 3;
  double time = 0;  // s
  std::uint64_t iteration = 0;
  std::deque<SceneMesh> meshes;  // by number; an empty one is not used
  std::deque<SceneTexture> textures;
  std::vector<SceneInstance> instances;
  std::vector<SceneLine> lines;
  std::vector<SceneVertex> triangles;  // of polygons that scripts draw, three for each
  std::vector<SceneSprite> sprites;
  std::vector<SceneSheet> sheets;
  std::vector<SceneLabel> labels;
  std::vector<SceneText> texts;
  std::vector<ScenePlot> plots;  // drawn over the picture
  std::vector<SceneArrow> arrows;
  std::vector<SceneCamera> cameras;  // the main one first
  std::vector<SceneLight> lights;
  SceneFog fog;
  SceneBackdrop backdrop;
  SceneFlags flags;
};

}  // namespace breve

// What a renderer works with: its context, what is uploaded, and the passes of a picture. Behind renderer.hpp.
#pragma once

#include "runtime/render/batches.hpp"
#include "runtime/render/context.hpp"
#include "runtime/render/marks.hpp"
#include "runtime/render/renderer.hpp"
#include "runtime/render/target.hpp"

namespace breve::render {

/// Light 0 as the camera of the shadow map.
struct ShadowLens {
  bool on = false;
  Matrix4f matrix = Matrix4f::Identity();
  float texel_slope = 0;  // width of a texel, divided by its distance from the light
  float ring = 0;         // texels: the radius of the soft edge
  float clear = 0;        // texels by which what is shaded is moved along its normal
};

/// The flat top that reflects: that of the largest fixed box.
struct Mirror {
  bool on = false;
  float height = 0;
};

/// All that one pass over the bodies needs to know.
struct Pass {
  const Scene* scene = nullptr;
  const SceneCamera* camera = nullptr;
  const Lens* lens = nullptr;
  int width = 0, height = 0;
  const SceneInstance* ground = nullptr;  // null: none
  ShadowLens shadow;
  Mirror mirror;                      // what it shows is in the reflection's target
  bool reflected = false;             // this pass draws the reflection
  std::vector<float> clear_sheets{};  // z of the sheets that let through what is behind them, in order
};

/// Colours of sky and haze, linear.
struct Air {
  Vector3f color, horizon, zenith;
};

/// A rectangle of the target: as OpenGL counts, from the lower left corner.
struct Window {
  int left = 0, bottom = 0, width = 0, height = 0;
  bool empty() const { return width <= 0 || height <= 0; }
};

/// Cells of a sheet.
enum class Cells : std::uint8_t { Opaque, Clear, All };

struct Renderer::Work {
  explicit Work(const Settings& given);
  ~Work();
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// Of work that is not drawing, and is not counted.
  Poll poll() const {
    return meter ? Poll([this] { meter(0); }) : Poll();
  }
  // renderer.cpp
  void paint(const Scene& scene, int width, int height, Picture& picture);
  void paint_camera(const Scene& scene, const SceneCamera& camera, int width, int height);
  void paint_reflection(Pass pass);
  void frame_windows(const Scene& scene, int width, int height);
  void read(const Lens& lens, Picture& picture);
  void blur(const Scene& scene, Picture& picture);
  // bodies.cpp
  void draw_backdrop(const Pass& pass);
  void draw_bodies(const Pass& pass, Wanted wanted = nullptr);
  /// Sorted, and in the buffer of instances. @param others  what is drawn among the transparent ones
  Batches upload_bodies(const Pass& pass, const std::vector<Place>& others, Wanted wanted = nullptr);
  void draw_opaque(const Pass& pass, const Batches& all);
  void draw_transparent(const Pass& pass, const Batch& one);
  void draw_batch(const Pass& pass, const Batch& batch, bool blended, float outline = 0);
  void draw_pieces(const MeshBuffer& buffer, const Batch& batch, bool blended);
  const Program& body_program(const Pass& pass, const Batch& batch);
  void set_body_uniforms(const Pass& pass, const Program& program);
  void set_lights(const Pass& pass, const Program& program);
  Air air_of(const Scene& scene) const;
  // layers.cpp
  void draw_layers(const Pass& pass, const Canvas& canvas);
  void draw_flat_layers(const Pass& pass, const Canvas& canvas);
  void draw_sheet(const Pass& pass, std::size_t number, Cells cells);
  void draw_sprites(const Pass& pass, const std::vector<const SceneSprite*>& sprites, const Canvas& canvas);
  // uploads.cpp
  const MeshBuffer& mesh(const Scene& scene, std::uint32_t number);
  void bind_texture(const Scene& scene, std::uint32_t number, unsigned unit);
  // shadow.cpp
  ShadowLens draw_shadows(const Scene& scene, const Lens& seen_by, int height);
  ShadowLens shadows;  // of this picture: all of its cameras see the same

  Settings settings;
  Context context;
  std::optional<Context::Use> use;  // while it is made and destroyed
  Shaders shaders;
  Marks marks;
  Buffer instances;
  VertexArray nothing;  // for shaders that make their vertices themselves
  std::map<std::uint32_t, std::unique_ptr<MeshBuffer>> meshes;
  std::map<std::uint32_t, std::unique_ptr<TextureBuffer>> textures;
  std::map<std::size_t, std::unique_ptr<TextureBuffer>> sheets;
  std::unique_ptr<Target> target, reflection;
  std::unique_ptr<ShadowTarget> shadow;
  std::optional<SceneCamera> own_camera;
  std::optional<PicturePart> part;  // that is needed
  Window needed;                    // the same in the picture that is being drawn
  SceneCamera last_camera;
  Framing framing;
  CostMeter meter;
  Counters counters;
  std::vector<const Program*> ready;       // those for bodies that have the uniforms of this pass
  std::vector<std::uint8_t> last_picture;  // that motion blur mixes with
  std::uint64_t last_clears = 0;
};

/// The largest fixed instance, if it is larger than all that moves; null: none.
const SceneInstance* ground_of(const Scene& scene);

}  // namespace breve::render

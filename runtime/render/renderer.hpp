// Draws scenes into main memory. A renderer is used by one thread at a time; several may draw at once.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/cost_meter.hpp"
#include "runtime/scene/camera_math.hpp"
#include "runtime/scene/picture.hpp"

namespace breve::render {

enum class Look : std::uint8_t {
  Full,  // what a program leaves open is made good-looking: soft light, sky, haze
  Plain  // nothing but what the program says: its colours and its lights
};

using GlFunction = void (*)();

/// An OpenGL context that somebody else has made: 3.3 or later, core profile. Nothing else draws with it.
struct ForeignContext {
  /// Makes it current in the calling thread, or, for false, releases it there. False: this failed.
  std::function<bool(bool current)> make_current;
  /// The function of this name ("glClear"), or null. Called while the context is current.
  std::function<GlFunction(const char* name)> address;
};

struct Settings {
  int samples = 4;  // of a pixel: 1, 2 or 4
  Look look = Look::Full;
  std::string font;                       // a file; empty: DejaVu Sans
  std::optional<ForeignContext> context;  // none: OSMesa
};

/// Of one picture.
struct Counters {
  std::uint64_t draw_calls = 0, instances = 0, triangles = 0, uploads = 0;  // uploads: meshes and textures
};

class Renderer {
 public:
  /// @throws Error{Unsupported} if OSMesa is missing or the given context is not OpenGL 3.3, Error{File} if the font
  /// file
  ///         is not a font
  explicit Renderer(const Settings& settings = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// The scene as its cameras see it.
  /// @throws Error{Argument} for a size that cannot be drawn, Error{Memory} if there is no room for it
  void paint(const Scene& scene, int width, int height, Picture& picture);
  /// The main camera in place of the scene's from now on; none: the scene's.
  void set_camera(const std::optional<SceneCamera>& camera);
  /// Only this part of the pictures is needed from now on: the rest of their pixels is undefined. None: all of it.
  void set_part(const std::optional<PicturePart>& part);
  /// From now on called before each piece of a picture is drawn. An exception of it ends the picture, and the renderer
  /// can then only be destroyed. Costs a little, since pieces are waited for.
  void set_meter(CostMeter meter);
  /// The main camera of the last picture, as it was framed.
  const SceneCamera& camera() const;
  const Counters& counters() const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace breve::render

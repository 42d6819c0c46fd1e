// Camera, lights, backdrop and overlay text as scripts set them: state only, read by whoever draws. Nothing here is
// read by the simulation except the pans, which the controller's `iterate` advances.
#pragma once

#include <array>
#include <cstdint>
#include <memory_resource>
#include <string>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"
#include "runtime/world/camera.hpp"

namespace breve {

inline constexpr std::size_t kLightCount = 8;
inline constexpr std::size_t kOverlayTextCount = 8;

/// Colours are RGB, components 0 to 1.
struct LightState {
  Vector3 position{0, 0, 0};
  Vector3 ambient{0.1, 0.1, 0.1};
  Vector3 diffuse{0.9, 0.9, 0.9};
  Vector3 specular{0, 0, 0};
};

struct FogState {
  bool enabled = false;
  double start = 10, end = 40;  // length units from the camera
  double intensity = 0.1;
  Vector3 color{0.8, 0.8, 0.8};
};

struct BackdropState {
  explicit BackdropState(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : skybox(memory) {}

  Vector3 color{0.5, 0.7, 1};
  ObjectId texture;                            // an Image object or null
  double scroll_x = 0.001, scroll_y = 0.0001;  // texture widths per drawn frame
  std::pmr::vector<std::pmr::string> skybox;   // six files: front, back, left, right, top, bottom; empty: none
  std::array<ObjectId, 6> sides;               // their Image objects, null where a file is missing
  bool mountains = false;                      // the built-in skybox
};

/// One line of text over the view; shown while it is not empty.
struct OverlayText {
  std::pmr::string text;
  double x = -0.95, y = -0.95;  // window coordinates, -1 to 1
  Vector3 color{0, 0, 0};
};

/// What the renderer is asked to do.
struct DrawingFlags {
  bool lighting = false;
  bool shadow_volumes = false;
  bool shadows = false;
  bool reflections = false;
  bool shadow_catcher = false;  // some Stationary catches shadows: else `shadows` and `reflections` show nothing
  bool blur = false;
  bool outline = false;
  bool text = true;
  bool every_frame = true;
  bool recording = false;
  double blur_factor = 0.1;
};

/// Counting the pixels of each body that a light can see.
struct LightExposureState {
  bool detection = false;
  bool drawing = false;
  Vector3 source{0, 0, 0};
};

/// A glide of a point of the main camera: `steps` equal increments, the last of which lands on `goal` exactly.
struct Pan {
  Vector3 goal{0, 0, 0};
  std::int32_t steps = 0;  // left; 0: no pan

  /// Where the point is after one increment from `now`.
  Vector3 advance(const Vector3& now);
};

struct ViewState {
  /// @param memory  where its texts take their bytes
  explicit ViewState(std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  CameraState camera;  // the controller's main one
  Pan offset_pan, target_pan;
  bool frozen = false;  // bodies stand still until `offset_pan` is over
  ObjectId selection;   // the object that the user clicked last, or null

  std::array<LightState, kLightCount> lights;
  FogState fog;
  BackdropState backdrop;
  DrawingFlags flags;
  LightExposureState light_exposure;
  std::array<OverlayText, kOverlayTextCount> texts;
  double text_scale = 1;
  std::uint64_t clears = 0;               // how often a script asked to clear the screen
  std::int32_t mouse_x = 0, mouse_y = 0;  // window pixels, set by the host

  void save(ByteWriter& out) const;
  /// @throws Error{Image} if the image ends early
  void load(ByteReader& in);
  /// Everything but the mouse, which is the host's.
  void hash(Hasher& hasher) const;
};

}  // namespace breve

// Where a camera stands and looks. Position is held twice, as an offset from the target and as the angles that
// scripts rotate it by, so that a camera straight above its target still knows which way is up.
#pragma once

#include <memory>
#include <numbers>

#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"
#include "runtime/world/resource.hpp"

namespace breve {

struct CameraState {
  Vector3 target{0, 0, 0};
  Vector3 offset{0, 0, 30};                            // of the camera from its target, world frame, length units
  double pitch = 0;                                    // rad; positive looks up from below
  double yaw = 0;                                      // rad; 0 stands on +z of the target
  double field_of_view = 40 * std::numbers::pi / 180;  // rad, vertical
  double far_plane = 500;                              // length units, at least 1
  double x = 0, y = 0;                                 // window pixels; extra cameras only
  double width = 100, height = 100;                    // window pixels; extra cameras only
  bool enabled = true;
  bool text = true;
  ObjectId watched;  // re-aimed at this object every iteration; null: none

  double distance() const { return offset.norm(); }
  /// Stand at `target + o` and look at the target. Zero: at the target, angles kept.
  /// @throws Error{Argument} if `o` is not finite
  void set_offset(const Vector3& o);
  /// Rotate about the target: the distance is kept.
  /// @throws Error{Argument} if an angle is not finite
  void set_angles(double new_pitch, double new_yaw);
  /// @throws Error{Argument} if `metres` is not finite or negative
  void set_distance(double metres);
  /// @throws Error{Argument} if `point` is not finite
  void set_target(const Vector3& point);
  /// |z|, at least 1.
  void set_far_plane(double z);

  void save(ByteWriter& out) const;
  void load(ByteReader& in);
  void hash(Hasher& hasher) const;
};

/// The native data of a Camera object. The controller's main camera is the one in ViewState; `main` says so.
class CameraResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "camera";
  CameraState state;
  bool main = false;

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

}  // namespace breve

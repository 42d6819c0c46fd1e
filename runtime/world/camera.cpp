// Camera angles and offsets, kept in step.
#include "runtime/world/camera.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

void must_be_finite(bool finite, const char* what) {
  if (!finite) throw Error(ErrorCode::Argument, std::string(what) + " must be finite");
}

Vector3 offset_of(double distance, double pitch, double yaw) {
  return {distance * std::cos(pitch) * std::sin(yaw), 0.0 - distance * std::sin(pitch),
          distance * std::cos(pitch) * std::cos(yaw)};
}

}  // namespace

void CameraState::set_offset(const Vector3& o) {
  must_be_finite(o.allFinite(), "a camera's offset");
  const double length = o.norm();
  offset = o;
  if (length == 0) return;
  pitch = std::asin(std::clamp(-o.y() / length, -1.0, 1.0)) + 0.0;  // + 0.0: no negative zero
  const double level = length * std::cos(pitch);
  // Straight above or below the target every yaw fits: the old one stays.
  if (level < 1e-12 * length) return;
  yaw = std::asin(std::clamp(o.x() / level, -1.0, 1.0));
  if (o.z() < 0) yaw = std::numbers::pi - yaw;
}

void CameraState::set_angles(double new_pitch, double new_yaw) {
  must_be_finite(std::isfinite(new_pitch) && std::isfinite(new_yaw), "a camera's rotation");
  const double length = distance();
  pitch = new_pitch;
  yaw = new_yaw;
  offset = offset_of(length, pitch, yaw);
}

void CameraState::set_distance(double metres) {
  must_be_finite(std::isfinite(metres), "a camera's distance");
  if (metres < 0) throw Error(ErrorCode::Argument, "a camera's distance must not be negative");
  const double length = distance();
  offset = length > 0 ? Vector3(offset * (metres / length)) : offset_of(metres, pitch, yaw);
}

void CameraState::set_target(const Vector3& point) {
  must_be_finite(point.allFinite(), "a camera's target");
  target = point;
}

void CameraState::set_far_plane(double z) {
  must_be_finite(std::isfinite(z), "a camera's far plane");
  far_plane = std::max(1.0, std::abs(z));
}

void CameraState::save(ByteWriter& out) const {
  out.put(target);
  out.put(offset);
  for (double value : {pitch, yaw, field_of_view, far_plane, x, y, width, height}) out.put(value);
  out.put(enabled);
  out.put(text);
  out.put(watched);
}

void CameraState::load(ByteReader& in) {
  target = in.get_vector();
  offset = in.get_vector();
  for (double* value : {&pitch, &yaw, &field_of_view, &far_plane, &x, &y, &width, &height}) *value = in.get<double>();
  enabled = in.get_bool();
  text = in.get_bool();
  watched = in.get_object();
}

void CameraState::hash(Hasher& hasher) const {
  hasher.add(target);
  hasher.add(offset);
  for (double value : {pitch, yaw, field_of_view, far_plane, x, y, width, height}) hasher.add(value);
  hasher.add(static_cast<std::uint64_t>(enabled) * 2 + static_cast<std::uint64_t>(text));
  hasher.add(static_cast<std::uint64_t>(watched.index) << 32 | watched.generation);
}

void CameraResource::save(ByteWriter& out) const {
  out.put(main);
  state.save(out);
}

void CameraResource::hash(Hasher& hasher) const {
  hasher.add(static_cast<std::uint64_t>(main));
  state.hash(hasher);
}

std::unique_ptr<Resource> CameraResource::load(ByteReader& in) {
  auto camera = make_in<CameraResource>(in.memory());
  camera->main = in.get_bool();
  camera->state.load(in);
  return camera;
}

}  // namespace breve

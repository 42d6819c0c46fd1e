// Cameras as matrices, and the framing of scenes whose program has no camera of its own.
#include "runtime/scene/camera_math.hpp"

#include <algorithm>
#include <cmath>

namespace breve {

namespace {

// An automatic camera stands to the right of the scene and above it, as one would hold a model to look at it.
constexpr double kYaw = 0.55, kPitch = -0.30;  // rad
constexpr double kMargin = 1.06;

Eigen::Matrix3d rotation_of(double pitch, double yaw) {
  return (Eigen::AngleAxisd(yaw, Vector3::UnitY()) * Eigen::AngleAxisd(pitch, Vector3::UnitX())).toRotationMatrix();
}

Matrix4f view_matrix(const Lens& lens) {
  Matrix4f view = Matrix4f::Identity();
  view.block<1, 3>(0, 0) = lens.right.transpose();
  view.block<1, 3>(1, 0) = lens.up.transpose();
  view.block<1, 3>(2, 0) = lens.back.transpose();
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * lens.eye;
  return view;
}

void set_projection(Lens& lens, float aspect) {
  Matrix4f p = Matrix4f::Zero();
  p(0, 0) = 1 / (lens.slope * aspect);
  p(1, 1) = 1 / lens.slope;
  if (lens.orthographic) {
    p(2, 2) = -2 / (lens.far - lens.near);
    p(2, 3) = -(lens.far + lens.near) / (lens.far - lens.near);
    p(3, 3) = 1;
  } else {
    p(2, 2) = -(lens.far + lens.near) / (lens.far - lens.near);
    p(2, 3) = -2 * lens.far * lens.near / (lens.far - lens.near);
    p(3, 2) = -1;
  }
  lens.projection = p;
}

struct Ball {
  Vector3 center;
  double radius;
};

std::vector<Ball> balls_of(const Scene& scene, bool fixed, const Poll& poll) {
  std::vector<Ball> balls;
  EveryFew often(poll);
  const auto add = [&](const Vector3f& center, double radius) {
    often.count();
    balls.push_back({center.cast<double>(), radius});
  };
  for (const SceneInstance& one : scene.instances)
    if (one.fixed == fixed) add(one.transform.col(3), double{radius_of(one, scene.meshes[one.mesh])});
  if (fixed) return balls;
  for (const SceneSprite& one : scene.sprites) add(one.center, one.point ? 0.0 : double{one.size} / 2);
  for (const SceneSheet& one : scene.sheets)
    for (const float across : {0.0F, 1.0F})
      for (const float along : {0.0F, 1.0F}) add(one.corner + across * one.across + along * one.along, 0);
  for (const SceneLine& one : scene.lines)
    for (const Vector3f& end : {one.from, one.to}) add(end, 0);
  for (const SceneVertex& one : scene.triangles) add(one.position, 0);
  return balls;
}

double median(std::vector<double>& numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

/// All balls but those far outside, which are at most a thirtieth of them.
std::vector<Ball> without_outliers(std::vector<Ball> balls, const Poll& poll) {
  Vector3 center;
  std::vector<double> numbers(balls.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(balls.begin(), balls.end(), numbers.begin(), [&](const Ball& b) { return b.center[axis]; });
    center[axis] = median(numbers);
    if (poll) poll();
  }
  const auto reach = [&](const Ball& b) { return (b.center - center).norm() + b.radius; };
  std::transform(balls.begin(), balls.end(), numbers.begin(), reach);
  const auto last = numbers.begin() + static_cast<std::ptrdiff_t>(balls.size() - balls.size() / 30 - 1);
  std::nth_element(numbers.begin(), last, numbers.end());
  if (poll) poll();
  std::erase_if(balls, [&, usual = *last](const Ball& b) { return reach(b) > 3 * usual; });
  return balls;
}

std::vector<Ball> balls_to_see(const Scene& scene, const Poll& poll) {
  std::vector<Ball> balls = balls_of(scene, false, poll);
  if (balls.empty()) balls = balls_of(scene, true, poll);
  return balls.empty() ? balls : without_outliers(std::move(balls), poll);
}

/// From so far each ball is between the planes through the eye that bound the picture.
double least_distance(const std::vector<Ball>& balls, const Vector3& center, double slope, double aspect,
                      bool orthographic, const Poll& poll) {
  EveryFew often(poll);
  const Eigen::Matrix3d rotation = rotation_of(kPitch, kYaw);
  double distance = orthographic ? 1e-6 / slope : 0;
  for (const Ball& b : balls) {
    often.count();
    const Vector3 away = b.center - center, seen = rotation.transpose() * away;
    if (orthographic) {
      distance = std::max(
          {distance, (std::abs(away.y()) + b.radius) / slope, (std::abs(away.x()) + b.radius) / slope / aspect});
      continue;
    }
    for (const auto& [way, half] : {std::pair{std::abs(seen.x()), slope * aspect}, {std::abs(seen.y()), slope}})
      distance = std::max(distance, seen.z() + way / half + b.radius * std::hypot(1.0, half) / half);
  }
  return distance;
}

/// In a picture whose half height is `slope` at distance 1.
Framing frame_of(const std::vector<Ball>& balls, double slope, double aspect, bool orthographic, const Poll& poll) {
  if (balls.empty()) return {};
  Eigen::AlignedBox3d box;
  for (const Ball& b : balls) {
    box.extend(b.center - Vector3::Constant(b.radius));
    box.extend(b.center + Vector3::Constant(b.radius));
  }
  return {box.center(), kMargin * least_distance(balls, box.center(), slope, aspect, orthographic, poll)};
}

}  // namespace

float Lens::distance(float depth) const {
  const float z = 2 * depth - 1;
  if (orthographic) return (z * (far - near) + far + near) / 2;
  return 2 * far * near / (far + near - z * (far - near));
}

float Lens::scale_at(const Vector3f& location, float picture_height) const {
  if (orthographic) return picture_height / (2 * slope);
  const float away = std::max(near, (eye - location).dot(back));
  return picture_height / (2 * slope * away);
}

Lens lens_of(const SceneCamera& camera, double aspect) {
  Lens lens;
  const Eigen::Matrix3d rotation = rotation_of(camera.pitch, camera.yaw);
  lens.right = rotation.col(0).cast<float>();
  lens.up = rotation.col(1).cast<float>();
  lens.back = rotation.col(2).cast<float>();
  lens.eye = (camera.target + camera.offset).cast<float>();
  const double distance = std::max(1e-6, camera.offset.norm());
  lens.orthographic = camera.orthographic;
  lens.far = static_cast<float>(std::min(camera.far_plane, 1e12));
  lens.near = static_cast<float>(std::clamp(distance * 0.01, camera.far_plane * 1e-5, camera.far_plane * 0.1));
  lens.slope = static_cast<float>(std::tan(std::clamp(camera.field_of_view, 1e-3, 3.1) / 2));
  if (lens.orthographic) lens.slope *= static_cast<float>(distance);
  lens.view = view_matrix(lens);
  set_projection(lens, static_cast<float>(aspect));
  return lens;
}

bool project(const Lens& lens, const Vector3& point, int width, int height, double seen[3]) {
  const Eigen::Vector4d p(point.x(), point.y(), point.z(), 1);
  const Eigen::Vector4d clip = lens.projection.cast<double>() * (lens.view.cast<double>() * p);
  if (!(clip.w() > 0)) return false;
  seen[0] = (clip.x() / clip.w() + 1) / 2 * width;
  seen[1] = (1 - clip.y() / clip.w()) / 2 * height;
  seen[2] = (lens.eye.cast<double>() - point).dot(lens.back.cast<double>());
  return true;
}

float radius_of(const SceneInstance& instance, const SceneMesh& mesh) {
  const auto rotation = instance.transform.leftCols<3>();
  if (mesh.form == SceneMesh::Form::Sphere) return rotation.col(0).norm();
  if (mesh.form == SceneMesh::Form::Box) return Vector3f(rotation.colwise().norm().transpose()).norm() / 2;
  return Vector3f(rotation.colwise().norm().transpose()).cwiseProduct(mesh.reach).norm();
}

SceneCamera framed(const Scene& scene, SceneCamera camera, double aspect, Framing& kept, const Poll& poll) {
  if (!camera.automatic) return camera;
  // A scene that is all in planes of z is seen from straight ahead.
  const bool flat = scene.instances.empty() && !scene.sheets.empty();
  const double pitch = flat || camera.orthographic ? 0 : kPitch, yaw = flat || camera.orthographic ? 0 : kYaw;
  const double slope = std::tan(camera.field_of_view / 2);
  const std::vector<Ball> balls = balls_to_see(scene, poll);
  const Framing now = frame_of(balls, slope, aspect, flat || camera.orthographic, poll);
  if (now.distance <= 0) return camera;
  constexpr double kTooFar = 1.5, kGlide = 0.08;
  const bool outside =
      (now.center - kept.center).norm() > 0.1 * slope * kept.distance || now.distance > 1.02 * kept.distance;
  if (kept.distance <= 0) {
    kept = now;
  } else if (outside || kTooFar * now.distance < kept.distance) {
    kept.center += kGlide * (now.center - kept.center);
    kept.distance += kGlide * (now.distance - kept.distance);
  }
  // However fast things spread, and however many pictures were left out: none of them is cut off.
  kept.distance =
      std::max(kept.distance, least_distance(balls, kept.center, slope, aspect, flat || camera.orthographic, poll));
  camera.target = kept.center;
  camera.pitch = pitch;
  camera.yaw = yaw;
  camera.offset = kept.distance * rotation_of(camera.pitch, camera.yaw).col(2);
  camera.far_plane = std::max(camera.far_plane, 6 * kept.distance);
  return camera;
}

}  // namespace breve

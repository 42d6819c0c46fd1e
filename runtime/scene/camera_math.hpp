// From the world to the picture: the matrices of a camera, where a point is seen, and the camera that shows everything.
#pragma once

#include "runtime/base/poll.hpp"
#include "runtime/scene/scene.hpp"

namespace breve {

using Matrix4f = Eigen::Matrix4f;

/// A camera with the shape of its picture. x to the right, y up, looking along -z; depth runs from -1 to 1.
struct Lens {
  Matrix4f view = Matrix4f::Identity(), projection = Matrix4f::Identity();
  Vector3f eye = Vector3f::Zero();
  Vector3f right, up, back;  // the camera's axes in the world
  float near = 0.1F, far = 500;
  float slope = 1;  // half the picture's height at distance 1; of an orthographic one: at any distance
  bool orthographic = false;

  /// Length units along the line of sight, of what the depth buffer holds as 0 to 1.
  float distance(float depth) const;
  /// Pixels that a length of 1 takes at that place.
  float scale_at(const Vector3f& location, float picture_height) const;
};

/// @param aspect  width / height of the picture
Lens lens_of(const SceneCamera& camera, double aspect);

/// Where a point is in a picture: pixels from the left and from the top, and its distance along the line of sight.
/// False if it is behind the camera.
bool project(const Lens& lens, const Vector3& point, int width, int height, double seen[3]);

/// What an automatic camera shows, kept from picture to picture so that it does not jump.
struct Framing {
  Vector3 center = Vector3::Zero();
  double distance = 0;  // of the camera from there; 0: nothing yet
};

/// The camera, moved so that it shows the scene if it is an automatic one: bodies, cells and drawings. A few that are
/// far off from all others do not count.
/// @param kept  the framing of the picture before; the new one is written there
SceneCamera framed(const Scene& scene, SceneCamera camera, double aspect, Framing& kept, const Poll& poll = {});

/// A sphere about an instance.
float radius_of(const SceneInstance& instance, const SceneMesh& mesh);

}  // namespace breve

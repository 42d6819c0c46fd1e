// The triangles by which shapes are seen. Round solids are cut finely enough that their outline looks round in a
// picture of a thousand pixels.
#pragma once

#include "runtime/base/poll.hpp"
#include "runtime/scene/scene.hpp"
#include "runtime/solid/shape.hpp"

namespace breve {

/// A sphere of radius 1: an icosahedron whose faces are split in four `level` times, 20 * 4^level triangles.
SceneMesh make_sphere_mesh(int level);
/// A box with edges of length 1.
SceneMesh make_box_mesh();
/// Radius 1, from -1 to 1 along the axis.
SceneMesh make_cylinder_mesh(int axis, int segments = 48);
/// Radius 1 and round ends; the centres of these at +-half along the axis.
SceneMesh make_capsule_mesh(int axis, double half, int segments = 32);
/// A convex solid with flat faces. Sides of a solid with many faces about an axis stay flat: they are what it is.
SceneMesh make_facet_mesh(const Shape& shape);
/// A surface of triangles; corners at which faces meet flatly (within 40 degrees) are shaded as round.
SceneMesh make_surface_mesh(const Shape& shape, const Poll& poll = {});
/// A height field, shaded as round.
SceneMesh make_ground_mesh(const Shape& shape, const Poll& poll = {});

/// Colours of a ground: from `valley` at its lowest corner to `peak` at its highest.
void color_by_height(SceneMesh& mesh, const Vector3f& valley, const Vector3f& peak);

}  // namespace breve

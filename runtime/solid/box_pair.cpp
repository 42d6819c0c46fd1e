// Two boxes: the fifteen axes of Gottschalk (1996) in the frame of the first. Half of all contacts are between boxes,
// and here they cost a tenth of what general polyhedra do.
#include <cmath>
#include <limits>

#include "runtime/solid/pair.hpp"

namespace breve {

namespace {

// Below this sine two edges count as parallel: their product says nothing that the faces do not.
constexpr double kParallel = 1e-6;

/// The best axis of one kind so far.
struct Best {
  double distance = -std::numeric_limits<double>::infinity();
  int index = 0;
  double sign = 1;  // of the axis, so that it points from b toward a
};

/// The boxes in the frame of a.
struct Boxes {
  Matrix3 rotation, extent;  // of b; |rotation|
  Vector3 shift, half_a, half_b;

  /// False if some face of a or b is farther than the margin; `best` is then that face.
  bool faces(double margin, Best& of_a, Best& of_b) const {
    for (int i = 0; i < 3; ++i) {
      const double d = std::abs(shift[i]) - half_a[i] - extent.row(i).dot(half_b);
      if (d > of_a.distance) of_a = {d, i, shift[i] > 0 ? -1.0 : 1.0};
    }
    if (of_a.distance >= margin) return false;
    for (int i = 0; i < 3; ++i) {
      const double along = rotation.col(i).dot(shift);
      const double d = std::abs(along) - half_b[i] - extent.col(i).dot(half_a);
      if (d > of_b.distance) of_b = {d, i, along > 0 ? -1.0 : 1.0};
    }
    return of_b.distance < margin;
  }
  /// The product of edge i of a and edge j of b that beats `to_beat`, if any.
  void edges(double to_beat, Best& best) const {
    best.distance = to_beat;
    best.index = -1;
    for (int i = 0; i < 3; ++i) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      for (int j = 0; j < 3; ++j) {
        const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        const double square = rotation(i1, j) * rotation(i1, j) + rotation(i2, j) * rotation(i2, j);
        if (square < kParallel * kParallel) continue;
        const double along = rotation(i1, j) * shift[i2] - rotation(i2, j) * shift[i1];
        const double reach = half_a[i1] * extent(i2, j) + half_a[i2] * extent(i1, j) + half_b[j1] * extent(i, j2) +
                             half_b[j2] * extent(i, j1);
        const double gap = std::abs(along) - reach;
        // Most lose without a root: compare squares on the side of zero where both stand.
        if (gap < 0 ? best.distance >= 0 || gap * gap >= best.distance * best.distance * square
                    : best.distance > 0 && gap * gap <= best.distance * best.distance * square) {
          continue;
        }
        const double d = gap / std::sqrt(square);
        if (d > best.distance) best = {d, 3 * i + j, along > 0 ? -1.0 : 1.0};
      }
    }
  }
};

/// The middle of the edge of a box along `axis` that is farthest along `direction` (world).
Vector3 edge_middle(const Placed& box, const Vector3& half, int axis, const Vector3& direction) {
  Vector3 local = box.rotation.transpose() * direction;
  for (int i = 0; i < 3; ++i) local[i] = i == axis ? 0 : std::copysign(half[i], local[i]);
  return box.location + box.rotation * local;
}

bool cross_edges(const ConvexPair& pair, const Boxes& boxes, const Best& edge, Manifold& out) {
  const int i = edge.index / 3, j = edge.index % 3;
  const Vector3 along_a = pair.a.rotation.col(i), along_b = pair.b.rotation.col(j);
  const Vector3 normal = edge.sign * along_a.cross(along_b).normalized();
  const Vector3 mid_a = edge_middle(pair.a, boxes.half_a, i, -normal);
  const Vector3 mid_b = edge_middle(pair.b, boxes.half_b, j, normal);
  const Vector3 edge_a = 2 * boxes.half_a[i] * along_a, edge_b = 2 * boxes.half_b[j] * along_b;
  const std::uint32_t feature = kEdges | static_cast<std::uint32_t>(edge.index);
  pair.remember(normal, feature);
  return edge_manifold(mid_a - edge_a / 2, edge_a, mid_b - edge_b / 2, edge_b, normal, edge.distance,
                       pair.slack.preference, feature, out);
}

/// The number of a box's face; make_box has them in the order -x, +x, -y, ...
int face_index(int axis, double sign) { return 2 * axis + (sign > 0 ? 1 : 0); }

}  // namespace

bool boxes_manifold(const ConvexPair& pair, const Vector3& half_a, const Vector3& half_b, Manifold& out) {
  Boxes boxes;
  boxes.rotation.noalias() = pair.a.rotation.transpose() * pair.b.rotation;
  boxes.extent = boxes.rotation.cwiseAbs();
  boxes.shift.noalias() = pair.a.rotation.transpose() * pair.b.location;
  boxes.half_a = half_a;
  boxes.half_b = half_b;

  Best of_a, of_b, edge;
  const bool near = boxes.faces(pair.margin, of_a, of_b);
  const Vector3 normal_a = of_a.sign * pair.a.rotation.col(of_a.index);
  const Vector3 normal_b = of_b.sign * pair.b.rotation.col(of_b.index);
  // a's outward normal is the opposite of one that points from b toward a.
  const int face_a = face_index(of_a.index, -of_a.sign), face_b = face_index(of_b.index, of_b.sign);
  const std::uint32_t name_a = kFaceOfA | static_cast<std::uint32_t>(face_a);
  const std::uint32_t name_b = kFaceOfB | static_cast<std::uint32_t>(face_b);
  const double preference = pair.slack.preference;
  const bool a_first = half_a.squaredNorm() >= half_b.squaredNorm();
  double value_a = of_a.distance + (a_first ? preference / 2 : 0);
  double value_b = of_b.distance + (a_first ? 0 : preference / 2);
  if (pair.remembers(name_a)) value_a += preference / 4;
  if (pair.remembers(name_b)) value_b += preference / 4;
  const bool take_a = near ? value_a >= value_b : of_a.distance >= pair.margin;
  if (!near) {
    pair.remember(take_a ? normal_a : normal_b, take_a ? name_a : name_b);
    return false;
  }
  const double face = take_a ? of_a.distance : of_b.distance;
  boxes.edges(face + preference, edge);
  if (edge.index >= 0) {
    if (edge.distance >= pair.margin) {
      cross_edges(pair, boxes, edge, out);
      return false;
    }
    return cross_edges(pair, boxes, edge, out) || nearest_manifold(pair, out);
  }
  pair.remember(take_a ? normal_a : normal_b, take_a ? name_a : name_b);
  const bool clipped = face_manifold(pair, take_a ? Owner::A : Owner::B, take_a ? face_a : face_b, out);
  if (clipped && out.points[0].distance <= face + preference) return true;
  return nearest_manifold(pair, out);
}

}  // namespace breve

// Boxes against the bounds and the faces of a solid. A surface that lies on a large box is within its bounds, however
// these are rotated; the box's upper face tells what of it is far.
#include "runtime/solid/clearance.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/solid/surface_pair.hpp"

namespace breve {

Clearance::Clearance(const Placed& convex, const Placed& frame, const Eigen::AlignedBox3d& surface)
    : solid_(convex.solid),
      round_(convex.round),
      radius_(convex.radius),
      rotation_(frame.rotation.transpose() * convex.rotation),
      center_(frame.rotation.transpose() * (convex.location - frame.location)),
      bounds_(bounds_in(frame, convex)) {
  constexpr double kHair = 1e-13;  // of all lengths that take part
  hair_ = kHair * (radius_ + center_.norm() + surface.min().cwiseAbs().cwiseMax(surface.max().cwiseAbs()).norm());
  if (solid_ != nullptr) choose_planes(surface.center());
}

void Clearance::choose_planes(const Vector3& surface_center) {
  const Vector3 toward = rotation_.transpose() * (surface_center - center_);
  std::array<double, kMostPlanes> heights;
  for (const Plane& plane : solid_->planes) {
    const double height = plane.normal.dot(toward) - plane.offset;
    std::size_t at = plane_count_;
    while (at > 0 && heights[at - 1] < height) --at;
    if (at == kMostPlanes) continue;
    plane_count_ = std::min(plane_count_ + 1, kMostPlanes);
    for (std::size_t i = plane_count_ - 1; i > at; --i) {
      heights[i] = heights[i - 1];
      planes_[i] = planes_[i - 1];
    }
    heights[at] = height;
    planes_[at] = plane;
  }
  for (std::size_t i = 0; i < plane_count_; ++i) {
    if (round_.is_round()) planes_[i].offset = planes_[i].normal.dot(round_.extreme(planes_[i].normal));
    planes_[i].normal = rotation_ * planes_[i].normal;
    planes_[i].offset += planes_[i].normal.dot(center_);
  }
}

double Clearance::of(const Eigen::AlignedBox3d& box) const {
  if (solid_ == nullptr) return box.exteriorDistance(center_) - radius_ - hair_;
  double farthest = bounds_.exteriorDistance(box);
  const Vector3 middle = box.center(), half = box.sizes() / 2;
  for (std::size_t i = 0; i < plane_count_; ++i) {
    const Vector3& normal = planes_[i].normal;
    farthest = std::max(farthest, normal.dot(middle) - normal.cwiseAbs().dot(half) - planes_[i].offset);
  }
  return farthest - hair_;
}

double Clearance::of_plane(const Facet& facet) const {
  const double height = facet.normal.dot(center_ - facet.corner[0]);
  if (solid_ == nullptr) return std::abs(height) - radius_ - hair_;
  const Vector3 normal = rotation_.transpose() * facet.normal;
  if (round_.is_round()) return std::abs(height) - normal.dot(round_.extreme(normal)) - hair_;
  lowest_ = solid_->farthest(-normal, lowest_);
  highest_ = solid_->farthest(normal, highest_);
  const double low = normal.dot(solid_->vertices[at(lowest_)]), high = normal.dot(solid_->vertices[at(highest_)]);
  return std::max(height + low, -height - high) - hair_;
}

}  // namespace breve

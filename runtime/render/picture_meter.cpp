// The rectangles that things cover at most.
#include "runtime/render/picture_meter.hpp"

#include <cmath>

namespace breve::render {

void Extent::add(const Vector3f& point, double around) {
  double seen[3];
  if (!project(lens_, point.cast<double>(), width_, height_, seen)) {
    behind_ = true;
    return;
  }
  add(seen[0] - around, seen[1] - around, seen[0] + around, seen[1] + around);
}

void Extent::add(double left, double top, double right, double bottom) {
  left_ = seen_ ? std::min(left_, left) : left;
  top_ = seen_ ? std::min(top_, top) : top;
  right_ = seen_ ? std::max(right_, right) : right;
  bottom_ = seen_ ? std::max(bottom_, bottom) : bottom;
  seen_ = true;
}

double Extent::diagonal() const {
  const double across = width(), down = height();
  return std::hypot(across, down);
}

}  // namespace breve::render

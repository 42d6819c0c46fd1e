// The camera stands at target + offset, is pitched about x, then rotated about y (breve/view.h).
#include "viewer_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace breve::command {

ViewerCamera::Axes ViewerCamera::axes() const {
  const double sp = std::sin(camera_.pitch), cp = std::cos(camera_.pitch);
  const double sy = std::sin(camera_.yaw), cy = std::cos(camera_.yaw);
  return {{cy, 0, -sy}, {sp * sy, cp, sp * cy}, {cp * sy, -sp, cp * cy}};
}

double ViewerCamera::distance() const { return std::hypot(camera_.offset[0], camera_.offset[1], camera_.offset[2]); }

void ViewerCamera::place(double distance) {
  const Axes is = axes();
  for (int i = 0; i < 3; ++i) camera_.offset[i] = distance * is.back[i];
  moved_ = true;
}

double ViewerCamera::pixel(int height) const {
  return 2 * std::tan(camera_.field_of_view / 2) * distance() / std::max(1, height);
}

void ViewerCamera::orbit(double right, double down, int height) {
  if (camera_.orthographic) return pan(right, down, height);
  constexpr double kPerPixel = 0.006, kSteepest = 0.499 * std::numbers::pi;  // rad
  const double away = distance();
  camera_.yaw -= kPerPixel * right;
  camera_.pitch = std::clamp(camera_.pitch - kPerPixel * down, -kSteepest, kSteepest);
  place(away);
}

void ViewerCamera::pan(double right, double down, int height) {
  const Axes is = axes();
  const double unit = pixel(height);
  for (int i = 0; i < 3; ++i) camera_.target[i] += unit * (down * is.up[i] - right * is.right[i]);
  moved_ = true;
}

void ViewerCamera::zoom(double steps) {
  constexpr double kStep = 0.88;
  place(std::clamp(distance() * std::pow(kStep, steps), 1e-4, 1e9));
  camera_.far_plane = std::max(camera_.far_plane, 4 * distance());
}

void ViewerCamera::ray(double x, double y, int width, int height, double start[3], double way[3]) const {
  const Axes is = axes();
  const double slope = std::tan(camera_.field_of_view / 2);
  const double across = (2 * x / width - 1) * slope * width / height, along = (1 - 2 * y / height) * slope;
  const double away = distance();
  for (int i = 0; i < 3; ++i) {
    const double aside = across * is.right[i] + along * is.up[i];
    start[i] = camera_.target[i] + camera_.offset[i] + (camera_.orthographic ? away * aside : 0);
    way[i] = camera_.far_plane * ((camera_.orthographic ? 0 : aside) - is.back[i]);
  }
}

}  // namespace breve::command

// A picture is drawn in pieces of some 10 ms. A meter hears the cost of each before it is drawn.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime/base/cost_meter.hpp"
#include "runtime/render/gl.hpp"
#include "runtime/scene/camera_math.hpp"

namespace breve::render {

// Units of CostMeter. Measured with OSMesa at 4 samples a pixel: spheres as large as the picture, and lines across it.
inline constexpr double kOfTriangle = 3, kOfPixel = 0.25, kOfBlended = 0.4;
inline constexpr double kOfQuad = 2 * kOfTriangle;

/// Draws things number `first` to `first + count - 1`; all at once if there is no meter.
/// @param cost_of  units, of the thing of that number
/// @param draw     draws so many things from that number on
template <class CostOf, class Draw>
void draw_in_pieces(const Gl& gl, const CostMeter& meter, std::size_t first, std::size_t count, CostOf&& cost_of,
                    Draw&& draw) {
  if (!meter) return draw(first, count);
  constexpr double kPiece = 50'000, kMost = 1e15;
  const std::size_t end = first + count;
  while (first < end) {
    double cost = 0;
    std::size_t next = first;
    while (next < end && cost < kPiece) {
      const double more = cost_of(next++);
      if (more > 0) cost += std::min(more, kMost);  // what is not a number is in no picture
    }
    meter(static_cast<std::uint64_t>(cost));
    draw(first, next - first);
    gl.Finish();  // the next piece is to begin when this one is done
    first = next;
  }
}

/// How many pixels something can cover: the part of the rectangle about its points that is in the picture.
class Extent {
 public:
  /// @param width, height  of the picture, pixels
  Extent(const Lens& lens, int width, int height) : lens_(lens), width_(width), height_(height) {}

  /// @param around  pixels, on all sides of the point
  void add(const Vector3f& point, double around = 0);
  /// The corners of a rectangle: pixels from the left and from the top.
  void add(double left, double top, double right, double bottom);

  double width() const { return side(left_, right_, width_); }
  double height() const { return side(top_, bottom_, height_); }
  double area() const { return width() * height(); }
  /// The length of the longest line in it.
  double diagonal() const;

 private:
  double side(double low, double high, int picture) const {
    if (!seen_) return 0;
    if (behind_) return picture;
    return std::max(0.0, std::min<double>(high, picture) - std::max(low, 0.0));
  }

  const Lens& lens_;
  const int width_, height_;
  bool seen_ = false, behind_ = false;  // some point is before the camera, behind it
  double left_ = 0, top_ = 0, right_ = 0, bottom_ = 0;
};

}  // namespace breve::render

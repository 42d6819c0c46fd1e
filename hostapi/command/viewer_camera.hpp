// A camera that the mouse moves, beginning with the one that the program or the framing gave.
#pragma once

#include <breve/view.h>

namespace breve::command {

class ViewerCamera {
 public:
  /// The camera of the last picture; it is kept while the mouse has not moved it.
  void follow(const breve_camera& seen) {
    if (!moved_) camera_ = seen;
  }
  bool moved() const { return moved_; }
  void let_go() { moved_ = false; }
  const breve_camera& camera() const { return camera_; }

  /// Pixels that the mouse went, right and down. A flat world is not turned, but moved.
  void orbit(double right, double down, int height);
  void pan(double right, double down, int height);
  void zoom(double steps);  // above 0: nearer

  /// The line of sight through a pixel: from the eye to the far plane.
  void ray(double x, double y, int width, int height, double start[3], double way[3]) const;
  /// Length units that a pixel takes at the target's distance.
  double pixel(int height) const;

 private:
  struct Axes {
    double right[3], up[3], back[3];
  };
  Axes axes() const;
  double distance() const;
  void place(double distance);

  breve_camera camera_{};
  bool moved_ = false;
};

}  // namespace breve::command

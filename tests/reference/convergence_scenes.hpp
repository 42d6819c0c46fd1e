// Small scenes whose solution is smooth, or smooth but for a change from sliding to sticking: what the rungs converge
// to can be said of them, and how fast.
#pragma once

#include "world.hpp"

namespace breve::reference {

/// Reads the end of a run from a world: lengths in m or angles in rad, of the order of 1.
using Read = std::function<std::vector<double>(const World&)>;

/// The kind of a scene's motion, as far as the order of the rungs depends on it. KEEP IN STEP: docs/accuracy.md, "How
/// fast the rungs converge".
enum class Motion {
  Joints,    // trees and closed loops, and nothing else
  Rotation,  // of a free body
  Straight,  // contacts whose normals and points do not rotate, motors and limits; sliding that ends
  Curved,    // contacts whose normals or arms rotate; sliding that reverses
  Flat
};

struct Scene {
  const char* name = "";
  double seconds = 0;
  Motion motion = Motion::Joints;
  /// Where sliding ends, the error depends on where in a sub-step that is: the largest of some variants does not.
  int variants = 1;
  /// An absolute error that no step exceeds, where single precision hides the order; 0: the order shows.
  double within = 0;
  std::function<Read(World&, int variant)> build{};
  std::function<std::vector<double>(double t, int variant)> exact{};  // empty: `reference` at a short step in its place
};

std::vector<Scene> smooth_scenes();

}  // namespace breve::reference

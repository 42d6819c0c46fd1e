// What there is to see of a running program: of its world, and what only the class library knows: cells of grids,
// springs, colours of terrains.
#pragma once

#include <string>

#include "runtime/base/poll.hpp"
#include "runtime/scene/scene_builder.hpp"
#include "steve/machine/machine.hpp"

namespace breve::steve {

/// What arrows show.
struct Arrows {
  bool contacts = false, forces = false, velocities = false, joints = false;
  double scale = 1;  // of all their lengths
  bool any() const { return contacts || forces || velocities || joints; }
};

/// The whole moment: begins and ends the scene.
void show(Machine& machine, SceneBuilder& scene, const Arrows& arrows = {});
/// How many cells of grids, and lines and values of plots, that passes on; heights of wireframes count as more of them.
std::uint64_t shown_numbers(Machine& machine);
/// A plot as a PNG file.
std::string png_of(const ScenePlot& plot, const CostMeter& meter = {});

/// What a Graph object holds.
ScenePlot plot_of(Machine& machine, Instance& graph, const Poll& poll);
/// How many lines and values that are.
std::uint64_t plot_size(Machine& machine, Instance& graph);

/// Its arrows. (show_arrows.cpp)
void show_arrows(Machine& machine, const Arrows& arrows, SceneBuilder& scene);

}  // namespace breve::steve

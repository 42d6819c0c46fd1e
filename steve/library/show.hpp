// What there is to see of a running program: of its world, and what only the class library knows: cells of grids,
// springs, colours of terrains.
#pragma once

#include "runtime/scene/scene_builder.hpp"
#include "steve/machine/machine.hpp"

namespace breve::steve {

/// The whole moment: begins and ends the scene.
void show(Machine& machine, SceneBuilder& scene);

}  // namespace breve::steve

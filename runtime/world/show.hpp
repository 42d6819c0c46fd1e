// What of a world there is to see, written into a scene. Reading it changes nothing that the world's hash covers.
#pragma once

#include "runtime/scene/scene_builder.hpp"
#include "runtime/world/world.hpp"

namespace breve {

/// Everything but what script objects alone know: see steve/library/show.hpp. Between `scene.begin()` and `end()`.
void show(World& world, SceneBuilder& scene);

/// The picture behind an Image object, as a texture of the scene; kNoTexture if there is none.
std::uint32_t show_image(const World& world, ObjectId image, SceneBuilder& scene);

}  // namespace breve

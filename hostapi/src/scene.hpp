// Between the scene's cameras and the host's.
#pragma once

#include "breve/view.h"
#include "internal.hpp"
#include "runtime/scene/camera_math.hpp"
#include "runtime/scene/scene_builder.hpp"

namespace breve::host {

breve_camera to_host(const SceneCamera& camera);
/// BREVE_ERROR_ARGUMENT if a number is not finite.
SceneCamera from_host(const breve_camera& camera);

}  // namespace breve::host

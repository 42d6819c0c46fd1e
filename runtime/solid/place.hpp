// From a shape and a pose to what the narrow phase works on.
#pragma once

#include "runtime/solid/contact.hpp"
#include "runtime/solid/gap.hpp"

namespace breve {

/// A mesh is placed as its hull, a height field as a bare place.
Placed place(const Shape& shape, const Pose& pose);

inline bool is_surface(const Shape& shape) { return shape.surface() != nullptr; }

}  // namespace breve

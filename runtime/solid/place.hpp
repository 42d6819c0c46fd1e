// From a shape and a pose to what the narrow phase works on.
#pragma once

#include "runtime/solid/contact.hpp"
#include "runtime/solid/gap.hpp"

namespace breve {

Placed place(const Shape& shape, const Pose& pose);

}  // namespace breve

// How natives reach the pixels of an Image object.
#pragma once

#include "runtime/store/image_resource.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

/// The picture of an Image argument; empty (0 x 0) if it was never given a size.
/// @throws RunError{NullObject, FreedObject} naming `what`
inline Image& image_of(Machine& machine, Instance* object, std::string_view what) {
  return resource_made<ImageResource>(machine, must_live(object, what)).image;
}

}  // namespace breve::steve

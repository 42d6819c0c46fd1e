// How natives reach the pixels of an Image object.
#pragma once

#include "runtime/store/image_resource.hpp"
#include "steve/library/joints.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

/// The picture of an Image argument; empty (0 x 0) if it was never given a size.
/// @throws RunError{NullObject, FreedObject, Type} naming `what`
inline Image& image_of(Machine& machine, Instance* object, std::string_view what) {
  const Instance& live = must_live(object, what);
  if (!is_library_kind(live, "Image"))
    Machine::fail(RunErrorKind::Type, std::string(what) + " must be an Image, not " + name_of(live));
  return resource_made<ImageResource>(machine, live).image;
}

inline void warn_of_missing_image(Machine& machine, const std::string& name) {
  machine.warn_once("image:" + name, [&] {
    return "image '" + name + "' not found; check its name, and the directories that the host lets scripts read";
  });
}

}  // namespace breve::steve

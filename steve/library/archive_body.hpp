// A body as an XML element, for archives.
#pragma once

#include <pugixml.hpp>

#include "steve/machine/machine.hpp"

namespace breve::steve {

/// Pose, motion, material and look of an object's body. Shapes and pictures are objects of their own.
void write_body(Machine& machine, const Instance& object, pugi::xml_node element);

/// Give an object that has no body one as it was written. Its variables must be there already: they name its shapes and
/// pictures.
/// @throws Error{File} if the element is damaged
void read_body(Machine& machine, Instance& object, pugi::xml_node element);

}  // namespace breve::steve

// A body as an XML element, for archives.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "steve/machine/machine.hpp"

namespace breve::steve {

/// Pose, motion, material and look of an object's body, and the collision rules of its class. Shapes and pictures are
/// objects of their own.
void write_body(Machine& machine, const Instance& object, pugi::xml_node element);

/// Give an object that has no body one as it was written. Its variables must be there already: they name its shapes and
/// pictures.
/// @throws Error{File} if the element is damaged
void read_body(Machine& machine, Instance& object, pugi::xml_node element);

/// What a class asked for when its objects touch those of another one.
struct ArchivedRule {
  const ClassInfo* other;
  std::string method;  // empty: ignore such collisions
};

/// The collision rules in the element of a body of class `owner`.
/// @throws Error{File} for a class or a method that the program does not have
std::vector<ArchivedRule> read_rules(Machine& machine, const ClassInfo& owner, pugi::xml_node element);

/// Register them. Rules are those of the class: where it has a handler for the other class already, that one stays.
void set_rules(Machine& machine, const Instance& owner, const std::vector<ArchivedRule>& rules);

}  // namespace breve::steve

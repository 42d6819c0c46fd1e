// Objects as XML text and back: variables, native data, bodies, and everything that the objects depend on.
//
//   <breve-archive version="1" root="2">
//     <object id="1" class="Sphere"> <native kind="shape">hex of its snapshot form</native> </object>
//     <object id="2" class="Bird">
//       <body kind="mobile">hex <handler type="Bird" method="greet"/> <ignore type="Floor"/> </body>
//       <variable class="Bird" name="wings"> <int>2</int> </variable>
//     </object>
//   </breve-archive>
//
// Dependencies stand before what depends on them. A reference to an object that is not in the archive is null. Values
// are <int> <double> <vector> <matrix> <string> <object ref> <list> <hash> <data> <null>; a list or hash that was met
// before is <list same="N"/>.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "steve/machine/machine.hpp"

namespace breve::steve {

/// The archive of an object, its dependencies, and of what bodies need: shapes and pictures. Calls `archive` of each
/// object before it is written.
/// @throws Error{Argument} if an `archive` method yields 0, or for lists nested too deeply
std::string to_archive(Machine& machine, Instance& root);

/// Who wrote an archive.
enum class Origin : std::uint8_t { File, Network };

/// New objects out of an archive, made without `init`: variables, native data and bodies are set, then each object gets
/// `post-dearchive-set-controller` and `dearchive`, dependencies first. Yields the root.
/// @throws Error{File} for text that is not an archive, a class or variable that the program does not have, a
///         `dearchive` that yields 0, or a class that may not come from that origin; no object of the archive is left
///         then
Instance* from_archive(Machine& machine, std::string_view xml, Origin origin);

/// The first class in an archive whose objects cannot come over the network, because they reach outside of the world:
/// the controller's, files, movies, servers, and searches that send migrants. Empty if there is none.
/// @throws Error{File} for text that is not an archive
std::string class_refused_from_network(Machine& machine, std::string_view xml);

/// The variables of the archive's root into an object of the same class, which keeps its age and its dependencies.
/// Objects in the archive are not made.
/// @throws Error{File} as from_archive, and if the classes differ; the object is as it was then
void variables_from_archive(Machine& machine, std::string_view xml, Instance& target);

}  // namespace breve::steve

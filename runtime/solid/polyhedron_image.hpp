// Polyhedra in snapshot images: vertices and faces; the rest follows.
#pragma once

#include "runtime/base/bytes.hpp"
#include "runtime/solid/polyhedron.hpp"

namespace breve {

void save_polyhedron(const Polyhedron& solid, ByteWriter& out);
/// Vertices are finite, indices are in range, edges are found. Error{Image} or Error{Argument} if it is not closed.
Polyhedron load_polyhedron(ByteReader& in);

}  // namespace breve

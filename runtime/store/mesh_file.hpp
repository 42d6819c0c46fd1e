// Triangles from mesh files: 3DS (Autodesk 3D Studio) and OBJ (Wavefront), and shapes made of them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/math.hpp"
#include "runtime/solid/shape.hpp"

namespace breve {

/// What a file holds, all its objects together, in the file's own axes and unit.
struct MeshData {
  std::pmr::vector<Vector3> corners;
  std::pmr::vector<std::array<std::int32_t, 3>> triangles;
};

/// From the bytes of a file; `name` stands for it in messages. What begins with the mark of 3DS (0x4d4d) is 3DS, all
/// else OBJ. Error{File} names the file and says why it cannot be used: it is neither 3DS nor OBJ, is damaged, too
/// large (kMostMeshBytes), or has no triangles. Materials and textures are not looked for.
MeshData parse_mesh(std::span<const std::uint8_t> bytes, const std::string& name,
                    std::pmr::memory_resource* memory = std::pmr::get_default_resource());
constexpr std::size_t kMostMeshBytes = std::size_t{64} << 20;

enum class MeshUse : std::uint8_t {
  Hull,      // the convex hull: for bodies that move
  Triangles  // as it is; see Shape::mesh
};

/// A shape from a mesh, its centre of mass at the origin, scaled so that its longest side along an axis is `size` (0:
/// the file's own size). Error{File} as above, or if no such shape can be made of it; Error{Argument} if `size` is not
/// finite and >= 0.
std::shared_ptr<Shape> make_mesh(const MeshData& data, const std::string& name, MeshUse use, double size,
                                 std::pmr::memory_resource* memory = std::pmr::get_default_resource());

}  // namespace breve

// In place of mesh_file.cpp where breve is built without mesh files.
#include <fmt/format.h>

#include "runtime/base/error.hpp"
#include "runtime/store/mesh_file.hpp"

namespace breve {

MeshData parse_mesh(std::span<const std::uint8_t>, const std::string& name, std::pmr::memory_resource*) {
  throw Error(ErrorCode::File,
              fmt::format("cannot use mesh file '{}': mesh files are not a part of this breve: it was built with "
                          "BREVE_WITH_MESHES=OFF",
                          name));
}

std::shared_ptr<Shape> make_mesh(const MeshData&, const std::string& name, MeshUse, double,
                                 std::pmr::memory_resource* memory) {
  parse_mesh({}, name, memory);
  return nullptr;
}

}  // namespace breve

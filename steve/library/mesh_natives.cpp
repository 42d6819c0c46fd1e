// Natives of MeshShape: geometry out of 3DS and OBJ files.
#include "runtime/store/mesh_file.hpp"
#include "steve/library/resources.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

template <MeshUse Use>
Instance* load(Machine& machine, Instance& self, StringCell* file, double size) {
  const std::string name(view(file));
  const std::pmr::string file_bytes = read_file(machine, name);
  machine.charge(file_bytes.size() + file_bytes.size() / 2);
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(file_bytes.data()), file_bytes.size());
  ShapeResource& own = resource_made<ShapeResource>(machine, self);
  std::pmr::memory_resource* const memory = machine.heap().memory();
  auto shape = make_mesh(parse_mesh(bytes, name, memory), name, Use, size, memory);
  shape->set_density(own.density);
  own.shape = std::move(shape);
  return &self;
}

constexpr Native kMeshNatives[] = {
    native<load<MeshUse::Triangles>>("mesh-shape.load-triangles", Reach::Reads),
    native<load<MeshUse::Hull>>("mesh-shape.load-hull", Reach::Reads),
};

}  // namespace

std::span<const Native> mesh_natives() { return kMeshNatives; }

}  // namespace breve::steve

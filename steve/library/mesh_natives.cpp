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
  const std::string path = machine.host().find_file ? machine.host().find_file(name) : name;
  ShapeResource& own = resource_made<ShapeResource>(machine, self);
  auto shape = load_mesh(path.empty() ? name : path, Use, size, machine.heap().memory());
  shape->set_density(own.density);
  own.shape = std::move(shape);
  return &self;
}

constexpr Native kMeshNatives[] = {
    native<load<MeshUse::Triangles>>("mesh-shape.load-triangles"),
    native<load<MeshUse::Hull>>("mesh-shape.load-hull"),
};

}  // namespace

std::span<const Native> mesh_natives() { return kMeshNatives; }

}  // namespace breve::steve

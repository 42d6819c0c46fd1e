// Grids in snapshots and hashes, and the making of Patch objects.
#include "steve/library/grids.hpp"

#include <algorithm>

#include "steve/code/program.hpp"
#include "steve/library/joints.hpp"
#include "steve/library/resources.hpp"

namespace breve::steve {

// --- saved state -----------------------------------------------------------------------------------------------------

void GridResource::save(ByteWriter& out) const {
  out.put(grid.has_value());
  if (!grid) return;
  grid->save(out);
  out.put(neighborhood);
  out.put(order);
  for (const bool there : {!patches.empty(), !colors.empty(), !alphas.empty()}) out.put(there);
  for (const ObjectId patch : patches) out.put(patch);
  for (const Vector3& color : colors) out.put(color);
  for (const double alpha : alphas) out.put(alpha);
  states.save(out);
  occupants.save(out);
}

std::unique_ptr<Resource> GridResource::load(ByteReader& in) {
  auto made = make_in<GridResource>(in.memory(), in.memory());
  if (!in.get_bool()) return made;
  made->grid = Grid::load(in);
  made->neighborhood = in.get<Neighborhood>();
  made->order = in.get<UpdateOrder>();
  if (made->neighborhood > Neighborhood::VonNeumann3 || made->order > UpdateOrder::Random) ByteReader::fail();
  const bool has_patches = in.get_bool(), has_colors = in.get_bool(), has_alphas = in.get_bool();
  const auto need = [&](std::size_t each) {
    if (made->grid->cells() > in.left() / each) ByteReader::fail();
  };
  if (has_patches) {
    need(2 * sizeof(std::uint32_t));
    made->patches.resize(made->grid->cells());
    for (ObjectId& patch : made->patches) patch = in.get_object();
  }
  if (has_colors) {
    need(3 * sizeof(double));
    made->make_colors();
    for (Vector3& color : made->colors) color = in.get_vector();
  }
  if (has_alphas) {
    need(sizeof(double));
    made->make_alphas();
    for (double& alpha : made->alphas) alpha = in.get<double>();
  }
  made->states.load(in, *made->grid);
  made->occupants.load(in, *made->grid);
  return made;
}

void GridResource::hash(Hasher& hasher) const {
  if (!grid) return;
  grid->hash(hasher);
  hasher.add(static_cast<std::uint64_t>(neighborhood) << 8 | static_cast<std::uint64_t>(order));
  for (const ObjectId patch : patches) hasher.add(std::uint64_t{patch.index} << 32 | patch.generation);
  for (const Vector3& color : colors) hasher.add(color);
  for (const double alpha : alphas) hasher.add(alpha);
  states.hash(hasher);
  if (occupants.made()) occupants.hash(hasher);
}

// --- access ----------------------------------------------------------------------------------------------------------

GridResource& grid_of(Machine& machine, Instance* object, std::string_view what) {
  Instance& live = must_live(object, what);
  GridResource* resource = resource_of<GridResource>(machine, &live);
  if (!resource || !resource->grid)
    Machine::fail(RunErrorKind::NullObject,
                  std::string(what) + ": " + name_of(live) + " has no cells yet; init-with creates them");
  return *resource;
}

CellIndex cell_in(const GridResource& resource, std::int32_t x, std::int32_t y, std::int32_t z) {
  const Grid& grid = *resource.grid;
  const CellIndex cell = grid.at(x, y, z);
  if (cell == kNoCell) {
    const auto triple = [](int a, int b, int c, const char* between) {
      return std::to_string(a) + between + std::to_string(b) + between + std::to_string(c);
    };
    Machine::fail(RunErrorKind::Bounds, "cell (" + triple(x, y, z, ", ") + ") is outside a grid of " +
                                            triple(grid.nx(), grid.ny(), grid.nz(), " x ") +
                                            " cells (indices start at 0)");
  }
  return cell;
}

PatchCell cell_of(Machine& machine, const Instance& patch) {
  auto* grid = static_cast<Instance*>(patch.slots[kPatchGridSlot].ref);
  GridResource* resource = resource_of<GridResource>(machine, grid);
  if (!resource || !resource->grid) return {};
  const CellIndex cell =
      resource->grid->at(patch.slots[kPatchXSlot].i, patch.slots[kPatchYSlot].i, patch.slots[kPatchZSlot].i);
  return cell == kNoCell ? PatchCell{} : PatchCell{grid, resource, cell};
}

PatchCell attached(Machine& machine, const Instance& patch) {
  const PatchCell at = cell_of(machine, patch);
  if (!at.resource)
    Machine::fail(RunErrorKind::NullObject,
                  name_of(patch) +
                      " does not belong to a grid; a patch belongs to one from init-patch on, until the grid is freed");
  return at;
}

// --- making ----------------------------------------------------------------------------------------------------------

namespace {

const ClassInfo& class_named(Machine& machine, std::string_view name) {
  const ClassInfo* cls = machine.program().find_class(name);
  if (!cls) machine.fail_unknown_class(name);
  return *cls;
}

[[noreturn]] void fail_patch_class(std::string_view name) {
  throw Error(ErrorCode::Argument, "the cells of a grid must be of class Patch or derived from it, which '" +
                                       std::string(name) + "' is not");
}

/// A class whose objects have the variables of a Patch: scripts may set the name that a grid keeps.
const ClassInfo& patch_class_named(Machine& machine, std::string_view name) {
  const ClassInfo& named = class_named(machine, name);
  for (const ClassInfo* cls = &named; cls; cls = cls->parent)
    if (cls->name == "Patch") return named;
  fail_patch_class(name);
}

}  // namespace

Field* chemical_field(Machine& machine, Instance& grid, Instance& chemical) {
  const Slot* all = library_slot(machine, grid, "PatchGrid", "gridConcentrations");
  if (!all || !all->ref) return nullptr;
  const auto& hash = *static_cast<const HashCell*>(all->ref);
  const Value* found = machine.heap().find(hash, Value::of(Tag::Object, &chemical));
  if (!found || found->tag != Tag::Object || !found->object() || !found->object()->live()) return nullptr;
  auto* resource = resource_of<FieldResource>(machine, found->object());
  return resource && resource->field ? &*resource->field : nullptr;
}

bool has_code(Machine& machine, std::string_view patch_class) {
  bool code = false;
  for (const ClassInfo* cls = &class_named(machine, patch_class); cls; cls = cls->parent) {
    if (cls->name == "Patch") return code;
    code = code || !cls->methods.empty() || !cls->variables.empty();
  }
  fail_patch_class(patch_class);
}

void charge_for_neighborhood(Machine& machine, const Grid& grid, std::int32_t size, bool flat) {
  constexpr double kCellsPerIteration = 4;
  const double side = 2.0 * size + 1, within = side * side * (flat ? 1 : side);
  machine.charge(static_cast<std::uint64_t>(std::min(within, static_cast<double>(grid.cells())) / kCellsPerIteration));
}

Instance* patch_of(Machine& machine, Instance& grid, CellIndex cell) {
  const auto made_anew = [&] {
    Machine::fail(RunErrorKind::World, name_of(grid) + " was initialised again by an init of its patches");
  };
  GridResource& resource = own_grid(machine, grid);
  if (cell >= resource.grid->cells()) made_anew();
  if (resource.patches.empty()) resource.patches.resize(resource.grid->cells());
  if (const ObjectId id = resource.patches[cell]) return machine.instance(id);
  const Slot* name = library_slot(machine, grid, "PatchGrid", "patchClass");
  const ClassInfo& cls = patch_class_named(machine, view(static_cast<StringCell*>(name->ref)));
  const Pin pin(machine, Value::of(Tag::Object, &grid));
  Instance* made = machine.create(cls);
  // Its init may have run anything: look at the grid anew.
  GridResource& after = own_grid(machine, grid);
  if (cell >= after.grid->cells()) made_anew();
  if (after.patches.empty()) after.patches.resize(after.grid->cells());
  if (after.patches[cell]) made_anew();
  if (!made->live()) return nullptr;
  const Cell3 c = after.grid->cell(cell);
  machine.heap().store(made->slots[kPatchGridSlot], &grid);
  made->slots[kPatchXSlot].i = c.x;
  made->slots[kPatchYSlot].i = c.y;
  made->slots[kPatchZSlot].i = c.z;
  after.patches[cell] = made->id;
  return made;
}

}  // namespace breve::steve

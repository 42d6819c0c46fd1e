// Natives of PatchGrid: making the cells, their Patch objects, chemicals over them, colours of all at once.
#include <algorithm>

#include "steve/library/field_natives.hpp"
#include "steve/library/grids.hpp"
#include "steve/library/joints.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

// --- making ----------------------------------------------------------------------------------------------------------

/// Every cell's object, then init-patch of each: the whole grid exists by then.
void patches_of(Machine& machine, Instance& self, CellIndex cells) {
  constexpr std::uint64_t kOfCell = 8;
  machine.charge_for(kOfCell * static_cast<std::uint64_t>(cells));
  for (CellIndex cell = 0; cell < cells; ++cell) patch_of(machine, self, cell);
}

void make_patches(Machine& machine, Instance& self) {
  const auto cells = static_cast<CellIndex>(own_grid(machine, self).grid->cells());
  patches_of(machine, self, cells);
  for (CellIndex cell = 0; cell < cells; ++cell) {
    Instance* patch = patch_of(machine, self, cell);
    if (patch && patch->live()) machine.call(*patch, "init-patch");
  }
}

Instance* grid_make(Machine& machine, Instance& self, std::int32_t nx, std::int32_t ny, std::int32_t nz,
                    Vector3 location, Vector3 size, StringCell* patch_class) {
  const bool code = has_code(machine, view(patch_class));
  const Grid grid({nx, ny, nz}, is_library_kind(self, "PatchToroid"), location, size);
  machine.charge_for(grid.cells());
  const StageScope timed = machine.world().work(EffectId::Patches, self.id, grid.cells());
  std::pmr::memory_resource* memory = machine.heap().memory();
  auto made = make_in<GridResource>(memory, memory);
  made->grid = grid;
  made->neighborhood = grid.flat() ? Neighborhood::Moore : Neighborhood::Moore3;
  machine.world().attach(self.id, std::move(made));
  if (code) make_patches(machine, self);
  return &self;
}

/// After an archive: the objects that the cells had belong to another world.
void grid_rebuild(Machine& machine, Instance& self, StringCell* patch_class) {
  GridResource* resource = resource_of<GridResource>(machine, &self);
  if (!resource || !resource->grid) return;
  const bool code = has_code(machine, view(patch_class));
  resource->patches.clear();
  resource->occupants = Occupants(machine.heap().memory());
  if (code) make_patches(machine, self);
}

/// The objects of the cells go with their grid. They stay in its table while they go, so that a destroy method which
/// asks for neighbours finds those that are left, and makes no new ones.
void grid_free_patches(Machine& machine, Instance& self) {
  for (std::size_t cell = 0;; ++cell) {
    const GridResource* resource = resource_of<GridResource>(machine, &self);
    if (!resource || cell >= resource->patches.size()) return;
    const ObjectId id = resource->patches[cell];
    if (Instance* patch = id ? machine.instance(id) : nullptr) machine.free_instance(*patch);
  }
}

// --- cells -----------------------------------------------------------------------------------------------------------

Instance* grid_get_patch_at(Machine& machine, Instance& self, std::int32_t x, std::int32_t y, std::int32_t z) {
  const CellIndex cell = own_grid(machine, self).grid->at(x, y, z);
  return cell == kNoCell ? nullptr : patch_of(machine, self, cell);
}

Instance* grid_get_patch(Machine& machine, Instance& self, Vector3 location) {
  const CellIndex cell = own_grid(machine, self).grid->at(location);
  return cell == kNoCell ? nullptr : patch_of(machine, self, cell);
}

ListCell* grid_get_patches(Machine& machine, Instance& self) {
  const auto cells = static_cast<CellIndex>(own_grid(machine, self).grid->cells());
  constexpr CellIndex kCellsPerIteration = 4;
  machine.charge(cells / kCellsPerIteration);
  ListCell* list = machine.heap().list(cells);
  const Pin pin(machine, Value::of(Tag::List, list));
  for (CellIndex cell = 0; cell < cells; ++cell)
    if (Instance* patch = patch_of(machine, self, cell)) machine.heap().push(*list, Value::of(Tag::Object, patch));
  return list;
}

/// `all` asks for the objects of a class: cells whose objects would be of it have them from now on.
void grid_make_patches_of(Machine& machine, Instance& self, StringCell* name) {
  const GridResource* resource = resource_of<GridResource>(machine, &self);
  const ClassInfo* wanted = machine.program().find_class(view(name));
  const Slot* own = library_slot(machine, self, "PatchGrid", "patchClass");
  const ClassInfo* cls = own->ref ? machine.program().find_class(view(static_cast<StringCell*>(own->ref))) : nullptr;
  if (!resource || !resource->grid || !wanted || !cls || !cls->derives_from(*wanted)) return;
  patches_of(machine, self, static_cast<CellIndex>(resource->grid->cells()));
}

template <int (Grid::*Count)() const>
std::int32_t grid_count(Machine& machine, Instance& self) {
  const GridResource* resource = resource_of<GridResource>(machine, &self);
  return resource && resource->grid ? ((*resource->grid).*Count)() : 0;
}

Vector3 grid_get_location(Machine& machine, Instance& self) { return own_grid(machine, self).grid->center(); }
Vector3 grid_get_patch_size(Machine& machine, Instance& self) { return own_grid(machine, self).grid->cell_size(); }

// --- chemicals -------------------------------------------------------------------------------------------------------

/// The element of a chemical's matrix over a cell.
double grid_read_field(Machine& machine, Instance& self, Instance* field, std::int32_t x, std::int32_t y,
                       std::int32_t z) {
  const GridResource& resource = own_grid(machine, self);
  const Cell3 c = resource.grid->cell(cell_in(resource, x, y, z));
  return field_of(machine, field, "the matrix of a chemical").get(c.x, c.y, c.z);
}

void grid_write_field(Machine& machine, Instance& self, Instance* field, double value, std::int32_t x, std::int32_t y,
                      std::int32_t z) {
  const GridResource& resource = own_grid(machine, self);
  const Cell3 c = resource.grid->cell(cell_in(resource, x, y, z));
  field_of(machine, field, "the matrix of a chemical").set(c.x, c.y, c.z, finite(value, "a concentration"));
}

/// Red, green and blue from up to three matrices, and opacity from the sum of the three.
void grid_color_from(Machine& machine, Instance& self, Instance* red, Instance* green, Instance* blue) {
  GridResource& resource = own_grid(machine, self);
  constexpr std::uint64_t kOfCell = 4;  // numbers
  machine.charge_for(kOfCell * resource.grid->cells());
  resource.make_colors();
  resource.make_alphas();
  const Field* fields[3] = {};
  Instance* const objects[3] = {red, green, blue};
  for (int i = 0; i < 3; ++i) {
    if (!objects[i]) continue;
    fields[i] = &field_of(machine, objects[i], "the matrix of a chemical");
    if (fields[i]->size() != resource.grid->cells())
      throw Error(ErrorCode::Argument, "the matrix of a chemical must have as many elements as the grid has cells");
  }
  constexpr double kOpacity = 0.33;
  for (std::size_t cell = 0; cell < resource.grid->cells(); ++cell) {
    for (int i = 0; i < 3; ++i)
      resource.colors[cell][i] = fields[i] ? fields[i]->values()[static_cast<Eigen::Index>(cell)] : 0.0;
    resource.alphas[cell] = kOpacity * resource.colors[cell].sum();
  }
}

// --- a Matrix3D into one channel of the cells, as far as both go -----------------------------------------------------

template <int Channel>
void copy_to_grid(Machine& machine, Instance& self, Instance* target, double factor) {
  const Field& field = own_field(machine, self);
  GridResource& resource = grid_of(machine, target, "copy-to-channel: the patch grid");
  const Grid& grid = *resource.grid;
  machine.charge_for(grid.cells());
  if constexpr (Channel == 3)
    resource.make_alphas();
  else
    resource.make_colors();
  for (int x = 0; x < std::min(grid.nx(), field.nx()); ++x) {
    for (int y = 0; y < std::min(grid.ny(), field.ny()); ++y) {
      for (int z = 0; z < std::min(grid.nz(), field.nz()); ++z) {
        const CellIndex cell = grid.at(x, y, z);
        const double value = factor * field.get(x, y, z);
        if constexpr (Channel == 3)
          resource.alphas[cell] = value;
        else
          resource.colors[cell][Channel] = value;
      }
    }
  }
}

constexpr Native kGridNatives[] = {
    native<grid_make>("patch-grid.make"),
    native<grid_rebuild>("patch-grid.rebuild"),
    native<grid_free_patches>("patch-grid.free-patches"),
    native<grid_make_patches_of>("patch-grid.make-patches"),
    native<grid_get_patch_at>("patch-grid.get-patch-at"),
    native<grid_get_patch>("patch-grid.get-patch"),
    native<grid_get_patches>("patch-grid.get-patches"),
    native<grid_count<&Grid::nx>>("patch-grid.get-x-count"),
    native<grid_count<&Grid::ny>>("patch-grid.get-y-count"),
    native<grid_count<&Grid::nz>>("patch-grid.get-z-count"),
    native<grid_get_location>("patch-grid.get-location"),
    native<grid_get_patch_size>("patch-grid.get-patch-size"),
    native<grid_read_field>("patch-grid.read-field"),
    native<grid_write_field>("patch-grid.write-field"),
    native<grid_color_from>("patch-grid.color-from"),
    native<copy_to_grid<0>>("matrix3d.copy-to-red-channel"),
    native<copy_to_grid<1>>("matrix3d.copy-to-green-channel"),
    native<copy_to_grid<2>>("matrix3d.copy-to-blue-channel"),
    native<copy_to_grid<3>>("matrix3d.copy-to-alpha-channel"),
};

}  // namespace

std::span<const Native> grid_natives() { return kGridNatives; }

}  // namespace breve::steve

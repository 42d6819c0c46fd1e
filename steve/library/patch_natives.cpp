// Natives of Patch: where a cell is, what it looks like, its state, which cells are around it.
#include <algorithm>
#include <cmath>

#include "steve/library/grids.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

// --- what it is ------------------------------------------------------------------------------------------------------

Vector3 patch_get_location(Machine& machine, Instance& self) {
  const PatchCell at = attached(machine, self);
  return at.resource->grid->corner(at.cell);
}

Vector3 patch_get_center(Machine& machine, Instance& self) {
  const PatchCell at = attached(machine, self);
  return at.resource->grid->middle(at.cell);
}

std::int32_t patch_get_state(Machine& machine, Instance& self) {
  const PatchCell at = attached(machine, self);
  return at.resource->states.made() ? at.resource->states.get(at.cell) : 0;
}

void patch_set_state(Machine& machine, Instance& self, std::int32_t state) {
  const PatchCell at = attached(machine, self);
  if (state < 0 || state > 255)
    throw Error(ErrorCode::Argument, "the state " + std::to_string(state) + " of a cell (must be 0 to 255)");
  at.resource->states.make(*at.resource->grid);
  at.resource->states.set(at.cell, static_cast<std::uint8_t>(state));
}

// --- look ------------------------------------------------------------------------------------------------------------

/// The place, or none with a hint: programs set colours in `init`, which is too early.
PatchCell hinted(Machine& machine, Instance& self, const char* selector) {
  const PatchCell at = cell_of(machine, self);
  if (!at.resource)
    machine.warn_once("patch." + std::string(selector) + ":" + self.cls->name, [&] {
      return std::string(selector) + ": " + name_of(self) +
             " does not belong to a grid yet; the call has no effect (use init-patch instead of init)";
    });
  return at;
}

void patch_set_color(Machine& machine, Instance& self, Vector3 color) {
  finite(color, "set-color: the color");
  const PatchCell at = hinted(machine, self, "set-color");
  if (!at.resource) return;
  at.resource->make_colors();
  at.resource->colors[at.cell] = color;
}

Vector3 patch_get_color(Machine& machine, Instance& self) {
  const PatchCell at = cell_of(machine, self);
  if (!at.resource || at.resource->colors.empty()) return {1, 1, 1};
  return at.resource->colors[at.cell];
}

void patch_set_transparency(Machine& machine, Instance& self, double alpha) {
  finite(alpha, "set-transparency: the value");
  const PatchCell at = hinted(machine, self, "set-transparency");
  if (!at.resource) return;
  at.resource->make_alphas();
  at.resource->alphas[at.cell] = alpha;
}

double patch_get_transparency(Machine& machine, Instance& self) {
  const PatchCell at = cell_of(machine, self);
  if (!at.resource || at.resource->alphas.empty()) return GridResource::kAlpha;
  return at.resource->alphas[at.cell];
}

// --- neighbours ------------------------------------------------------------------------------------------------------

Instance* neighbor_at(Machine& machine, const PatchCell& at, std::int64_t dx, std::int64_t dy, std::int64_t dz) {
  const Grid& grid = *at.resource->grid;
  const Cell3 c = grid.cell(at.cell);
  const CellIndex cell = grid.at(c.x + dx, c.y + dy, c.z + dz);
  return cell == kNoCell ? nullptr : patch_of(machine, *at.grid, cell);
}

template <int X, int Y, int Z>
Instance* patch_neighbor(Machine& machine, Instance& self) {
  return neighbor_at(machine, attached(machine, self), X, Y, Z);
}

Instance* patch_get_patch(Machine& machine, Instance& self, Vector3 offset) {
  constexpr double kFar = 1e15;
  finite(offset, "get-patch: the offset");
  if (offset.cwiseAbs().maxCoeff() > kFar) return nullptr;
  return neighbor_at(machine, attached(machine, self), std::llround(offset.x()), std::llround(offset.y()),
                     std::llround(offset.z()));
}

template <bool Box, bool Flat>
ListCell* patch_neighborhood(Machine& machine, Instance& self, std::int32_t size) {
  const PatchCell at = attached(machine, self);
  if (size < 0)
    throw Error(ErrorCode::Argument, "the size " + std::to_string(size) + " of a neighborhood (must be >= 0)");
  const Grid grid = *at.resource->grid;
  charge_for_neighborhood(machine, grid, size, Flat);
  ListCell* list = machine.heap().list();
  const Pin pin(machine, Value::of(Tag::List, list)), pin_grid(machine, Value::of(Tag::Object, at.grid));
  const auto add = [&](CellIndex cell) {
    if (Instance* patch = patch_of(machine, *at.grid, cell)) machine.heap().push(*list, Value::of(Tag::Object, patch));
  };
  if constexpr (Box)
    grid.moore(at.cell, size, Flat, add);
  else
    grid.von_neumann(at.cell, size, Flat, add);
  return list;
}

constexpr Native kPatchNatives[] = {
    native<patch_get_location>("patch.get-location"),
    native<patch_get_center>("patch.get-center"),
    native<patch_get_state>("patch.get-state"),
    native<patch_set_state>("patch.set-state"),
    native<patch_set_color>("patch.set-color"),
    native<patch_get_color>("patch.get-color"),
    native<patch_set_transparency>("patch.set-transparency"),
    native<patch_get_transparency>("patch.get-transparency"),
    native<patch_get_patch>("patch.get-patch"),
    native<patch_neighborhood<true, false>>("patch.get-3d-moore-neighborhood"),
    native<patch_neighborhood<false, false>>("patch.get-3d-von-neumann-neighborhood"),
    native<patch_neighborhood<true, true>>("patch.get-moore-neighborhood"),
    native<patch_neighborhood<false, true>>("patch.get-von-neumann-neighborhood"),
    native<patch_neighbor<0, 0, -1>>("patch.get-patch-to-north"),
    native<patch_neighbor<0, 0, 1>>("patch.get-patch-to-south"),
    native<patch_neighbor<1, 0, 0>>("patch.get-patch-to-east"),
    native<patch_neighbor<-1, 0, 0>>("patch.get-patch-to-west"),
    native<patch_neighbor<0, 1, 0>>("patch.get-patch-above"),
    native<patch_neighbor<0, -1, 0>>("patch.get-patch-below"),
    native<patch_neighbor<-1, 0, 0>>("patch.get-patch-to-left"),
    native<patch_neighbor<1, 0, 0>>("patch.get-patch-to-right"),
    native<patch_neighbor<-1, 1, 0>>("patch.get-patch-to-upper-left"),
    native<patch_neighbor<-1, -1, 0>>("patch.get-patch-to-lower-left"),
    native<patch_neighbor<1, 1, 0>>("patch.get-patch-to-upper-right"),
    native<patch_neighbor<1, -1, 0>>("patch.get-patch-to-lower-right"),
    native<patch_neighbor<1, 0, 0>>("patch.get-patch-towards-plus-x"),
    native<patch_neighbor<-1, 0, 0>>("patch.get-patch-towards-minus-x"),
    native<patch_neighbor<0, 1, 0>>("patch.get-patch-towards-plus-y"),
    native<patch_neighbor<0, -1, 0>>("patch.get-patch-towards-minus-y"),
    native<patch_neighbor<0, 0, 1>>("patch.get-patch-towards-plus-z"),
    native<patch_neighbor<0, 0, -1>>("patch.get-patch-towards-minus-z"),
    native<patch_neighbor<-1, -1, 0>>("patch.get-patch-towards-minus-x-minus-y"),
    native<patch_neighbor<-1, 1, 0>>("patch.get-patch-towards-minus-x-plus-y"),
    native<patch_neighbor<1, -1, 0>>("patch.get-patch-towards-plus-x-minus-y"),
    native<patch_neighbor<1, 1, 0>>("patch.get-patch-towards-plus-x-plus-y"),
};

}  // namespace

std::span<const Native> patch_natives() { return kPatchNatives; }

}  // namespace breve::steve

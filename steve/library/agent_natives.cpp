// Natives of GridAgent and of PatchGrid about its agents: entering, moving, who is near, which cells are free.
#include <fmt/format.h>
#include <algorithm>

#include "steve/library/grids.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

// KEEP IN STEP: the variables of Object and GridAgent come in this order (Object.tz, GridAgent.tz).
constexpr std::uint32_t kGridSlot = 3, kOccupantSlot = 4;

/// Where an agent stands; no resource if it is on no grid.
struct Standing {
  Instance* grid = nullptr;
  GridResource* resource = nullptr;
  Occupants::Slot slot = Occupants::kNoSlot;
  CellIndex cell() const { return resource->occupants.agent(slot).cell; }
};

Standing standing_of(Machine& machine, const Instance& self) {
  auto* grid = static_cast<Instance*>(self.slots[kGridSlot].ref);
  GridResource* resource = grid ? resource_of<GridResource>(machine, grid) : nullptr;
  const auto slot = static_cast<Occupants::Slot>(self.slots[kOccupantSlot].i);
  if (!resource || !resource->occupants.holds(slot, self.id)) return {};
  return {grid, resource, slot};
}

Standing must_stand(Machine& machine, const Instance& self, const char* selector) {
  const Standing standing = standing_of(machine, self);
  if (!standing.resource)
    Machine::fail(RunErrorKind::NullObject,
                  std::string(selector) + ": " + name_of(self) + " is not on a grid; call enter-grid first");
  return standing;
}

// --- coming and going ------------------------------------------------------------------------------------------------

void leave(Machine& machine, Instance& self) {
  const Standing standing = standing_of(machine, self);
  if (standing.resource) standing.resource->occupants.leave(standing.slot);
  machine.heap().store(self.slots[kGridSlot], nullptr);
}

std::int32_t enter(Machine& machine, Instance& self, Instance* grid, CellIndex cell) {
  GridResource& resource = grid_of(machine, grid, "enter-grid: the grid");
  resource.occupants.make(*resource.grid);
  const Standing now = standing_of(machine, self);
  if (now.resource == &resource) {
    if (now.cell() != cell && !resource.occupants.has_room(cell)) return 0;
    resource.occupants.move(now.slot, cell);
    return 1;
  }
  if (!resource.occupants.has_room(cell)) return 0;
  const Occupants::Slot slot = resource.occupants.enter(self.id, cell);
  leave(machine, self);
  machine.heap().store(self.slots[kGridSlot], grid);
  self.slots[kOccupantSlot].i = static_cast<std::int32_t>(slot);
  return 1;
}

std::int32_t agent_enter(Machine& machine, Instance& self, Instance* grid, std::int32_t x, std::int32_t y,
                         std::int32_t z) {
  return enter(machine, self, grid, cell_in(grid_of(machine, grid, "enter-grid: the grid"), x, y, z));
}

std::int32_t agent_enter_free(Machine& machine, Instance& self, Instance* grid) {
  GridResource& resource = grid_of(machine, grid, "enter-free-cell: the grid");
  resource.occupants.make(*resource.grid);
  const CellIndex cell = resource.occupants.random_free(machine.world().random());
  return cell == kNoCell ? 0 : enter(machine, self, grid, cell);
}

// --- moving ----------------------------------------------------------------------------------------------------------

std::int32_t move(const Standing& standing, CellIndex cell) {
  if (cell == kNoCell) return 0;
  if (cell == standing.cell()) return 1;
  Occupants& occupants = standing.resource->occupants;
  if (!occupants.has_room(cell)) return 0;
  occupants.move(standing.slot, cell);
  return 1;
}

std::int32_t agent_move(Machine& machine, Instance& self, std::int32_t x, std::int32_t y, std::int32_t z) {
  const Standing standing = must_stand(machine, self, "move-to-cell");
  return move(standing, cell_in(*standing.resource, x, y, z));
}

std::int32_t agent_step(Machine& machine, Instance& self, std::int32_t x, std::int32_t y, std::int32_t z) {
  const Standing standing = must_stand(machine, self, "step");
  const Cell3 c = standing.resource->grid->cell(standing.cell());
  return move(standing,
              standing.resource->grid->at(std::int64_t{c.x} + x, std::int64_t{c.y} + y, std::int64_t{c.z} + z));
}

std::int32_t agent_move_to_free(Machine& machine, Instance& self) {
  const Standing standing = must_stand(machine, self, "move-to-free-cell");
  return move(standing, standing.resource->occupants.random_free(machine.world().random()));
}

std::int32_t agent_move_to_free_neighbor(Machine& machine, Instance& self, std::int32_t radius) {
  const Standing standing = must_stand(machine, self, "move-to-free-neighbor");
  const Occupants& occupants = standing.resource->occupants;
  const Grid& grid = *standing.resource->grid;
  charge_for_neighborhood(machine, grid, std::max(radius, 0), grid.flat());
  // Counted first, then one of them drawn: each is equally likely, and one random number is taken.
  std::uint64_t free = 0;
  grid.moore(standing.cell(), radius, grid.flat(), [&](CellIndex cell) { free += occupants.has_room(cell) ? 1U : 0U; });
  if (free == 0) return 0;
  std::uint64_t wanted = machine.world().random().below(free);
  CellIndex chosen = kNoCell;
  grid.moore(standing.cell(), radius, grid.flat(), [&](CellIndex cell) {
    if (occupants.has_room(cell) && wanted-- == 0) chosen = cell;
  });
  return move(standing, chosen);
}

// --- where it is -----------------------------------------------------------------------------------------------------

template <int Cell3::*Axis>
std::int32_t agent_index(Machine& machine, Instance& self) {
  const Standing standing = must_stand(machine, self, "get-index");
  return standing.resource->grid->cell(standing.cell()).*Axis;
}

Vector3 agent_get_location(Machine& machine, Instance& self) {
  const Standing standing = must_stand(machine, self, "get-location");
  return standing.resource->grid->middle(standing.cell());
}

Instance* agent_get_patch(Machine& machine, Instance& self) {
  const Standing standing = must_stand(machine, self, "get-patch");
  return patch_of(machine, *standing.grid, standing.cell());
}

Instance* agent_get_grid(Machine& machine, Instance& self) { return standing_of(machine, self).grid; }

// --- who is near -----------------------------------------------------------------------------------------------------

void push_agents(Machine& machine, const Occupants& occupants, CellIndex cell, const Instance* without,
                 ListCell& list) {
  constexpr std::uint64_t kAgentsPerIteration = 4;
  std::uint64_t count = 0;
  for (Occupants::Slot p = occupants.first(cell); p != Occupants::kNoSlot; p = occupants.next(p)) {
    if (++count % kAgentsPerIteration == 0) machine.charge(1);
    Instance* agent = machine.instance(occupants.agent(p).id);
    if (agent && agent != without) machine.heap().push(list, Value::of(Tag::Object, agent));
  }
}

ListCell* agent_get_agents(Machine& machine, Instance& self, std::int32_t radius) {
  const Standing standing = must_stand(machine, self, "get-agents");
  if (radius < 0)
    throw Error(ErrorCode::Argument, "get-agents: the radius is " + fmt::to_string(radius) + " (must be >= 0)");
  const Grid& grid = *standing.resource->grid;
  charge_for_neighborhood(machine, grid, radius, grid.flat());
  const Occupants& occupants = standing.resource->occupants;
  // Agents lie anywhere in memory: what is known of them is fetched while the list is made.
  std::uint32_t expected = 1;
  const auto fetch = [&](CellIndex cell) {
    const Occupants::Slot first = occupants.first(cell);
    if (first == Occupants::kNoSlot) return;
    __builtin_prefetch(&occupants.agent(first));
    ++expected;
  };
  constexpr std::int32_t kFarFetch = 4;  // cells; more would push each other out
  if (radius <= kFarFetch) grid.moore(standing.cell(), radius, grid.flat(), fetch);
  ListCell* list = machine.heap().list(expected);
  push_agents(machine, occupants, standing.cell(), &self, *list);
  grid.moore(standing.cell(), radius, grid.flat(),
             [&](CellIndex cell) { push_agents(machine, occupants, cell, &self, *list); });
  return list;
}

ListCell* grid_get_agents_at(Machine& machine, Instance& self, std::int32_t x, std::int32_t y, std::int32_t z) {
  const GridResource& resource = own_grid(machine, self);
  const CellIndex cell = cell_in(resource, x, y, z);
  ListCell* list = machine.heap().list();
  if (resource.occupants.made()) push_agents(machine, resource.occupants, cell, nullptr, *list);
  return list;
}

/// In the order of their cells.
ListCell* grid_get_agents(Machine& machine, Instance& self) {
  const GridResource& resource = own_grid(machine, self);
  ListCell* list = machine.heap().list();
  if (!resource.occupants.made()) return list;
  machine.charge_for(resource.grid->cells());
  for (CellIndex cell = 0; cell < resource.grid->cells(); ++cell)
    push_agents(machine, resource.occupants, cell, nullptr, *list);
  return list;
}

std::int32_t grid_count_agents(Machine& machine, Instance& self, std::int32_t x, std::int32_t y, std::int32_t z) {
  const GridResource& resource = own_grid(machine, self);
  const CellIndex cell = cell_in(resource, x, y, z);
  return resource.occupants.made() ? static_cast<std::int32_t>(resource.occupants.count(cell)) : 0;
}

std::int32_t grid_count_free(Machine& machine, Instance& self) {
  const GridResource& resource = own_grid(machine, self);
  return static_cast<std::int32_t>(resource.occupants.made() ? resource.occupants.free_cells()
                                                             : resource.grid->cells());
}

void grid_set_capacity(Machine& machine, Instance& self, std::int32_t capacity) {
  if (capacity < 0)
    throw Error(ErrorCode::Argument,
                "set-capacity: " + std::to_string(capacity) + " agents to a cell (must be >= 0; 0: any number)");
  own_grid(machine, self).occupants.set_capacity(static_cast<std::uint32_t>(capacity));
}

constexpr Native kAgentNatives[] = {
    native<leave>("grid-agent.leave-grid"),
    native<leave>("grid-agent.delete"),
    native<agent_enter>("grid-agent.enter-grid"),
    native<agent_enter_free>("grid-agent.enter-free-cell"),
    native<agent_move>("grid-agent.move-to-cell"),
    native<agent_step>("grid-agent.step"),
    native<agent_move_to_free>("grid-agent.move-to-free-cell"),
    native<agent_move_to_free_neighbor>("grid-agent.move-to-free-neighbor"),
    native<agent_index<&Cell3::x>>("grid-agent.get-x-index"),
    native<agent_index<&Cell3::y>>("grid-agent.get-y-index"),
    native<agent_index<&Cell3::z>>("grid-agent.get-z-index"),
    native<agent_get_location>("grid-agent.get-location"),
    native<agent_get_patch>("grid-agent.get-patch"),
    native<agent_get_grid>("grid-agent.get-grid"),
    native<agent_get_agents>("grid-agent.get-agents"),
    native<grid_get_agents_at>("patch-grid.get-agents-at"),
    native<grid_get_agents>("patch-grid.get-agents"),
    native<grid_count_agents>("patch-grid.count-agents"),
    native<grid_count_free>("patch-grid.count-free-cells"),
    native<grid_set_capacity>("patch-grid.set-capacity"),
};

}  // namespace

std::span<const Native> agent_natives() { return kAgentNatives; }

}  // namespace breve::steve

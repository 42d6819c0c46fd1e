// Natives of PatchGrid for cellular automata: states, rules, and updates in which scripts say what a cell becomes.
#include <cmath>

#include "steve/library/grids.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

constexpr int kMostNeighbors = 26;

std::uint8_t state_of(std::int32_t state) {
  if (state < 0 || state > 255)
    throw Error(ErrorCode::Argument, "the state " + std::to_string(state) + " of a cell (must be 0 to 255)");
  return static_cast<std::uint8_t>(state);
}

void refuse_updating(const GridResource& resource, const char* selector) {
  if (resource.updating)
    throw Error(ErrorCode::Busy, std::string(selector) + " cannot be called from inside an update of the same grid");
}

// --- states ----------------------------------------------------------------------------------------------------------

std::int32_t grid_get_state(Machine& machine, Instance& self, std::int32_t x, std::int32_t y, std::int32_t z) {
  const GridResource& resource = own_grid(machine, self);
  const CellIndex cell = cell_in(resource, x, y, z);
  return resource.states.made() ? resource.states.get(cell) : 0;
}

void grid_set_state(Machine& machine, Instance& self, std::int32_t state, std::int32_t x, std::int32_t y,
                    std::int32_t z) {
  GridResource& resource = own_grid(machine, self);
  const CellIndex cell = cell_in(resource, x, y, z);
  resource.states.make(*resource.grid);
  resource.states.set(cell, state_of(state));
}

template <class Work>
void for_each_cell(Machine& machine, const Grid& grid, Work&& work) {
  constexpr CellIndex kBetweenPolls = 1 << 16;
  for (CellIndex cell = 0; cell < grid.cells(); ++cell) {
    if (cell % kBetweenPolls == 0) machine.poll();
    work(cell);
  }
}

void grid_set_all_states(Machine& machine, Instance& self, std::int32_t state) {
  GridResource& resource = own_grid(machine, self);
  machine.charge_for(resource.grid->cells());
  resource.states.make(*resource.grid);
  for_each_cell(machine, *resource.grid, [&](CellIndex cell) { resource.states.set(cell, state_of(state)); });
}

void grid_randomize_states(Machine& machine, Instance& self, double density) {
  GridResource& resource = own_grid(machine, self);
  finite(density, "randomize-states: the density");
  constexpr std::uint64_t kOfCell = 4;
  machine.charge_for(kOfCell * resource.grid->cells());
  resource.states.make(*resource.grid);
  for_each_cell(machine, *resource.grid, [&](CellIndex cell) {
    resource.states.set(cell, machine.world().random().uniform() < density ? 1 : 0);
  });
}

std::int32_t grid_count_states(Machine& machine, Instance& self, std::int32_t state) {
  const GridResource& resource = own_grid(machine, self);
  if (!resource.states.made()) return state == 0 ? static_cast<std::int32_t>(resource.grid->cells()) : 0;
  machine.charge_for(resource.grid->cells() / 16);  // bytes, many at once
  return static_cast<std::int32_t>(resource.states.count(state_of(state)));
}

std::int32_t grid_get_neighbor_count(Machine& machine, Instance& self, std::int32_t x, std::int32_t y, std::int32_t z) {
  const GridResource& resource = own_grid(machine, self);
  const CellIndex cell = cell_in(resource, x, y, z);
  return resource.states.made() ? resource.states.neighbors(*resource.grid, resource.neighborhood, cell) : 0;
}

// --- settings --------------------------------------------------------------------------------------------------------

/// The place of `name` among `names`. @throws Error{Argument} that lists them
int choice(std::string_view selector, std::string_view name, std::span<const std::string_view> names) {
  std::string all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<int>(i);
    all += (i == 0 ? "\"" : ", \"") + std::string(names[i]) + "\"";
  }
  throw Error(ErrorCode::Argument, std::string(selector) + ": no '" + std::string(name) + "'; there are " + all);
}

void grid_set_neighborhood(Machine& machine, Instance& self, StringCell* name) {
  // KEEP IN STEP: Neighborhood.
  constexpr std::string_view kNames[] = {"moore", "von-neumann", "3d-moore", "3d-von-neumann"};
  GridResource& resource = own_grid(machine, self);
  resource.neighborhood = static_cast<Neighborhood>(choice("set-neighborhood", view(name), kNames));
}

void grid_set_update_order(Machine& machine, Instance& self, StringCell* name) {
  // KEEP IN STEP: UpdateOrder.
  constexpr std::string_view kNames[] = {"synchronous", "sequential", "random"};
  GridResource& resource = own_grid(machine, self);
  refuse_updating(resource, "set-update-order");
  resource.order = static_cast<UpdateOrder>(choice("set-update-order", view(name), kNames));
}

// --- rules -----------------------------------------------------------------------------------------------------------

std::uint32_t numbers_of(ListCell* list, const char* what) {
  std::uint32_t bits = 0;
  if (!list) return bits;
  for (const Value& number : *list) {
    if (number.tag != Tag::Int || number.i < 0 || number.i > kMostNeighbors)
      throw Error(ErrorCode::Argument,
                  std::string("set-rule: ") + what + " must list numbers of neighbors, ints from 0 to 26");
    bits |= 1U << number.i;
  }
  return bits;
}

/// Checks the lists and yields a set of numbers as a mask, for apply-rule.
std::int32_t grid_rule_mask(Machine&, Instance&, ListCell* numbers, StringCell* what) {
  return static_cast<std::int32_t>(numbers_of(numbers, std::string(view(what)).c_str()));
}

void grid_apply_rule(Machine& machine, Instance& self, std::int32_t born, std::int32_t survive, std::int32_t times) {
  GridResource& resource = own_grid(machine, self);
  refuse_updating(resource, "apply-rule");
  resource.states.make(*resource.grid);
  const TotalisticRule rule{static_cast<std::uint32_t>(born), static_cast<std::uint32_t>(survive)};
  // What takes about as long as an iteration of a script's loop, or as some where the grid is small. Cells at once are
  // taken by rows, others one by one.
  constexpr std::size_t kOfStep = 6;
  const std::size_t cells_per_iteration = resource.order == UpdateOrder::Synchronous ? 32 : 1;
  for (std::int32_t i = 0; i < times; ++i) {
    machine.charge(kOfStep + resource.grid->cells() / cells_per_iteration);
    const StageScope timed = machine.world().work(EffectId::Patches, self.id, resource.grid->cells());
    resource.states.step(*resource.grid, resource.neighborhood, rule, resource.order, machine.world().random(),
                         machine.poller());
  }
}

// --- updates by scripts ----------------------------------------------------------------------------------------------

/// One update of a grid that calls scripts: they may do anything, even free the grid or make it anew.
class Update {
 public:
  Update(Machine& machine, Instance& self, const char* selector) : machine_(machine), self_(self), selector_(selector) {
    GridResource& resource = own_grid(machine, self);
    refuse_updating(resource, selector);
    resource.states.make(*resource.grid);
    cells_ = resource.grid->cells();
    order_ = resource.order;
    if (order_ == UpdateOrder::Random) {
      // On the script heap's own meter, as all else.
      shuffled_ = std::pmr::vector<CellIndex>(machine.heap().memory());
      shuffled(cells_, machine.world().random(), *shuffled_);
    }
  }
  ~Update() {
    GridResource* resource = begun_ ? resource_of<GridResource>(machine_, &self_) : nullptr;
    if (!resource) return;
    resource->updating = false;
    resource->states.abandon();
  }
  Update(const Update&) = delete;
  Update& operator=(const Update&) = delete;

  void begin() {
    GridResource& resource = own_grid(machine_, self_);
    if (synchronous()) resource.states.begin();
    resource.updating = begun_ = true;
  }
  void end() {
    GridResource& same = resource();
    if (synchronous()) same.states.end();
    same.updating = false;
    begun_ = false;
  }
  bool synchronous() const { return order_ == UpdateOrder::Synchronous; }
  std::size_t cells() const { return cells_; }
  CellIndex cell(std::size_t i) const { return shuffled_ ? (*shuffled_)[i] : static_cast<CellIndex>(i); }
  /// The grid's data, if it is still that of the beginning.
  GridResource& resource() {
    GridResource* resource = resource_of<GridResource>(machine_, &self_);
    if (!resource || !resource->updating)
      Machine::fail(RunErrorKind::World,
                    std::string(selector_) + ": the grid was freed or initialised again meanwhile");
    return *resource;
  }

 private:
  Machine& machine_;
  Instance& self_;
  const char* selector_;
  std::size_t cells_ = 0;
  UpdateOrder order_ = UpdateOrder::Synchronous;
  std::optional<std::pmr::vector<CellIndex>> shuffled_;
  bool begun_ = false;
};

/// The rule's answer as a state. @throws RunError{Type}
std::uint8_t state_from(const Value& answer) {
  if (answer.tag == Tag::Int && answer.i >= 0 && answer.i <= 255) return static_cast<std::uint8_t>(answer.i);
  Machine::fail(RunErrorKind::Type, "update-states: the rule must return a state, an int from 0 to 255");
}

void grid_update_states(Machine& machine, Instance& self, StringCell* name) {
  const MethodInfo* brief = machine.find_method(*self.cls, view(name), 2);
  const MethodInfo* full = brief ? nullptr : machine.find_method(*self.cls, view(name), 5);
  if (!brief && !full)
    Machine::fail(RunErrorKind::UnknownMethod, "update-states: " + name_of(self) + " has no method '" +
                                                   std::string(view(name)) +
                                                   "' with 2 keywords (state, neighbors) or 5 (and x, y, z)");
  const Pin pin(machine, Value::of(Tag::Object, &self));
  Update update(machine, self, "update-states");
  const StageScope timed = machine.world().work(EffectId::Patches, self.id, update.cells());
  std::span<const std::uint8_t> counts;
  {
    GridResource& resource = own_grid(machine, self);
    if (update.synchronous()) counts = resource.states.neighbor_counts(*resource.grid, resource.neighborhood);
  }
  update.begin();
  for (std::size_t i = 0; i < update.cells(); ++i) {
    const CellIndex cell = update.cell(i);
    const GridResource& before = update.resource();
    const int neighbors =
        update.synchronous() ? counts[cell] : before.states.neighbors(*before.grid, before.neighborhood, cell);
    Value arguments[5] = {Value::of(std::int32_t{before.states.get(cell)}), Value::of(std::int32_t{neighbors})};
    if (full) {
      const Cell3 c = before.grid->cell(cell);
      arguments[2] = Value::of(std::int32_t{c.x});
      arguments[3] = Value::of(std::int32_t{c.y});
      arguments[4] = Value::of(std::int32_t{c.z});
    }
    const MethodInfo& rule = brief ? *brief : *full;
    const std::uint8_t state = state_from(machine.call(self, rule, std::span(arguments, brief ? 2U : 5U)));
    update.resource().states.set(cell, state);
  }
  update.end();
}

void grid_update_patches(Machine& machine, Instance& self, StringCell* name) {
  const Pin pin(machine, Value::of(Tag::Object, &self));
  Update update(machine, self, "update-patches");
  const StageScope timed = machine.world().work(EffectId::Patches, self.id, update.cells());
  update.begin();
  const std::string method(view(name));
  for (std::size_t i = 0; i < update.cells(); ++i) {
    update.resource();
    if (Instance* patch = patch_of(machine, self, update.cell(i))) machine.call(*patch, method);
  }
  update.end();
}

constexpr Native kCellNatives[] = {
    native<grid_get_state>("patch-grid.get-state"),
    native<grid_set_state>("patch-grid.set-state"),
    native<grid_set_all_states>("patch-grid.set-all-states"),
    native<grid_randomize_states>("patch-grid.randomize-states"),
    native<grid_count_states>("patch-grid.count-states"),
    native<grid_get_neighbor_count>("patch-grid.get-neighbor-count"),
    native<grid_set_neighborhood>("patch-grid.set-neighborhood"),
    native<grid_set_update_order>("patch-grid.set-update-order"),
    native<grid_rule_mask>("patch-grid.rule-mask"),
    native<grid_apply_rule>("patch-grid.apply-rule"),
    native<grid_update_states>("patch-grid.update-states"),
    native<grid_update_patches>("patch-grid.update-patches"),
};

}  // namespace

std::span<const Native> cell_natives() { return kCellNatives; }

}  // namespace breve::steve

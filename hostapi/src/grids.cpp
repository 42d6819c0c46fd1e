// Grids of cells from C: their size, and the array of a chemical as a whole.
#include "steve/library/grids.hpp"

#include <algorithm>

#include "internal.hpp"

using namespace breve::host;

namespace {

const breve::Grid& grid_of(const breve_world& world, breve_object grid) {
  auto* resource = breve::steve::resource_of<breve::steve::GridResource>(*world.machine, &live_instance(world, grid));
  if (!resource || !resource->grid)
    fail(BREVE_ERROR_NOT_FOUND,
         "the object has no cells: it is not a PatchGrid, or its init-with has not been called yet");
  return *resource->grid;
}

/// The chemical's array, as long as the grid has cells.
breve::Field& field_of(const breve_world& world, breve_object grid, breve_object chemical) {
  const std::size_t cells = grid_of(world, grid).cells();
  breve::Field* field =
      breve::steve::chemical_field(*world.machine, live_instance(world, grid), live_instance(world, chemical));
  if (!field || field->size() != cells)
    fail(BREVE_ERROR_NOT_FOUND, "the grid does not track this chemical; call its method track first");
  return *field;
}

}  // namespace

breve_status breve_grid_size(const breve_world* world, breve_object grid, uint32_t counts[3]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(counts, "counts");
    const breve::Grid& of = grid_of(*world, grid);
    const int all[3] = {of.nx(), of.ny(), of.nz()};
    for (int i = 0; i < 3; ++i) counts[i] = static_cast<uint32_t>(all[i]);
  });
}

breve_status breve_grid_concentrations(const breve_world* world, breve_object grid, breve_object chemical,
                                       double* values, size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (capacity != 0) need(values, "values");
    need(count, "count");
    const breve::Field& field = field_of(*world, grid, chemical);
    std::copy_n(field.values().data(), std::min(capacity, field.size()), values);
    *count = field.size();
  });
}

breve_status breve_grid_set_concentrations(breve_world* world, breve_object grid, breve_object chemical,
                                           const double* values, size_t count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(values, "values");
    breve::Field& field = field_of(*world, grid, chemical);
    if (count != field.size())
      fail(BREVE_ERROR_ARGUMENT,
           "count is " + std::to_string(count) + ", but the grid has " + std::to_string(field.size()) + " cells");
    need_finite(values, count, "values");
    std::copy_n(values, count, field.data());
  });
}

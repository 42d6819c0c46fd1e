// The data of PatchGrid objects: the cells as arrays, and the Patch objects of those that a script asked for.
#pragma once

#include <memory_resource>
#include <optional>
#include <string_view>
#include <vector>

#include "runtime/patches/cell_states.hpp"
#include "runtime/patches/field.hpp"
#include "runtime/patches/grid.hpp"
#include "runtime/patches/occupants.hpp"
#include "runtime/world/resource.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

/// A PatchGrid or PatchToroid object. Arrays by cell are empty until something is in them.
class GridResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "grid";
  static constexpr double kAlpha = 0.5;  // of a cell that nobody set

  explicit GridResource(std::pmr::memory_resource* memory)
      : patches(memory), colors(memory), alphas(memory), states(memory), occupants(memory) {}

  std::optional<Grid> grid;            // none until init-with
  std::pmr::vector<ObjectId> patches;  // null: not made yet; stale: freed
  std::pmr::vector<Vector3> colors;    // white until set
  std::pmr::vector<double> alphas;     // kAlpha until set
  CellStates states;
  Occupants occupants;
  Neighborhood neighborhood = Neighborhood::Moore;
  UpdateOrder order = UpdateOrder::Synchronous;
  bool updating = false;  // an update that calls scripts runs

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);

  void make_colors() { colors.resize(grid->cells(), Vector3(1, 1, 1)); }
  void make_alphas() { alphas.resize(grid->cells(), kAlpha); }
};

/// The cells of a PatchGrid object.
/// @throws RunError{NullObject, FreedObject} naming `what`, also if it has no cells yet
GridResource& grid_of(Machine& machine, Instance* object, std::string_view what);
inline GridResource& own_grid(Machine& machine, Instance& self) { return grid_of(machine, &self, "this object"); }

/// The cell with these indices. @throws RunError{Bounds} outside
CellIndex cell_in(const GridResource& resource, std::int32_t x, std::int32_t y, std::int32_t z);

/// The Patch object of a cell, made if this is the first time; null if it was freed.
Instance* patch_of(Machine& machine, Instance& grid, CellIndex cell);

/// Charges for so many cells around one, all of which a native is about to look at.
/// @param size  how far they are from it along each axis, cells; >= 0
/// @param flat  those in the plane of x and y alone
void charge_for_neighborhood(Machine& machine, const Grid& grid, std::int32_t size, bool flat);

/// The matrix of a chemical that a grid tracks; null if it does not.
Field* chemical_field(Machine& machine, Instance& grid, Instance& chemical);

/// Does a class of patches have variables or methods of its own, so that its objects cannot be made later?
/// @throws RunError{UnknownClass}, Error{Argument} if there is no such class or it is not a Patch
bool has_code(Machine& machine, std::string_view patch_class);

// KEEP IN STEP: the variables of Object and Patch come in this order (Object.tz, Patch.tz).
inline constexpr std::uint32_t kPatchGridSlot = 3, kPatchXSlot = 4, kPatchYSlot = 5, kPatchZSlot = 6;

/// Where a Patch object is; no resource while it belongs to no grid.
struct PatchCell {
  Instance* grid = nullptr;
  GridResource* resource = nullptr;
  CellIndex cell = kNoCell;
};
PatchCell cell_of(Machine& machine, const Instance& patch);
/// The same. @throws RunError{NullObject} if it belongs to no grid
PatchCell attached(Machine& machine, const Instance& patch);

}  // namespace breve::steve

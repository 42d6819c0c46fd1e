// Menu entries that scripts make for the user, as a host reads and chooses them. The controller's entries are the main
// menu, those of any other object its context menu.
#pragma once

#include <memory>
#include <memory_resource>
#include <string>
#include <vector>

#include "runtime/base/ids.hpp"
#include "runtime/world/resource.hpp"

namespace breve {

class World;

/// The native data of a MenuItem object.
class MenuItemResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "menu-item";
  explicit MenuItemResource(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : name(memory), method(memory) {}

  ObjectId owner;           // the object whose menu it is in
  std::pmr::string name;    // as shown; empty for a separator
  std::pmr::string method;  // of the owner, without parameters; called when the entry is chosen
  bool checked = false;
  bool enabled = true;

  bool separator() const { return name.empty(); }
  /// Choosing anything else does nothing.
  bool can_be_chosen() const { return enabled && !separator(); }

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

/// The entry that a menu object stands for; null if `item` is stale or no created entry.
const MenuItemResource* menu_item(const World& world, ObjectId item);
MenuItemResource* menu_item(World& world, ObjectId item);

/// Entries that every body has besides its own. They are not objects: a host that offers them calls the method.
struct StandardEntry {
  std::string_view name;
  std::string_view method;
};
inline constexpr StandardEntry kBodyMenu[] = {{"Delete", "delete-instance"}, {"Follow With Camera", "watch"}};

}  // namespace breve

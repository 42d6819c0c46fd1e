// Natives of MenuItem.
#include "runtime/world/menu.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

/// Checking, enabling and so on do nothing to an item that was never created.
MenuItemResource* created(Machine& machine, Instance& self) { return resource_of<MenuItemResource>(machine, &self); }

Instance* menu_create(Machine& machine, Instance& self, Text name, Instance* owner, Text method) {
  const Instance& target = must_live(owner, "create-menu: the object");
  if (!view(name).empty() && !machine.find_method(*target.cls, view(method), 0)) {
    machine.warn("menu entry '" + std::string(view(name)) + "' not created: " + name_of(target) + " has no method '" +
                 std::string(view(method)) + "' without keywords");
    machine.free_instance(self);
    return nullptr;
  }
  MenuItemResource& item = resource_made<MenuItemResource>(machine, self);
  item.owner = target.id;
  item.name = view(name);
  item.method = view(method);
  return &self;
}

template <bool MenuItemResource::*Flag, bool On>
void menu_set(Machine& machine, Instance& self) {
  if (MenuItemResource* item = created(machine, self)) item->*Flag = On;
}

Text menu_get_description(Machine& machine, Instance& self) {
  const MenuItemResource* item = created(machine, self);
  return item ? machine.heap().string(item->name) : nullptr;
}

constexpr Native kMenuNatives[] = {
    native<menu_create>("menu.create"),
    native<menu_set<&MenuItemResource::checked, true>>("menu.check"),
    native<menu_set<&MenuItemResource::checked, false>>("menu.uncheck"),
    native<menu_set<&MenuItemResource::enabled, true>>("menu.enable"),
    native<menu_set<&MenuItemResource::enabled, false>>("menu.disable"),
    native<menu_get_description>("menu.get-description"),
};

}  // namespace

std::span<const Native> menu_natives() { return kMenuNatives; }

}  // namespace breve::steve

// Menu entries: found by their resource, saved with the world.
#include "runtime/world/menu.hpp"

#include "runtime/world/world.hpp"

namespace breve {

void MenuItemResource::save(ByteWriter& out) const {
  out.put(owner);
  out.put(std::string_view(name));
  out.put(std::string_view(method));
  out.put(checked);
  out.put(enabled);
}

void MenuItemResource::hash(Hasher& hasher) const {
  hasher.add(static_cast<std::uint64_t>(owner.index) << 32 | owner.generation);
  hasher.add(std::string_view(name));
  hasher.add(std::string_view(method));
  hasher.add(static_cast<std::uint64_t>(checked) * 2 + static_cast<std::uint64_t>(enabled));
}

std::unique_ptr<Resource> MenuItemResource::load(ByteReader& in) {
  auto item = make_in<MenuItemResource>(in.memory(), in.memory());
  item->owner = in.get_object();
  item->name = in.get_text();
  item->method = in.get_text();
  item->checked = in.get_bool();
  item->enabled = in.get_bool();
  return item;
}

const MenuItemResource* menu_item(const World& world, ObjectId item) {
  return dynamic_cast<const MenuItemResource*>(world.resource(item));
}

MenuItemResource* menu_item(World& world, ObjectId item) {
  return dynamic_cast<MenuItemResource*>(world.resource(item));
}

}  // namespace breve

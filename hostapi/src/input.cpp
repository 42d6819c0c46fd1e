// Input of the user, queued for the next iteration, and the menus that scripts offer.
#include <cstring>

#include "internal.hpp"
#include "runtime/world/menu.hpp"

using namespace breve::host;
using breve::InputEvent;
using breve::ObjectId;

namespace {

/// How many bytes the character of UTF-8 takes that begins here; 0: none does.
std::size_t length_of_character(const char* text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t length = first == 0               ? 0
                             : first < 0x80           ? 1
                             : (first & 0xe0) == 0xc0 ? 2
                             : (first & 0xf0) == 0xe0 ? 3
                             : (first & 0xf8) == 0xf0 ? 4
                                                      : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  return length;
}

bool is_key(const char* key) {
  const std::size_t length = length_of_character(key);
  if (length != 0 && key[length] == '\0') return true;
  // A byte of some other encoding is one character.
  if (key[0] != '\0' && key[1] == '\0') return true;
  for (const char* arrow : {"up", "down", "left", "right"})
    if (std::strcmp(key, arrow) == 0) return true;
  return false;
}

}  // namespace

breve_status breve_world_queue_key(breve_world* world, const char* key, bool down) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(key, "key");
    if (!is_key(key))
      fail(BREVE_ERROR_ARGUMENT,
           "'" + std::string(key) + "' is not a key: it must be one character, or up, down, left, right");
    world->world->queue_input({down ? InputEvent::Kind::KeyDown : InputEvent::Kind::KeyUp, key, {}});
  });
}

breve_status breve_world_queue_click(breve_world* world, breve_object object) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const ObjectId id = is_null(object) ? ObjectId{} : live_id(*world, object);
    world->world->queue_input({InputEvent::Kind::Click, {}, id});
  });
}

breve_status breve_world_menu_items(const breve_world* world, breve_menu_item* items, size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (capacity != 0) need(items, "items");
    need(count, "count");
    std::pmr::memory_resource* const memory = world->menu_texts.get_allocator().resource();
    std::pmr::vector<breve_menu_item> found(memory);
    std::pmr::vector<std::pair<std::pmr::string, std::pmr::string>> texts(memory);
    for (const ObjectId id : world->world->objects()) {
      const auto* item = breve::menu_item(std::as_const(*world->world), id);
      if (!item) continue;
      texts.emplace_back(item->name, item->method);
      found.push_back({handle_of(*world, id), handle_of(*world, item->owner), nullptr, nullptr, item->separator(),
                       item->enabled, item->checked});
    }
    world->menu_texts.swap(texts);
    for (std::size_t i = 0; i < std::min(capacity, found.size()); ++i) {
      items[i] = found[i];
      items[i].title = world->menu_texts[i].first.c_str();
      items[i].method = world->menu_texts[i].second.c_str();
    }
    *count = found.size();
  });
}

breve_status breve_world_queue_choice(breve_world* world, breve_object item) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const ObjectId id = live_id(*world, item);
    if (!breve::menu_item(std::as_const(*world->world), id))
      fail(BREVE_ERROR_ARGUMENT, "the object is not a menu item");
    world->world->queue_input({InputEvent::Kind::Menu, {}, id});
  });
}

breve_status breve_world_queue_click_ray(breve_world* world, const double start[3], const double way[3]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  bool found = false;
  breve_hit hit{};
  const breve_status status = breve_world_ray_first(world, start, way, nullptr, &found, &hit);
  return status == BREVE_OK ? breve_world_queue_click(world, found ? hit.object : breve_object{}) : status;
}

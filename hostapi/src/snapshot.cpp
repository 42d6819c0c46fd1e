// The whole state of a world as a number, and as an image.
#include <cstring>

#include "internal.hpp"

using namespace breve::host;

breve_status breve_world_hash(const breve_world* world, uint64_t* hash) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(hash, "hash");
    need_idle(*world, "breve_world_hash");
    *hash = world->world->hash();
  });
}

breve_status breve_world_snapshot(const breve_world* world, void* image, size_t capacity, size_t* size) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (capacity != 0) need(image, "image");
    need(size, "size");
    need_idle(*world, "breve_world_snapshot");
    const auto bytes = world->world->save(world->program->fingerprint());
    if (bytes.size() <= capacity) std::memcpy(image, bytes.data(), bytes.size());
    *size = bytes.size();
  });
}

breve_status breve_world_restore(breve_world* world, const void* image, size_t size) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(image, "image");
    need_idle(*world, "breve_world_restore");
    world->world->load(static_cast<const std::uint8_t*>(image), size, world->program->fingerprint());
    world->references.forget_all();  // an image that is refused changes nothing, these neither
    world->remainder = 0;
    world->previous.forget();
  });
}

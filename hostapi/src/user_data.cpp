// What the host keeps with worlds and objects, and the memory that it takes for it.
#include <algorithm>

#include "functions.hpp"
#include "internal.hpp"

namespace breve::host {

namespace {

/// Callbacks by which data of the host ends find the world busy while this stands.
class EndScope {
 public:
  explicit EndScope(breve_world& world) : world_(world) { ++world_.running; }
  ~EndScope() { --world_.running; }
  EndScope(const EndScope&) = delete;
  EndScope& operator=(const EndScope&) = delete;

 private:
  breve_world& world_;
};

}  // namespace

void end_data(breve_world& world, ObjectId id) {
  const EndScope busy(world);
  for (const NamedState& s : world.states) {
    const StateScope scope(world);
    if (s.state.gone) s.state.gone(s.state.user, handle_of(world, id));
  }
  if (id.index >= world.object_data.size()) return;
  world.object_data[id.index] = {};
}

void forget_data(breve_world& world) {
  const EndScope busy(world);
  for (std::size_t i = 0; i < world.object_data.size(); ++i) {
    ObjectData& data = world.object_data[i];
    if (data.ticket == 0 || world.world->holder(static_cast<std::uint32_t>(i), data.ticket)) continue;
    data = {};
  }
}

namespace {

constexpr std::size_t kAlignment = alignof(std::max_align_t);

auto state_named(std::vector<NamedState>& states, std::string_view name) {
  return std::find_if(states.begin(), states.end(), [&](const NamedState& s) { return s.name == name; });
}

}  // namespace
}  // namespace breve::host

using namespace breve::host;

breve_status breve_world_set_user(breve_world* world, void* user, void (*destroy)(void* user)) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  const EndScope busy(*world);
  world->user = UserData(user, destroy);
  return BREVE_OK;
}

breve_status breve_object_set_user(breve_world* world, breve_object object, void* user, void (*destroy)(void* user)) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const auto id = live_id(*world, object);
    const EndScope busy(*world);
    auto& all = world->object_data;
    if (id.index >= all.size()) all.resize(id.index + 1);
    all[id.index].ticket = ticket_of(*world, object);
    all[id.index].user = UserData(user, destroy);
  });
}

breve_status breve_object_user(const breve_world* world, breve_object object, void** user) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(user, "user");
    const auto id = live_id(*world, object);
    *user = id.index < world->object_data.size() ? world->object_data[id.index].user.get() : nullptr;
  });
}

breve_status breve_world_set_state(breve_world* world, const char* name, const breve_state* state) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(name, "name");
    if (world->in_state)
      fail(BREVE_ERROR_BUSY, "breve_world_set_state may not be called by a callback of a state of this world");
    const EndScope busy(*world);
    const auto old = state_named(world->states, name);
    if (!state) {
      if (old == world->states.end()) return;
      const NamedState ended = std::move(*old);
      world->states.erase(old);
      return;
    }
    const auto given = read_config(state, breve_state_default(), "breve_state");
    if (given.save && !given.load) fail(BREVE_ERROR_ARGUMENT, "breve_state.save is given, and breve_state.load is not");
    if (old == world->states.end()) {
      world->states.push_back({name, given, UserData(nullptr, nullptr)});
      world->states.back().user = UserData(given.user, given.destroy);
    } else {
      old->state = given;
      old->user = UserData(given.user, given.destroy);
    }
  });
}

void* breve_world_state(const breve_world* world, const char* name) {
  if (!world || !name) return nullptr;
  for (const NamedState& s : world->states)
    if (s.name == name) return s.state.user;
  return nullptr;
}

void* breve_world_allocate(breve_world* world, size_t size) {
  if (!world || size == 0) return nullptr;
  void* memory = nullptr;
  guard([&] { memory = world->meter.allocate(size, kAlignment); });
  return memory;
}

void breve_world_release(breve_world* world, void* memory, size_t size) {
  if (world && memory) world->meter.deallocate(memory, size, kAlignment);
}

// The whole state of a world as a number, and as an image: the world's own, and behind it that of the host.
#include <algorithm>
#include <cstring>

#include "internal.hpp"
#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"

namespace breve::host {
namespace {

constexpr std::uint64_t kMark = 0x746174732e747368;  // at the end of an image with state of the host

std::string state_of(breve_world& world, const breve_state& state) {
  Answer bytes, reason;
  const CallbackScope busy(world);
  const StateScope scope(world);
  if (!state.save(state.user, &world, &Answer::add, &bytes, &Answer::add, &reason)) {
    const std::string text = without_zeros(reason.text());
    fail(BREVE_ERROR_UNSUPPORTED, text.empty() ? "the host cannot save its state" : text);
  }
  return bytes.text();
}

bool has_state(const breve_world& world) {
  return std::any_of(world.states.begin(), world.states.end(), [](const auto& s) { return s.state.save != nullptr; });
}

/// The name and the bytes of each state, each behind its size.
std::string states_of(const breve_world& world) {
  auto& running = const_cast<breve_world&>(world);  // the callbacks get the world as all do, and change nothing
  std::string all;
  const auto add = [&](std::string_view bytes) {
    const std::uint64_t size = bytes.size();
    all.append(reinterpret_cast<const char*>(&size), sizeof size);
    all.append(bytes);
  };
  for (const NamedState& s : running.states) {
    if (!s.state.save) continue;
    add(s.name);
    add(state_of(running, s.state));
  }
  return all;
}

/// An image in its parts: the world, and behind it what the host saved, if it saves anything.
class Image {
 public:
  explicit Image(const breve_world& world)
      : has_states_(has_state(world)),
        states_(has_states_ ? states_of(world) : std::string()),
        world_(world.world->save(world.program->fingerprint())) {}
  std::size_t size() const { return world_.size() + (has_states_ ? states_.size() + 2 * sizeof kMark : 0); }
  void write(char* to) const {
    to = std::copy(world_.begin(), world_.end(), to);
    if (!has_states_) return;
    const std::uint64_t tail[2] = {states_.size(), kMark};
    std::memcpy(std::copy(states_.begin(), states_.end(), to), tail, sizeof tail);
  }

 private:
  const bool has_states_;
  const std::string states_;
  const std::pmr::vector<std::uint8_t> world_;
};

[[noreturn]] void fail_image(const char* why) { fail(BREVE_ERROR_IMAGE, std::string("the image ") + why); }

/// Cuts the host's part off the end of an image.
std::string_view cut_states(const char* image, std::size_t& size) {
  std::uint64_t tail[2] = {0, 0};
  if (size >= sizeof tail) std::memcpy(tail, image + size - sizeof tail, sizeof tail);
  if (tail[1] != kMark || tail[0] > size - sizeof tail)
    fail_image("has no state of the host: it is of a world without, or damaged");
  size -= sizeof tail + static_cast<std::size_t>(tail[0]);
  return {image + size, static_cast<std::size_t>(tail[0])};
}

/// What of the host's part belongs to which state of the world, in their order.
std::vector<std::string_view> states_in(const breve_world& world, std::string_view rest) {
  const auto next = [&] {
    std::uint64_t size = 0;
    if (rest.size() < sizeof size) fail_image("is cut off in the state of the host");
    std::memcpy(&size, rest.data(), sizeof size);
    rest.remove_prefix(sizeof size);
    if (size > rest.size()) fail_image("is cut off in the state of the host");
    const auto bytes = rest.substr(0, static_cast<std::size_t>(size));
    rest.remove_prefix(bytes.size());
    return bytes;
  };
  std::vector<std::string_view> found;
  for (const NamedState& s : world.states) {
    if (!s.state.save) continue;
    if (rest.empty() || next() != s.name) fail_image("was taken with other state of the host");
    found.push_back(next());
  }
  if (!rest.empty()) fail_image("was taken with other state of the host");
  return found;
}

/// @return  false: one of them refused
bool load_states(breve_world& world, const std::vector<std::string_view>& states, bool commit) {
  auto bytes = states.begin();
  for (const NamedState& s : world.states) {
    if (!s.state.save) continue;
    const CallbackScope busy(world);
    const StateScope scope(world);
    if (!s.state.load(s.state.user, &world, bytes->data(), bytes->size(), commit)) return false;
    ++bytes;
  }
  return true;
}

void restore(breve_world& world, const char* image, std::size_t size) {
  std::vector<std::string_view> states;
  if (has_state(world)) states = states_in(world, cut_states(image, size));
  if (!load_states(world, states, false)) fail_image("has state of the host that is damaged, or of another program");
  world.world->load(reinterpret_cast<const std::uint8_t*>(image), size, world.program->fingerprint());
  world.references.forget_all();  // an image that is refused changes nothing, these neither
  world.remainder = 0;
  world.previous.forget();
  forget_data(world);
  if (!load_states(world, states, true)) throw std::bad_alloc();
}

}  // namespace

std::uint64_t hash_of(const breve_world& world) {
  const std::uint64_t number = world.world->hash();
  if (!has_state(world)) return number;
  Hasher hasher;
  hasher.add(number);
  hasher.add(std::string_view(states_of(world)));
  return hasher.value();
}

std::string image_of(const breve_world& world) {
  const Image image(world);
  std::string bytes(image.size(), '\0');
  image.write(bytes.data());
  return bytes;
}

void restore_image(breve_world& world, std::string_view image) { restore(world, image.data(), image.size()); }

}  // namespace breve::host

using namespace breve::host;

breve_status breve_world_hash(const breve_world* world, uint64_t* hash) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(hash, "hash");
    need_idle(*world, "breve_world_hash");
    *hash = hash_of(*world);
  });
}

breve_status breve_world_snapshot(const breve_world* world, void* image, size_t capacity, size_t* size) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (capacity != 0) need(image, "image");
    need(size, "size");
    need_idle(*world, "breve_world_snapshot");
    const Image made(*world);
    if (made.size() <= capacity) made.write(static_cast<char*>(image));
    *size = made.size();
  });
}

breve_status breve_world_restore(breve_world* world, const void* image, size_t size) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(image, "image");
    need_idle(*world, "breve_world_restore");
    restore(*world, static_cast<const char*>(image), size);
  });
}

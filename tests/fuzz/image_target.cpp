// Forged images: some bytes of a world's image are others, and its length and checksum are made right again. A restore
// takes it, and then the world can be used like any other, or refuses it and has changed nothing.
#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "image_scenes.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace breve::fuzz {

namespace {

// --- the form of an image: magic, version, program, length and checksum of the rest, the rest ------------------------

constexpr std::size_t kLengthAt = 20, kChecksumAt = 28, kBody = 36;

/// As the library computes it: words of eight bytes, each multiplied to 128 bits and folded.
std::uint64_t checksum(std::string_view bytes) {
  __extension__ using Wide = unsigned __int128;
  std::uint64_t state = 0x2545f4914f6cdd1dU;
  const auto add = [&state](std::uint64_t word) {
    const Wide product = static_cast<Wide>(state ^ word) * 0x9e3779b97f4a7c15U;
    state = static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64) ^ 0xd1b54a32d192ed03U;
  };
  add(bytes.size());
  for (; bytes.size() >= 8; bytes.remove_prefix(8)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), 8);
    add(word);
  }
  std::uint64_t rest = 0;
  std::memcpy(&rest, bytes.data(), bytes.size());
  add(rest);
  return state;
}

void seal(std::string& image) {
  if (image.size() < kBody) return;
  const std::uint64_t length = image.size() - kBody, sum = checksum(std::string_view(image).substr(kBody));
  std::memcpy(image.data() + kLengthAt, &length, sizeof length);
  std::memcpy(image.data() + kChecksumAt, &sum, sizeof sum);
}

// --- forging ---------------------------------------------------------------------------------------------------------

/// Numbers that are wrong in most places: counts, indices, bounds of types, what is not a number.
constexpr std::uint64_t kWords[] = {0,
                                    1,
                                    2,
                                    3,
                                    5,
                                    16,
                                    255,
                                    65536,
                                    1000000,
                                    0x7fffffffU,
                                    0xffffffffU,
                                    0x100000000U,
                                    0x7fffffffffffffffU,
                                    0x8000000000000000U,
                                    0xffffffffffffffffU,
                                    0x3ff0000000000000U,  // 1.0
                                    0xbff0000000000000U,  // -1.0
                                    0x7fefffffffffffffU,  // the largest double
                                    0x0000000000000001U,  // the smallest
                                    0x7ff0000000000000U,  // infinity
                                    0xfff0000000000000U,
                                    0x7ff8000000000000U};  // no number

std::size_t place_in(Choices& choices, std::size_t size) {
  const std::size_t high = choices.below(256), low = choices.below(65536);
  return size == 0 ? 0 : (high << 16 | low) % size;
}

void put(std::string& image, std::size_t at, const void* bytes, std::size_t size) {
  if (at < image.size()) std::memcpy(image.data() + at, bytes, std::min(size, image.size() - at));
}

/// One change, mostly of what follows the head.
void forge(std::string& image, const std::string& other, Choices& choices) {
  const std::size_t body = image.size() > kBody ? image.size() - kBody : 0;
  const std::size_t at = choices.chance(97) ? kBody + place_in(choices, body) : place_in(choices, image.size());
  if (at >= image.size()) return;
  switch (choices.below(12)) {
    case 0:
    case 1: image[at] = static_cast<char>(image[at] ^ (1 << choices.below(8))); break;
    case 2:
    case 3: image[at] = static_cast<char>(choices.below(256)); break;
    case 4:
    case 5: put(image, at, &choices.one_of(kWords), 8); break;
    case 6: put(image, at, &choices.one_of(kWords), 4); break;
    case 7: {
      std::uint32_t word = 0;
      std::memcpy(&word, image.data() + at, std::min<std::size_t>(4, image.size() - at));
      word += static_cast<std::uint32_t>(choices.below(5)) - 2U;
      put(image, at, &word, 4);
      break;
    }
    case 8: {  // from the same place or another one of an image of the same program
      const std::size_t from = choices.chance(50) ? at : place_in(choices, other.size());
      const std::string piece = from < other.size() ? other.substr(from, 1 + choices.below(64)) : std::string();
      put(image, at, piece.data(), piece.size());
      break;
    }
    case 9: {  // two pieces change places
      const std::size_t from = kBody + place_in(choices, body), length = 1 + choices.below(40);
      const std::string one = image.substr(at, length), two = image.substr(from, length);
      put(image, at, two.data(), two.size());
      put(image, from, one.data(), one.size());
      break;
    }
    case 10: image.resize(choices.chance(50) ? at : image.size() + choices.below(64)); break;
    default:
      if (choices.chance(50))
        image.erase(at, 1 + choices.below(16));
      else
        image.insert(at, 1 + choices.below(16), static_cast<char>(choices.below(256)));
  }
}

// --- worlds ----------------------------------------------------------------------------------------------------------

std::string image_of(breve_world* world) {
  std::size_t size = 0;
  std::string image;
  if (breve_world_snapshot(world, nullptr, 0, &size) != BREVE_OK) finding(breve_world_last_error(world)->text);
  image.resize(size);
  if (breve_world_snapshot(world, image.data(), size, &size) != BREVE_OK) finding(breve_world_last_error(world)->text);
  return image;
}

std::uint64_t hash_of(breve_world* world) {
  std::uint64_t hash = 0;
  if (breve_world_hash(world, &hash) != BREVE_OK) finding(breve_world_last_error(world)->text);
  return hash;
}

/// A world of a scene, with images of two moments of it. Made once: to compile takes longer than to restore.
struct Scene {
  explicit Scene(std::string_view text) : runtime(make_runtime(breve_runtime_config_default())) {
    breve_program* made = nullptr;
    if (breve_program_compile(runtime.get(), "scene.tz", text.data(), text.size(), &made) != BREVE_OK)
      finding(breve_runtime_last_error(runtime.get())->text, text);
    program.reset(made);
    breve_world_config config = breve_world_config_default();
    config.memory_limit = std::size_t{64} << 20;
    config.budget = 30'000;
    config.call_budget = 3'000;
    config.physics_budget = 100'000;
    config.accuracy = "fast";
    breve_world* created = nullptr;
    if (breve_world_create(runtime.get(), made, &config, &created) != BREVE_OK)
      finding(breve_runtime_last_error(runtime.get())->text, text);
    world.reset(created);
    for (std::string& image : images) {
      for (int i = 0; i < 4; ++i)
        if (breve_world_step(created) != BREVE_OK) finding(breve_world_last_error(created)->text, text);
      image = image_of(created);
    }
  }
  Runtime runtime;
  Program program;
  World world;
  std::array<std::string, 2> images;
};

Scene& scene(std::size_t number) {
  static std::array<std::unique_ptr<Scene>, kImageScenes.size()> scenes;
  if (!scenes[number]) scenes[number] = std::make_unique<Scene>(kImageScenes[number]);
  return *scenes[number];
}

bool allowed_in_a_step(breve_status status) {
  return status == BREVE_OK || status == BREVE_ERROR_SCRIPT || status == BREVE_ERROR_BUDGET ||
         status == BREVE_ERROR_DEPTH || status == BREVE_ERROR_MEMORY;
}

/// What a host asks of a world when it draws it.
void look_at(breve_world* world) {
  breve_object objects[32];
  std::size_t count = 0;
  if (breve_world_objects(world, nullptr, objects, std::size(objects), &count) != BREVE_OK) return;
  for (std::size_t i = 0; i < std::min(count, std::size(objects)); ++i)
    if (!breve_object_class(world, objects[i])) finding("an object of a restored world has no class");
  for (std::size_t i = 0; i < std::min(count, std::size(objects)); ++i) {
    breve_pose pose;
    breve_shape shape;
    double corners[30];
    std::uint32_t sizes[10], indices[10];
    const breve_value value = breve_value_object(objects[i]);
    const char* text = nullptr;
    if (!breve_object_alive(world, objects[i])) continue;  // an end of another took it along
    breve_object_pose(world, objects[i], &pose);
    if (breve_object_shape(world, objects[i], &shape) == BREVE_OK) {
      breve_object_shape_vertices(world, objects[i], corners, 10);
      breve_object_shape_faces(world, objects[i], sizes, 10, indices, 10);
    }
    breve_value_text(world, &value, &text);
    if (i % 5 == 4) breve_object_free(world, objects[i]);
  }
  breve_menu_item items[4];
  breve_world_menu_items(world, items, std::size(items), &count);
}

void go_on(breve_world* world, std::size_t iterations) {
  for (std::size_t i = 0; i < iterations; ++i)
    if (!allowed_in_a_step(breve_world_step(world))) finding(breve_world_last_error(world)->text);
  std::size_t size = 0;
  const breve_status saved = breve_world_snapshot(world, nullptr, 0, &size);
  if (saved != BREVE_OK && saved != BREVE_ERROR_MEMORY) finding(breve_world_last_error(world)->text);
  look_at(world);
}

}  // namespace

void fuzz_image(Bytes bytes) {
  Choices choices(bytes);
  constexpr std::size_t kOfLearners = 213;  // bytes from here on: one in six
  const std::size_t drawn = choices.below(256), others = kImageScenes.size() - 1;
  Scene& at = scene(drawn >= kOfLearners ? others : drawn % others);
  breve_world* world = at.world.get();
  std::string image = choices.one_of(at.images);
  const std::string& other = choices.one_of(at.images);
  const std::size_t iterations = choices.chance(5) ? 100 : 1 + choices.below(5);
  const std::size_t changes = choices.chance(60) ? 1 : 1 + choices.below(6);
  for (std::size_t i = 0; i < changes; ++i) forge(image, other, choices);
  if (choices.chance(95)) seal(image);

  const std::uint64_t before = hash_of(world);
  const breve_status status = breve_world_restore(world, image.data(), image.size());
  if (status == BREVE_OK) {
    go_on(world, iterations);
    if (breve_world_restore(world, at.images[0].data(), at.images[0].size()) != BREVE_OK)
      finding("after a forged image a good one is refused", breve_world_last_error(world)->text);
    return;
  }
  if (status != BREVE_ERROR_IMAGE && status != BREVE_ERROR_MEMORY) finding(breve_world_last_error(world)->text);
  require(hash_of(world) == before, "an image that was refused has changed the world");
}

}  // namespace breve::fuzz

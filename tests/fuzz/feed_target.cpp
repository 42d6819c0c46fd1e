// Inputs from outside: archives, requests, uploads, configurations of Push and sounds, most of them changed in a few
// places. The program takes them or reports an error; the world can then be used, saved and restored like any other.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "breve/sound.h"
#include "choices.hpp"
#include "feed_scene.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace breve::fuzz {

namespace {

/// What the callbacks of the host give.
struct Outside {
  std::string file, method, target, body;
  std::size_t at = 0;  // in the file
  bool waits = false;  // a request
  unsigned answers = 0;
};

// --- files -----------------------------------------------------------------------------------------------------------

bool read_file(void* handle, void* bytes, std::size_t size, std::size_t* got) {
  auto& outside = *static_cast<Outside*>(handle);
  *got = std::min(size, outside.file.size() - outside.at);
  std::copy_n(outside.file.data() + outside.at, *got, static_cast<char*>(bytes));
  outside.at += *got;
  return true;
}

bool open_file(void* user, breve_world*, const char*, breve_file* file, breve_write_fn, void*) {
  static_cast<Outside*>(user)->at = 0;
  file->handle = user;
  file->read = read_file;
  return true;
}

// --- requests --------------------------------------------------------------------------------------------------------

bool next_request(void* handle, breve_request* request) {
  auto& outside = *static_cast<Outside*>(handle);
  if (!outside.waits) return false;
  outside.waits = false;
  *request = {outside.method.c_str(), outside.target.c_str(), "10.0.0.7", outside.body.data(), outside.body.size()};
  return true;
}

void answer_request(void* handle, const breve_response* response) {
  ++static_cast<Outside*>(handle)->answers;
  require(response->status >= 200 && response->status < 600, "an answer has no status of HTTP");
}

bool listen_here(void* user, breve_world*, std::uint32_t, breve_server* server, breve_write_fn, void*) {
  server->handle = user;
  server->next = next_request;
  server->answer = answer_request;
  server->url = "http://here:80";
  return true;
}

// --- the world -------------------------------------------------------------------------------------------------------

breve_status call(breve_world* world, const char* method, const char* keyword, const std::string& text,
                  breve_value* result) {
  const breve_keyword keywords[] = {{keyword, breve_value_string(text.c_str())}};
  return breve_object_call(world, breve_world_controller(world), method, keywords, keyword ? 1 : 0, result);
}

/// The world that is fed, its image before, and documents that it made itself. Made once.
struct Fed {
  Fed() {
    breve_runtime_config settings = breve_runtime_config_default();
    settings.files.user = &outside;
    settings.files.open_for_reading = open_file;
    settings.network.user = &outside;
    settings.network.listen = listen_here;
    runtime = make_runtime(settings);
    breve_program* made = nullptr;
    if (breve_program_compile(runtime.get(), "feed.tz", kFeedScene.data(), kFeedScene.size(), &made) != BREVE_OK)
      finding(breve_runtime_last_error(runtime.get())->text);
    program.reset(made);
    breve_world_config config = breve_world_config_default();
    config.memory_limit = std::size_t{64} << 20;
    config.budget = 300'000;
    config.physics_budget = 200'000;
    config.accuracy = "fast";
    breve_world* created = nullptr;
    if (breve_world_create(runtime.get(), made, &config, &created) != BREVE_OK)
      finding(breve_runtime_last_error(runtime.get())->text);
    world.reset(created);
    if (breve_world_step(created) != BREVE_OK) finding(breve_world_last_error(created)->text);
    image = image_of(created, kFeedScene);
    for (const std::string_view name : kFeedClasses) {
      breve_value archive = breve_value_null();
      if (call(created, "make", "named", std::string(name), &archive) != BREVE_OK)
        finding(breve_world_last_error(created)->text, name);
      require(archive.type == BREVE_TYPE_STRING && archive.as.string.size > 100, "there is no archive", name);
      archives.emplace_back(archive.as.string.bytes, archive.as.string.size);
    }
    for (std::size_t kind = 0; kind < kSoundDocuments; ++kind) sounds.push_back(sound_document(kind));
    restore();
  }
  void restore() {
    if (breve_world_restore(world.get(), image.data(), image.size()) != BREVE_OK)
      finding("the image before is refused", breve_world_last_error(world.get())->text);
  }
  Outside outside;
  Runtime runtime;
  Program program;
  World world;
  std::string image;
  std::vector<std::string> archives, sounds;
};

Fed& fed() {
  static Fed only;
  return only;
}

// --- changes ---------------------------------------------------------------------------------------------------------

std::size_t place_in(Choices& choices, std::size_t size) {
  const std::size_t high = choices.below(256), low = choices.below(256);
  return size == 0 ? 0 : (high << 8 | low) % size;
}

void change(std::string& text, const std::string& other, Choices& choices) {
  const std::size_t at = place_in(choices, text.size());
  switch (choices.below(9)) {
    case 0: text.insert(at, choices.one_of(kWords)); break;
    case 1: text.erase(at, 1 + choices.below(64)); break;
    case 2: text.resize(at); break;
    case 3: text.insert(at, text.substr(place_in(choices, text.size()), 1 + choices.below(256))); break;
    case 4: text.insert(at, other.substr(place_in(choices, other.size()), 1 + choices.below(256))); break;
    case 5: {  // a number becomes another
      const std::size_t begin = text.find_first_of("0123456789", at);
      if (begin == std::string::npos) break;
      const std::size_t end = std::min(text.find_first_not_of("0123456789", begin), text.size());
      text.replace(begin, end - begin, choices.one_of(kWords));
      break;
    }
    case 6: {  // a text in quotes becomes that of another place
      const std::size_t begin = text.find('"', at), from = other.find('"', place_in(choices, other.size()));
      if (begin == std::string::npos || from == std::string::npos) break;
      const std::size_t end = text.find('"', begin + 1), to = other.find('"', from + 1);
      if (end == std::string::npos || to == std::string::npos) break;
      text.replace(begin, end - begin, other.substr(from, to - from));
      break;
    }
    default:
      if (!text.empty()) text[at] = static_cast<char>(choices.below(256));
  }
}

std::string changed(std::string text, const std::string& other, Choices& choices) {
  const std::size_t changes = choices.chance(5) ? 0 : 1 + choices.below(choices.chance(70) ? 2 : 10);
  for (std::size_t i = 0; i < changes; ++i) change(text, other, choices);
  return text;
}

/// A text that a host can pass to a script: without a byte of zero.
std::string without_zeros(std::string text) {
  std::replace(text.begin(), text.end(), '\0', '0');
  return text;
}

template <class Documents>
std::string document(const Documents& all, Choices& choices) {
  const std::string text(choices.one_of(all)), other(choices.one_of(all));
  return changed(text, other, choices);
}

// --- feeding ---------------------------------------------------------------------------------------------------------

bool documented(breve_status status) {
  return status == BREVE_OK || status == BREVE_ERROR_SCRIPT || status == BREVE_ERROR_BUDGET ||
         status == BREVE_ERROR_DEPTH || status == BREVE_ERROR_MEMORY;
}

void check(breve_world* world, breve_status status) {
  if (!documented(status)) finding(breve_world_last_error(world)->text);
}

void feed(Fed& to, Choices& choices) {
  breve_world* world = to.world.get();
  Outside& outside = to.outside;
  switch (choices.below(5)) {
    case 0:
      outside.file = document(to.archives, choices);
      if (choices.chance(30))
        check(world, call(world, "take-archive", "from", without_zeros(outside.file), nullptr));
      else
        check(world, call(world, "take-archive-file", nullptr, "", nullptr));
      break;
    case 1:
      check(world,
            call(world, "take-configuration", "from", without_zeros(document(kConfigurations, choices)), nullptr));
      break;
    case 2:
      outside.file = document(to.sounds, choices);
      check(world, call(world, "take-sound", nullptr, "", nullptr));
      break;
    default: {
      const bool upload = choices.chance(50);
      outside.method = upload ? "POST" : "GET";
      outside.target = upload ? "/" : without_zeros(document(kTargets, choices));
      outside.body = upload ? document(to.archives, choices) : "";
      outside.waits = true;
      outside.answers = 0;
      check(world, breve_world_step(world));
      require(outside.waits || outside.answers == 1, "a request that was taken has not one answer", outside.target);
      outside.waits = false;
    }
  }
}

}  // namespace

void fuzz_feed(Bytes bytes) {
  Choices choices(bytes);
  Fed& to = fed();
  breve_world* world = to.world.get();
  feed(to, choices);
  check(world, breve_world_step(world));
  std::array<float, 256> frames{};
  check(world, breve_world_sound(world, 0.1, 44100, frames.data(), frames.size() / 2));
  for (const float sample : frames) require(sample >= -1 && sample <= 1, "a sample is not from -1 to 1");
  image_of(world, kFeedScene);
  to.restore();
}

}  // namespace breve::fuzz

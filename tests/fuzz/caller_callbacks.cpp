// The callbacks of a host that calls back: each may call any function, and its answers are drawn like arguments.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "call_functions.hpp"

namespace breve::fuzz {

namespace caller_callbacks {

constexpr std::string_view kModule =
    "@path \"inner\".\nObject : Guest (aka Guests) {\n  + to greet: print \"hi\".\n}\n";
constexpr std::string_view kBroken = "Object : Broken { + to";
constexpr std::string_view kFile = "1 2 3\nv 0 0 0\nf 1 2 3\n";

/// An open file: text to be read, or a place that takes what is written.
struct OpenFile {
  std::size_t* open;
  std::string_view rest;
  bool fails;
};

bool read(void* handle, void* bytes, std::size_t size, std::size_t* got) {
  auto& file = *static_cast<OpenFile*>(handle);
  *got = std::min(size, file.rest.size());
  std::memcpy(bytes, file.rest.data(), *got);
  file.rest.remove_prefix(*got);
  return !file.fails;
}

bool write(void* handle, const void* bytes, std::size_t size) {
  const std::string copy(static_cast<const char*>(bytes), size);
  return copy.size() == size && !static_cast<OpenFile*>(handle)->fails;
}

bool close(void* handle, bool keep) {
  const std::unique_ptr<OpenFile> file(static_cast<OpenFile*>(handle));
  --*file->open;
  return keep;
}

}  // namespace caller_callbacks

/// What a breve_runtime_config points to. The user is a Ledger.
struct Callbacks {
  using Ledger = Caller::Ledger;
  static Ledger& ledger(void* user) { return *static_cast<Ledger*>(user); }
  static Caller& caller(void* user) { return *ledger(user).caller; }

  static void* allocate(void* user, std::size_t size, std::size_t alignment) {
    std::size_t& left = caller(user).allocations_until_failure_;
    if (left != 0 && --left == 0) return nullptr;
    if (size > std::size_t{1} << 30) return nullptr;
    void* memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (memory) ledger(user).bytes += size;
    return memory;
  }
  static void release(void* user, void* memory, std::size_t size, std::size_t) {
    ledger(user).bytes -= size;
    std::free(memory);
  }
  static void print(void* user, breve_world* world, breve_channel channel, const char* text, std::size_t size) {
    require(channel >= BREVE_CHANNEL_PRINT && channel <= BREVE_CHANNEL_ERROR, "a channel that there is none of");
    require(text[size] == 0, "a text has no end");
    caller(user).call_back(world);
    require(text[size] == 0, "a text is gone after calls by its reader");
  }
  static bool resolve(void* user, const char* name, const char* from, breve_module* module) {
    read_text(from);
    caller(user).call_back(nullptr);
    const std::string_view asked(name);
    std::string_view text;
    if (asked == "Chatter.tz")
      text = call_programs().front();
    else if (asked == "Guest.tz")
      text = caller_callbacks::kModule;
    else if (asked == "Broken.tz")
      text = caller_callbacks::kBroken;
    else if (asked != "Empty.tz")
      return false;
    module->text = text.data();
    module->size = text.size();
    ++ledger(user).modules;
    module->cookie = user;
    return true;
  }
  static void release_module(void* user, const breve_module* module) {
    require(module->cookie == user, "a module comes back with another cookie");
    --ledger(user).modules;
    caller(user).call_back(nullptr);
  }
  static void add_path(void* user, const char* directory) {
    read_text(directory);
    caller(user).call_back(nullptr);
  }
  static bool open(void* user, breve_world* world, breve_file* file, breve_write_fn reason, void* sink) {
    Caller& host = caller(user);
    host.call_back(world);
    const std::size_t answer = host.choices_.below(4);
    if (answer == 0) reason(sink, "not today", 9);
    if (answer <= 1) return false;
    ++ledger(user).files;
    file->handle =
        new caller_callbacks::OpenFile{&ledger(user).files, caller_callbacks::kFile, host.choices_.chance(20)};
    file->read = caller_callbacks::read;
    file->write = caller_callbacks::write;
    file->close = caller_callbacks::close;
    file->path = answer == 2 ? "/there/file" : nullptr;
    return true;
  }
  static bool open_for_reading(void* user, breve_world* world, const char* name, breve_file* file,
                               breve_write_fn reason, void* sink) {
    read_text(name);
    return open(user, world, file, reason, sink);
  }
  static bool open_for_writing(void* user, breve_world* world, const char* name, bool, breve_file* file,
                               breve_write_fn reason, void* sink) {
    read_text(name);
    return open(user, world, file, reason, sink);
  }
  static void retain(void* user) { ++ledger(user).retained; }
  static void release_files(void* user) { --ledger(user).retained; }
  static bool system(void* user, breve_world* world, const char* command, breve_write_fn write, void* sink) {
    read_text(command);
    caller(user).call_back(world);
    write(sink, "said", 4);
    write(sink, nullptr, 0);
    return caller(user).choices_.chance(80);
  }
  /// A plugin that adds a function, calls back, or is refused.
  static bool open_plugin(void* user, const char* file, const char* entry, const char* from, breve_plugin* plugin,
                          breve_write_fn reason, void* sink) {
    for (const char* text : {file, entry, from}) read_text(text);
    Caller& host = caller(user);
    host.call_back(nullptr);
    const std::size_t answer = host.choices_.below(4);
    if (answer == 0) reason(sink, "it is not trusted", 17);
    if (answer <= 1) return false;
    plugin->entry = answer == 2 ? plugin_entry : nullptr;
    if (!plugin->entry) plugin->entry = [](breve_runtime*, std::uint32_t) { return BREVE_ERROR_UNSUPPORTED; };
    plugin->library = user;
    ++ledger(user).plugins;
    plugin->close = [](void* library) { --ledger(library).plugins; };
    return true;
  }
  static breve_status plugin_entry(breve_runtime* runtime, std::uint32_t abi) {
    require(abi == BREVE_ABI, "a plugin is started for another interface");
    breve_function f = breve_function_default();
    f.name = "pluggedIn";
    f.call = [](void*, const breve_call*, breve_value* result) {
      *result = breve_value_int(1);
      return BREVE_OK;
    };
    // What a plugin may not do is refused, and does no harm.
    breve_program* program = nullptr;
    require(breve_program_create_library(runtime, nullptr, &program) != BREVE_OK, "a plugin compiles a program");
    return breve_runtime_add_function(runtime, &f);
  }
  // The functions of the listener. Their user is the Caller.
  static void call_from_event(void* user, breve_world* world) {
    auto& host = *static_cast<Caller*>(user);
    require(breve_world_step(world) == BREVE_ERROR_BUSY, "an event is reported outside of an iteration");
    if (host.choices_.chance(20)) host.call_back(world);
  }
  static void contact(void* user, breve_world* world, const breve_contact* contact) {
    require(contact->phase <= BREVE_PHASE_END, "a contact has no phase");
    call_from_event(user, world);
  }
  static void life(void* user, breve_world* world, const breve_life* life) {
    call_from_event(user, world);
    read_text(life->class_name);
  }
  static void announcement(void* user, breve_world* world, const breve_announcement* announcement) {
    call_from_event(user, world);
    read_text(announcement->message);
  }
  static void nap(void* user, breve_world* world, const breve_nap* nap) {
    require(nap->object.generation != 0, "nobody falls asleep");
    call_from_event(user, world);
  }
  static void intervention(void* user, breve_world* world, const breve_intervention* intervention) {
    call_from_event(user, world);
    read_text(intervention->reason);
  }
  static void trace(void* user, const breve_trace_event* event) {
    for (const char* text : {event->class_name, event->name, event->file}) read_text(text);
    if (static_cast<Caller*>(user)->choices_.chance(3)) static_cast<Caller*>(user)->call_back(nullptr);
  }
};

breve_runtime_config Caller::runtime_config() {
  Ledger& ledger = ledgers_.emplace_back();
  ledger.caller = this;
  breve_runtime_config config = breve_runtime_config_default();
  config.user = &ledger;
  config.allocate = Callbacks::allocate;
  config.release = Callbacks::release;
  config.print = Callbacks::print;
  config.resolve_module = Callbacks::resolve;
  config.release_module = Callbacks::release_module;
  config.add_path = Callbacks::add_path;
  config.files = {&ledger, Callbacks::open_for_reading, Callbacks::open_for_writing, Callbacks::retain,
                  Callbacks::release_files};
  config.system = Callbacks::system;
  config.open_plugin = Callbacks::open_plugin;
  return config;
}

breve_trace_fn Caller::trace() { return Callbacks::trace; }

breve_listener Caller::listener() {
  breve_listener listener = breve_listener_default();
  listener.user = this;
  listener.contact = Callbacks::contact;
  listener.life = Callbacks::life;
  listener.announcement = Callbacks::announcement;
  listener.nap = Callbacks::nap;
  listener.intervention = Callbacks::intervention;
  return listener;
}

}  // namespace breve::fuzz

// Plugins: asks the host for those that programs name, runs their entries, and opens shared libraries.
#if !defined(_WIN32)
#include <dlfcn.h>
#endif

#include "modules.hpp"

namespace breve::host {

namespace {

/// The entry of a plugin runs while this stands.
class LoadingScope {
 public:
  LoadingScope(breve_runtime& runtime, Plugin& plugin) : runtime_(runtime) { runtime.loading = &plugin; }
  ~LoadingScope() { runtime_.loading = nullptr; }
  LoadingScope(const LoadingScope&) = delete;
  LoadingScope& operator=(const LoadingScope&) = delete;

 private:
  breve_runtime& runtime_;
};

/// What the entry says about its failure: the text of the call that failed in it.
std::string fault_of(const breve_runtime& runtime, const Plugin& plugin, breve_status status, std::uint64_t errors) {
  const std::string entry = "its entry '" + plugin.entry + "' ";
  if (status == BREVE_ERROR_UNSUPPORTED && runtime.error.count() == errors)
    return entry + "was compiled for another version of breve.h (this one has BREVE_ABI " + std::to_string(BREVE_ABI) +
           ")";
  const breve_error* error = runtime.error.view();
  if (runtime.error.count() != errors && error && error->status == static_cast<std::uint32_t>(status))
    return entry + "failed: " + error->message;
  return entry + "failed with " + breve_status_name(status);
}

/// @return  why the plugin adds nothing; "" if it does
std::string run_entry(breve_runtime& runtime, Plugin& plugin) {
  const std::uint64_t errors = runtime.error.count();
  const LoadingScope loading(runtime, plugin);
  const breve_status status = plugin.library->opened.entry(&runtime, BREVE_ABI);
  if (status == BREVE_ERROR_MEMORY) throw std::bad_alloc();
  return status == BREVE_OK ? std::string() : fault_of(runtime, plugin, status, errors);
}

}  // namespace

steve::PluginParts HostModules::load_plugin(const std::string& file, const std::string& entry,
                                            const std::string& from) {
  if (!config_.open_plugin) return ModuleResolver::load_plugin(file, entry, from);
  for (const Plugin& plugin : runtime_.plugins)
    if (plugin.file == file && plugin.entry == entry) return {plugin.functions, plugin.classes, {}, {}};
  breve_plugin opened{};
  Answer reason;
  if (!config_.open_plugin(config_.user, file.c_str(), entry.c_str(), from.c_str(), &opened, &Answer::add, &reason)) {
    const std::string why = without_zeros(reason.text());
    return {{}, {}, why.empty() ? "the host does not open it" : why, {}};
  }
  Plugin plugin{file, entry, std::make_shared<const PluginLibrary>(opened), {}, {}};
  if (!opened.entry) return {{}, {}, "the host gave no entry", {}};
  std::string fault = run_entry(runtime_, plugin);
  if (!fault.empty()) return {{}, {}, without_zeros(std::move(fault)), {}};
  runtime_.state->libraries.push_back(plugin.library);
  runtime_.plugins.push_back(plugin);
  return {plugin.functions, plugin.classes, {}, {}};
}

namespace {

#if defined(_WIN32)
[[noreturn]] void open_library(const char*, const char*, breve_plugin&) {
  fail(BREVE_ERROR_UNSUPPORTED, "this build cannot load libraries");
}
#else
void open_library(const char* path, const char* entry, breve_plugin& plugin) {
  void* const library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* const why = dlerror();
    fail(BREVE_ERROR_FILE, why ? why : "the system does not say why");
  }
  void* const symbol = dlsym(library, entry);
  if (!symbol) {
    dlclose(library);
    fail(BREVE_ERROR_NOT_FOUND, "'" + std::string(path) + "' has no entry '" + entry + "'");
  }
  plugin.entry = reinterpret_cast<breve_plugin_fn>(symbol);
  plugin.library = library;
  plugin.close = [](void* opened) { dlclose(opened); };
}
#endif

}  // namespace
}  // namespace breve::host

using namespace breve::host;

breve_status breve_plugin_open(const char* path, const char* entry, breve_plugin* plugin, breve_write_fn reason,
                               void* sink) {
  ErrorRecord error;
  const breve_status status = guard(error, [&] {
    need(path, "path");
    need(entry, "entry");
    need(plugin, "plugin");
    breve_plugin opened{};
    open_library(path, entry, opened);
    *plugin = opened;
  });
  if (const breve_error* view = error.view(); reason && view)
    reason(sink, view->message, std::char_traits<char>::length(view->message));
  return status;
}

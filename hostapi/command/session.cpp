// The callbacks of the command's runtime.
#include "session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "lua_file.hpp"
#include "plugin_access.hpp"

namespace breve::command {

namespace {

struct ClosePipe {
  void operator()(std::FILE* pipe) const { pclose(pipe); }
};

bool run_command(const char* command, breve_write_fn write, void* sink) {
  const std::unique_ptr<std::FILE, ClosePipe> pipe(popen(command, "r"));
  if (!pipe) return false;
  std::array<char, 4096> chunk;
  while (const std::size_t size = std::fread(chunk.data(), 1, chunk.size(), pipe.get()))
    write(sink, chunk.data(), size);
  return true;
}

/// What could have been meant by a name: the programs in the folder it points to.
std::string programs_beside(const std::string& file) {
  constexpr std::size_t kMost = 5;
  std::vector<std::string> names;
  std::error_code problem;
  const auto folder = std::filesystem::path(file).parent_path();
  for (std::filesystem::directory_iterator it(folder.empty() ? "." : folder, problem), end; !problem && it != end;
       it.increment(problem))
    if (it->path().extension() == ".tz" || it->path().extension() == ".lua")
      names.push_back(it->path().filename().string());
  if (names.empty()) return {};
  std::sort(names.begin(), names.end());
  const bool more = names.size() > kMost;
  names.resize(std::min(names.size(), kMost));
  return fmt::format("; there are {}{}", fmt::join(names, ", "), more ? ", ..." : "");
}

/// Make a warning an error. @return  its text as one
std::string as_error(breve_diagnostic& d) {
  constexpr std::string_view kWarning = "warning: ";
  std::string text = d.text;
  if (const auto at = text.find(kWarning); at != std::string::npos) text.replace(at, kWarning.size(), "error: ");
  d.severity = BREVE_SEVERITY_ERROR;
  return text;
}

}  // namespace

void Session::print(void* user, breve_world*, breve_channel channel, const char* text, std::size_t size) {
  auto& session = *static_cast<Session*>(user);
  switch (channel) {
    case BREVE_CHANNEL_PRINT: session.output_.print({text, size}); break;
    case BREVE_CHANNEL_WARNING:
      if (!session.quiet_) session.output_.complain({text, size});
      break;
    case BREVE_CHANNEL_ERROR: session.output_.complain({text, size}); break;
  }
}

/// The network on this machine, or on the address that was given.
void Session::allow_network(const AccessOptions& access, breve_runtime_config& config) {
  breve_network_config network = breve_network_config_default();
  if (!access.network_address.empty()) {
    network.address = access.network_address.c_str();
    network.remote = true;
  }
  const breve_status status = breve_network_open(&network, &config.network);
  if (status == BREVE_ERROR_UNSUPPORTED) throw std::runtime_error("--allow-network: this build has no network");
  if (status != BREVE_OK)
    throw std::runtime_error(
        fmt::format("--network-address: '{}' is not a numeric address such as 0.0.0.0", access.network_address));
}

/// Where a program's files are looked for: the current directory, which may be written, and where its modules are.
void Session::allow_files(const AccessOptions& access) {
  no_files_ = access.no_files;
  if (no_files_) return;
  access_.add(".", true);
  for (const auto& directory : access.write) access_.add(directory, true);
  for (const auto& directory : access.read) access_.add(directory, false);
  for (const char* launch : {"lib/classes", "lib"}) access_.add_if_there(launch);
  for (const auto& directory : paths_) access_.add_if_there(directory);
  for (const auto& directory : class_path()) access_.add_if_there(directory);
}

Session::Session(Output& output, const std::vector<std::string>& paths, bool quiet, bool strict,
                 const AccessOptions* access, const std::vector<std::string>& plugins)
    : output_(output), paths_(paths), loader_(paths), quiet_(quiet), strict_(strict), plugins_(plugins) {
  breve_runtime_config config = breve_runtime_config_default();
  config.user = this;
  config.print = &Session::print;
  config.resolve_module = [](void* user, const char* name, const char* from, breve_module* module) {
    return static_cast<Session*>(user)->loader_.resolve(name, from, *module);
  };
  config.add_path = [](void* user, const char* directory) {
    auto& session = *static_cast<Session*>(user);
    session.loader_.add_path(directory);
    if (!session.no_files_) session.access_.add_below(directory);
  };
  if (access) plugins_ = access->plugins;
  if (!plugins_.empty())
    config.open_plugin = [](void* user, const char* file, const char* entry, const char*, breve_plugin* plugin,
                            breve_write_fn reason, void* sink) {
      return open_plugin_below(static_cast<Session*>(user)->plugins_, file, entry, plugin, reason, sink);
    };
  if (access) {
    allow_files(*access);
    if (!no_files_) config.files = access_.files();
    config.rights = BREVE_RIGHT_SLEEP | BREVE_RIGHT_REAL_TIME | BREVE_RIGHT_ENTROPY;
  }
  if (access && access->system)
    config.system = [](void* user, breve_world*, const char* command, breve_write_fn write, void* sink) {
      static_cast<Session*>(user)->output_.flush();  // what the program printed comes before what the command prints
      return run_command(command, write, sink);
    };
  if (access && access->network) allow_network(*access, config);
  const breve_status status = breve_runtime_create(&config, &runtime_);
  breve_network_release(&config.network);  // the runtime keeps it
  if (status != BREVE_OK) throw std::runtime_error("cannot make a runtime");
}

Session::~Session() { breve_runtime_destroy(runtime_); }

bool Session::show_diagnostics() {
  bool fine = true;
  for (std::size_t i = 0; i < breve_runtime_diagnostic_count(runtime_); ++i) {
    breve_diagnostic d;
    if (breve_runtime_diagnostic(runtime_, i, &d) != BREVE_OK) continue;
    std::string text;
    if (strict_ && d.severity == BREVE_SEVERITY_WARNING) {
      text = as_error(d);
      d.text = text.c_str();
      fine = false;
    }
    if (listener_) {
      listener_(d);
    } else if (d.severity == BREVE_SEVERITY_ERROR || (d.severity == BREVE_SEVERITY_WARNING && !quiet_)) {
      output_.complain(d.text);
    }
  }
  return fine;
}

bool Session::allow(const std::string& code) { return breve_runtime_allow_lint(runtime_, code.c_str()) == BREVE_OK; }

ExitStatus Session::load(const std::string& file, ProgramHandle& program) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    output_.complain(fmt::format("breve: there is no file '{}'{}\n", file, programs_beside(file)));
    return kWrongUsage;
  }
  const LoadedFile* main = loader_.open(file);
  if (!main) {
    output_.complain(fmt::format("breve: {}\n", loader_.complaint()));
    return kWrongUsage;
  }
  if (!no_files_) access_.add_if_there(std::filesystem::path(file).parent_path());
  breve_program* compiled = nullptr;
  const breve_status status =
      file.ends_with(".lua")
          ? compile_lua(runtime_, loader_, *main, output_, compiled)
          : breve_program_compile(runtime_, main->name.c_str(), main->text.data(), main->text.size(), &compiled);
  files_ = loader_.files();
  return finish(status, compiled, program);
}

ExitStatus Session::load_again(const std::string& file, ProgramHandle& program) {
  ModuleLoader before(paths_);
  std::swap(before, loader_);
  const ExitStatus status = load(file, program);
  if (status != kEndedWell) std::swap(before, loader_);
  return status;
}

ExitStatus Session::compile(const std::string& name, const std::string& text, ProgramHandle& program) {
  breve_program* compiled = nullptr;
  const breve_status status = breve_program_compile(runtime_, name.c_str(), text.data(), text.size(), &compiled);
  return finish(status, compiled, program);
}

ExitStatus Session::finish(breve_status status, breve_program* compiled, ProgramHandle& program) {
  const bool fine = show_diagnostics();
  if (!loader_.complaint().empty()) output_.complain(fmt::format("breve: {}\n", loader_.complaint()));
  if (status == BREVE_OK) {
    program.reset(compiled);
    if (fine) return kEndedWell;
    program.reset();
    return kFailed;
  }
  // The diagnostics have said it all, unless there is none.
  const breve_error* error = breve_runtime_last_error(runtime_);
  if (status != BREVE_ERROR_COMPILE && error) output_.complain(error->text);
  return kFailed;
}

}  // namespace breve::command

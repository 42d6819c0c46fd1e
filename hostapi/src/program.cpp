// Compilation: modules come from the host, diagnostics go to the runtime.
#include "internal.hpp"

namespace breve::host {
namespace {

/// The host's module callbacks as the compiler sees them.
class HostModules final : public steve::ModuleResolver {
 public:
  explicit HostModules(const breve_runtime_config& config) : config_(config) {}

  std::optional<steve::ModuleSource> resolve(std::string_view name, std::string_view from) override {
    if (!config_.resolve_module) return std::nullopt;
    const std::string asked(name), asker(from);
    breve_module module{};
    if (!config_.resolve_module(config_.user, asked.c_str(), asker.c_str(), &module)) return std::nullopt;
    const Release release{config_, module};
    if (!module.text && module.size != 0)
      fail(BREVE_ERROR_ARGUMENT, "resolve_module gave module '" + asked + "' a size but no text");
    return steve::ModuleSource{module.name ? module.name : asked,
                               std::string(module.text ? module.text : "", module.size)};
  }

  void add_path(std::string_view directory) override {
    if (config_.add_path) config_.add_path(config_.user, std::string(directory).c_str());
  }

 private:
  struct Release {
    const breve_runtime_config& config;
    const breve_module& module;
    ~Release() {
      if (config.release_module) config.release_module(config.user, &module);
    }
  };
  const breve_runtime_config& config_;
};

breve_severity severity_of(steve::Severity severity) {
  switch (severity) {
    case steve::Severity::Error: return BREVE_SEVERITY_ERROR;
    case steve::Severity::Warning: return BREVE_SEVERITY_WARNING;
    case steve::Severity::Note: return BREVE_SEVERITY_NOTE;
  }
  return BREVE_SEVERITY_ERROR;
}

DiagnosticText text_of(const steve::Diagnostic& d, const steve::Sources& sources) {
  DiagnosticText t{severity_of(d.severity), d.code, d.message, d.help, {}, steve::format(d, sources), 0, 0, 0};
  if (t.text.empty() || t.text.back() != '\n') t.text += '\n';
  if (d.span.line == 0 || d.span.file >= sources.size()) return t;
  t.file = sources.file(d.span.file).name;
  t.line = d.span.line;
  t.column = d.span.column;
  t.length = d.span.length;
  return t;
}

class BusyScope {
 public:
  explicit BusyScope(breve_runtime& runtime) : runtime_(runtime) { ++runtime_.busy; }
  ~BusyScope() { --runtime_.busy; }
  BusyScope(const BusyScope&) = delete;
  BusyScope& operator=(const BusyScope&) = delete;

 private:
  breve_runtime& runtime_;
};

std::unique_ptr<breve_program> compile_module(breve_runtime& runtime, steve::ModuleSource main, HostModules& modules) {
  auto result = steve::compile(std::move(main), modules);
  // A program owns its sources; without one the result does.
  const steve::Sources& sources = result.program ? result.program->sources() : result.sources;
  for (const auto& d : result.diagnostics.all()) runtime.diagnostics.push_back(text_of(d, sources));
  if (!result.program) {
    const auto errors = result.diagnostics.error_count();
    std::string message =
        "the program does not compile: " + std::to_string(errors) + (errors == 1 ? " error" : " errors");
    for (const auto& d : runtime.diagnostics)
      if (d.severity == BREVE_SEVERITY_ERROR) {
        message += "\n" + d.text;
        if (message.back() == '\n') message.pop_back();
        break;
      }
    fail(BREVE_ERROR_COMPILE, message);
  }
  auto handle = std::make_unique<breve_program>();
  handle->program = std::move(result.program);
  return handle;
}

void need_free(const breve_runtime& runtime) {
  if (runtime.busy != 0) fail(BREVE_ERROR_BUSY, "the runtime is compiling or making a world already");
}

}  // namespace
}  // namespace breve::host

using namespace breve::host;

breve_status breve_program_load(breve_runtime* runtime, const char* name, breve_program** program) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(name, "name");
    need(program, "program");
    need_free(*runtime);
    const BusyScope busy(*runtime);
    runtime->diagnostics.clear();
    HostModules modules(runtime->state->config);
    auto main = modules.resolve(name, "");
    if (!main)
      fail(BREVE_ERROR_FILE, runtime->state->config.resolve_module
                                 ? "cannot find or read '" + std::string(name) + "'"
                                 : "cannot load '" + std::string(name) + "': the runtime has no resolve_module");
    *program = compile_module(*runtime, std::move(*main), modules).release();
  });
}

breve_status breve_program_compile(breve_runtime* runtime, const char* name, const char* text, size_t size,
                                   breve_program** program) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(name, "name");
    need(program, "program");
    if (size != 0) need(text, "text");
    need_free(*runtime);
    const BusyScope busy(*runtime);
    runtime->diagnostics.clear();
    HostModules modules(runtime->state->config);
    *program = compile_module(*runtime, {name, std::string(text ? text : "", size)}, modules).release();
  });
}

void breve_program_destroy(breve_program* program) { delete program; }

size_t breve_runtime_diagnostic_count(const breve_runtime* runtime) {
  return runtime ? runtime->diagnostics.size() : 0;
}

breve_status breve_runtime_diagnostic(const breve_runtime* runtime, size_t index, breve_diagnostic* diagnostic) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(diagnostic, "diagnostic");
    if (index >= runtime->diagnostics.size()) fail(BREVE_ERROR_NOT_FOUND, "there is no such diagnostic");
    const auto& d = runtime->diagnostics[index];
    *diagnostic = {d.severity, d.code.c_str(), d.message.c_str(), d.help.c_str(), d.file.c_str(),
                   d.line,     d.column,       d.length,          d.text.c_str()};
  });
}

size_t breve_program_class_count(const breve_program* program) {
  return program ? program->program->classes().size() : 0;
}

breve_status breve_program_class(const breve_program* program, size_t index, breve_class_info* info) {
  return guard([&] {
    need(program, "program");
    need(info, "info");
    const auto& classes = program->program->classes();
    if (index >= classes.size()) fail(BREVE_ERROR_NOT_FOUND, "there is no such class");
    const auto& c = *classes[index];
    *info = {c.name.c_str(), c.alias.c_str(), c.parent ? c.parent->name.c_str() : ""};
  });
}

// Modules from the host's callbacks, and the compiler's diagnostics as the host reads them.
#include "modules.hpp"

namespace breve::host {

namespace {

struct Release {
  const breve_runtime_config& config;
  const breve_module& module;
  ~Release() {
    if (config.release_module) config.release_module(config.user, &module);
  }
};

breve_severity severity_of(steve::Severity severity) {
  switch (severity) {
    case steve::Severity::Error: return BREVE_SEVERITY_ERROR;
    case steve::Severity::Warning: return BREVE_SEVERITY_WARNING;
    case steve::Severity::Note: return BREVE_SEVERITY_NOTE;
  }
  return BREVE_SEVERITY_ERROR;
}

}  // namespace

std::optional<steve::ModuleSource> HostModules::resolve(std::string_view name, std::string_view from) {
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

void HostModules::add_path(std::string_view directory) {
  if (config_.add_path) config_.add_path(config_.user, std::string(directory).c_str());
}

steve::ModuleSource main_module(const breve_runtime& runtime, HostModules& modules, const char* name) {
  auto main = modules.resolve(name, "");
  if (!main)
    fail(BREVE_ERROR_FILE, runtime.state->config.resolve_module
                               ? "cannot find or read '" + std::string(name) + "'"
                               : "cannot load '" + std::string(name) + "': the runtime has no resolve_module");
  return std::move(*main);
}

DiagnosticText text_of(const steve::Diagnostic& d, const steve::Sources& sources) {
  DiagnosticText t{severity_of(d.severity),
                   d.code,
                   without_zeros(d.message),
                   without_zeros(d.help),
                   {},
                   without_zeros(steve::format(d, sources)),
                   0,
                   0,
                   0};
  if (t.text.empty() || t.text.back() != '\n') t.text += '\n';
  if (d.span.line == 0 || d.span.file >= sources.size()) return t;
  t.file = without_zeros(sources.file(d.span.file).name);
  t.line = d.span.line;
  t.column = d.span.column;
  t.length = d.span.length;
  return t;
}

breve_diagnostic view_of(const DiagnosticText& d) {
  return {d.severity, d.code.c_str(), d.message.c_str(), d.help.c_str(), d.file.c_str(),
          d.line,     d.column,       d.length,          d.text.c_str()};
}

BusyScope::BusyScope(breve_runtime& runtime) : runtime_(runtime) {
  if (runtime.busy != 0) fail(BREVE_ERROR_BUSY, "the runtime is compiling or making a world already");
  ++runtime_.busy;
}

}  // namespace breve::host

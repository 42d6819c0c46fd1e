// What compiling and looking at programs share: modules come from the host, diagnostics become texts.
#pragma once

#include <optional>
#include <string_view>

#include "internal.hpp"

namespace breve::host {

/// The host's module callbacks as the compiler sees them.
class HostModules final : public steve::ModuleResolver {
 public:
  explicit HostModules(breve_runtime& runtime) : runtime_(runtime), config_(runtime.state->config) {}
  std::optional<steve::ModuleSource> resolve(std::string_view name, std::string_view from) override;
  void add_path(std::string_view directory) override;
  steve::PluginParts load_plugin(const std::string& file, const std::string& entry, const std::string& from) override;

 private:
  breve_runtime& runtime_;
  const breve_runtime_config& config_;
};

/// The main module that a host names. BREVE_ERROR_FILE if there is none.
steve::ModuleSource main_module(const breve_runtime& runtime, HostModules& modules, const char* name);

DiagnosticText text_of(const steve::Diagnostic& diagnostic, const steve::Sources& sources);
breve_diagnostic view_of(const DiagnosticText& text);

/// The runtime compiles or makes a world as long as this stands. BREVE_ERROR_BUSY if it does so already.
class BusyScope {
 public:
  explicit BusyScope(breve_runtime& runtime);
  ~BusyScope() { --runtime_.busy; }
  BusyScope(const BusyScope&) = delete;
  BusyScope& operator=(const BusyScope&) = delete;

 private:
  breve_runtime& runtime_;
};

/// Functions or classes are added: by a host while nothing is compiled, or by the entry of a plugin.
class AddingScope {
 public:
  explicit AddingScope(breve_runtime& runtime) {
    if (!runtime.loading) busy_.emplace(runtime);
  }

 private:
  std::optional<BusyScope> busy_;
};

}  // namespace breve::host

// Compilation: programs for the host, diagnostics for its runtime.
#include "modules.hpp"
#include "steve/library/library.hpp"

namespace breve::host {
namespace {

/// The errors in classes of the host, and the first one of the program. A class of the host that is wrong causes errors
/// where it is used, and those stand in files that were loaded before.
std::string cause(const std::vector<DiagnosticText>& diagnostics) {
  std::string of_host, first;
  for (const auto& d : diagnostics) {
    if (d.severity != BREVE_SEVERITY_ERROR) continue;
    const bool in_host = d.file.rfind("host:", 0) == 0;
    std::string& text = in_host ? of_host : first;
    if (in_host || first.empty()) text += "\n" + d.text.substr(0, d.text.find_last_not_of('\n') + 1);
  }
  return of_host + first;
}

std::unique_ptr<breve_program> compile_module(breve_runtime& runtime, steve::ModuleSource main, HostModules& modules) {
  auto result = steve::compile(std::move(main), modules, steve::library_source(), runtime.allowed, runtime.functions,
                               runtime.classes);
  // A program owns its sources; without one the result does.
  const steve::Sources& sources = result.program ? result.program->sources() : result.sources;
  for (const auto& d : result.diagnostics.all()) runtime.diagnostics.push_back(text_of(d, sources));
  if (!result.program) {
    const auto errors = result.diagnostics.error_count();
    fail(BREVE_ERROR_COMPILE, "the program does not compile: " + std::to_string(errors) +
                                  (errors == 1 ? " error" : " errors") + cause(runtime.diagnostics));
  }
  auto handle = std::make_unique<breve_program>();
  handle->program = std::move(result.program);
  return handle;
}

}  // namespace
}  // namespace breve::host

using namespace breve::host;

breve_status breve_program_load(breve_runtime* runtime, const char* name, breve_program** program) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(name, "name");
    need(program, "program");
    const BusyScope busy(*runtime);
    runtime->diagnostics.clear();
    HostModules modules(*runtime);
    *program = compile_module(*runtime, main_module(*runtime, modules, name), modules).release();
  });
}

breve_status breve_program_compile(breve_runtime* runtime, const char* name, const char* text, size_t size,
                                   breve_program** program) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(name, "name");
    need(program, "program");
    if (size != 0) need(text, "text");
    const BusyScope busy(*runtime);
    runtime->diagnostics.clear();
    HostModules modules(*runtime);
    *program = compile_module(*runtime, {name, std::string(text ? text : "", size)}, modules).release();
  });
}

breve_status breve_program_create_library(breve_runtime* runtime, const char* controller, breve_program** program) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(program, "program");
    const BusyScope busy(*runtime);
    runtime->diagnostics.clear();
    std::string text;
    for (const auto& file : breve::steve::library_files())
      text += "@use " + std::string(file.name.substr(0, file.name.size() - 3)) + ".\n";
    text += "Controller " + std::string(controller ? controller : "PhysicalControl") + ".\n";
    HostModules modules(*runtime);
    *program = compile_module(*runtime, {"library", std::move(text)}, modules).release();
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
    *diagnostic = view_of(runtime->diagnostics[index]);
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

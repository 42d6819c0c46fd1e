// Programs that are files in Lua, where the command is built with it.
#include "lua_file.hpp"

#include <fmt/format.h>

#include <string>

#ifdef BREVE_WITH_LUA
#include "breve/breve_lua.h"
#endif

namespace breve::command {

#ifdef BREVE_WITH_LUA

breve_status compile_lua(breve_runtime* runtime, ModuleLoader& loader, const LoadedFile& file, Output& output,
                         breve_program*& program) {
  breve_lua_config config = breve_lua_config_default();
  config.user = &loader;
  config.resolve_module = [](void* user, const char* name, const char* from, breve_module* module) {
    return static_cast<ModuleLoader*>(user)->resolve(name, from, *module);
  };
  std::string why;
  const auto note = [](void* sink, const char* text, std::size_t size) {
    static_cast<std::string*>(sink)->append(text, size);
  };
  const breve_status status =
      breve_lua_compile(runtime, &config, file.name.c_str(), file.text.data(), file.text.size(), note, &why, &program);
  const bool told = breve_runtime_diagnostic_count(runtime) != 0;
  if (status == BREVE_ERROR_COMPILE && !told) output.complain(fmt::format("error: {}\n", why));
  return status;
}

#else

breve_status compile_lua(breve_runtime*, ModuleLoader&, const LoadedFile& file, Output& output, breve_program*&) {
  output.complain(fmt::format("breve: '{}' is a file in Lua, and this command was built without it\n", file.name));
  return BREVE_ERROR_COMPILE;
}

#endif

}  // namespace breve::command

// Programs that are files in Lua.
#pragma once

#include "breve/breve.h"
#include "module_loader.hpp"
#include "output.hpp"

namespace breve::command {

/// As breve_program_compile. Prints why the file cannot be compiled, unless the runtime has a diagnostic of it.
/// @param loader  finds what the file names by `require` and `breve.use`
breve_status compile_lua(breve_runtime* runtime, ModuleLoader& loader, const LoadedFile& file, Output& output,
                         breve_program*& program);

}  // namespace breve::command

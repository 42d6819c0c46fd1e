// The libraries that programs may load with @plugin.
#pragma once

#include <string>
#include <vector>

#include "breve/breve.h"

namespace breve::command {

/// A breve_open_plugin_fn's work: a program names a library by its path below one of these directories.
/// @return  false with the reason
bool open_plugin_below(const std::vector<std::string>& directories, const char* file, const char* entry,
                       breve_plugin* plugin, breve_write_fn reason, void* sink);

}  // namespace breve::command

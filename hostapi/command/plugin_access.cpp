// Plugins are loaded from directories that the user names: a library runs with all rights of the process.
#include "plugin_access.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace breve::command {

namespace fs = std::filesystem;

bool open_plugin_below(const std::vector<std::string>& directories, const char* file, const char* entry,
                       breve_plugin* plugin, breve_write_fn reason, void* sink) {
  const auto refuse = [&](const std::string& why) {
    reason(sink, why.data(), why.size());
    return false;
  };
  const fs::path name(file);
  if (name.empty() || name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end())
    return refuse("its name must be a path below a directory of --allow-plugins");
  for (const auto& directory : directories) {
    const fs::path path = fs::absolute(directory) / name;
    std::error_code problem;
    if (!fs::is_regular_file(path, problem)) continue;
    return breve_plugin_open(path.c_str(), entry, plugin, reason, sink) == BREVE_OK;
  }
  return refuse(fmt::format("there is no such file in {}", fmt::join(directories, ", ")));
}

}  // namespace breve::command

// The search path: launch directory, its libraries, the user's paths, the environment, the home directory, then the
// directory of each loaded file and each @path in order of appearance; last, next to the file that asks.
#include "module_loader.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "source_file.hpp"

namespace breve::command {

namespace fs = std::filesystem;

namespace {

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && !fs::is_directory(path, ignored);
}

/// A file is the same however it is spelled.
fs::path identity(const fs::path& path) {
  std::error_code error;
  const fs::path canonical = fs::canonical(path, error);
  return error ? fs::absolute(path) : canonical;
}

}  // namespace

std::vector<fs::path> class_path() {
  std::vector<fs::path> folders;
  const char* const list = std::getenv("BREVE_CLASS_PATH");
  std::istringstream rest(list ? list : "");
  for (std::string entry; std::getline(rest, entry, ':');)
    if (!entry.empty()) folders.emplace_back(entry);
  return folders;
}

ModuleLoader::ModuleLoader(const std::vector<std::string>& paths) {
  for (const char* launch : {"", "lib/classes", "lib", "."}) paths_.emplace_back(launch);
  for (const auto& path : paths) paths_.emplace_back(path);
  for (const auto& path : class_path()) paths_.push_back(path);
  if (const char* home = std::getenv("HOME"); home && *home) paths_.emplace_back(home);
}

std::optional<fs::path> ModuleLoader::search(const std::string& name, const std::string& from) const {
  if (name.empty()) return std::nullopt;
  const fs::path asked(name);
  if (asked.is_absolute()) return is_file(asked) ? std::optional(asked) : std::nullopt;
  for (const auto& directory : paths_)
    if (fs::path candidate = directory / asked; is_file(candidate)) return candidate;
  if (!from.empty())
    if (fs::path candidate = fs::path(from).parent_path() / asked; is_file(candidate)) return candidate;
  return std::nullopt;
}

const LoadedFile* ModuleLoader::load(const std::string& name, const std::string& from) {
  const auto path = search(name, from);
  return path ? open(*path) : nullptr;
}

const LoadedFile* ModuleLoader::open(const fs::path& path) {
  const fs::path key = identity(path);
  if (const auto known = files_.find(key); known != files_.end()) return &known->second;
  std::string text;
  try {
    text = read_source(path);
  } catch (const std::exception& e) {
    complaint_ = e.what();
    return nullptr;
  }
  add_path(path.parent_path().string());
  return &files_.emplace(key, LoadedFile{path.string(), std::move(text)}).first->second;
}

void ModuleLoader::add_path(const std::string& directory) {
  fs::path path(directory);
  if (std::find(paths_.begin(), paths_.end(), path) == paths_.end()) paths_.push_back(std::move(path));
}

std::vector<std::string> ModuleLoader::files() const {
  std::vector<std::string> names;
  for (const auto& [path, file] : files_) names.push_back(file.name);
  return names;
}

bool ModuleLoader::resolve(const char* name, const char* from, breve_module& module) {
  const LoadedFile* file = load(name, from);
  if (!file) return false;
  module.name = file->name.c_str();
  module.text = file->text.data();
  module.size = file->text.size();
  return true;
}

}  // namespace breve::command

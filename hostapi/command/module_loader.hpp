// Where the command looks for modules.
#pragma once

#include <filesystem>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "breve/breve.h"

namespace breve::command {

/// A source file as the library gets it; lives as long as the loader.
struct LoadedFile {
  std::string name;  // as messages show it: the path by which it was found first
  std::string text;
};

/// The folders of BREVE_CLASS_PATH.
std::vector<std::filesystem::path> class_path();

class ModuleLoader {
 public:
  /// @param paths  directories given on the command line, searched right after those of the launch directory
  explicit ModuleLoader(const std::vector<std::string>& paths);

  /// The file at `path`, and no other. Null with `complaint` set if it cannot be read.
  const LoadedFile* open(const std::filesystem::path& path);
  /// The file that a directive names; null if there is none, with `complaint` set if there is one that cannot be read.
  /// Its directory joins the search path.
  /// @param from  name of the file that asks, "" for the main file
  const LoadedFile* load(const std::string& name, const std::string& from);
  void add_path(const std::string& directory);
  const std::string& complaint() const { return complaint_; }
  /// The files that were read, by the paths by which they were found.
  std::vector<std::string> files() const;

  /// What breve_resolve_module_fn asks for.
  bool resolve(const char* name, const char* from, breve_module& module);

 private:
  std::optional<std::filesystem::path> search(const std::string& name, const std::string& from) const;

  std::vector<std::filesystem::path> paths_;
  std::map<std::filesystem::path, LoadedFile> files_;  // by canonical path; nodes do not move
  std::string complaint_;
};

}  // namespace breve::command

// What a program that the command runs may touch outside its world.
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "breve/breve.h"

namespace breve::command {

/// Options on files and commands, as `run` and `repl` take them.
struct AccessOptions {
  std::vector<std::string> read, write;  // directories
  std::vector<std::string> plugins;      // directories whose libraries may be loaded
  bool no_files = false, system = false, network = false;
  std::string network_address;  // that servers listen on; "" for this machine only
};

/// Directories below which files may be read, and some of them written. A program's paths are relative to the current
/// directory or to one of these; others are allowed if they lead into one.
class FileAccess {
 public:
  FileAccess() = default;
  ~FileAccess();
  FileAccess(const FileAccess&) = delete;
  FileAccess& operator=(const FileAccess&) = delete;

  /// Throws std::runtime_error if there is no such directory.
  void add(const std::filesystem::path& directory, bool may_write);
  /// The same, but a directory that is not there is left out, and so is one that was added.
  void add_if_there(const std::filesystem::path& directory);
  /// To be searched as well, if it lies below one that may be read.
  void add_below(const std::filesystem::path& directory);
  /// While this object lives. Directories that are added later are also allowed.
  breve_files files();

 private:
  struct Root {
    std::filesystem::path path;   // canonical
    std::filesystem::path asked;  // as it was given; "" for the current directory
    breve_files files;
  };
  /// What a root may call the file; "" if it is not below it.
  static std::string name_in(const Root& root, const std::string& name);
  template <class Open>
  bool open(const std::string& name, breve_write_fn reason, void* sink, const char* option, Open open);

  std::deque<Root> roots_;
  std::string found_;  // path of the last file that was opened
};

}  // namespace breve::command

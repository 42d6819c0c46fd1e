// Files of programs, by the directories that they may use.
#include "access.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace breve::command {

namespace fs = std::filesystem;

namespace {

bool leads_out(const fs::path& name) {
  return name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end();
}

bool is_below(const fs::path& path, const fs::path& folder) {
  const auto [at, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return at == folder.end();
}

}  // namespace

FileAccess::~FileAccess() {
  for (Root& root : roots_) breve_files_release(&root.files);
}

void FileAccess::add(const fs::path& directory, bool may_write) {
  const fs::path asked = directory.empty() ? fs::path(".") : directory;
  std::error_code problem;
  Root root{fs::canonical(asked, problem), directory == "." ? fs::path() : directory, {}};
  if (problem || breve_files_add_directory(asked.c_str(), may_write, 0, &root.files) != BREVE_OK)
    throw std::runtime_error(fmt::format("there is no directory '{}'", asked.string()));
  roots_.push_back(std::move(root));
}

void FileAccess::add_if_there(const fs::path& directory) {
  const fs::path asked = directory.empty() ? fs::path(".") : directory;
  std::error_code problem;
  const fs::path path = fs::canonical(asked, problem);
  const bool known = std::any_of(roots_.begin(), roots_.end(), [&](const Root& root) { return root.path == path; });
  if (!problem && !known && fs::is_directory(path, problem)) add(asked, false);
}

void FileAccess::add_below(const fs::path& directory) {
  std::error_code problem;
  const fs::path path = fs::canonical(directory, problem);
  const auto holds = [&](const Root& root) { return is_below(path, root.path); };
  if (!problem && std::any_of(roots_.begin(), roots_.end(), holds)) add_if_there(path);
}

std::string FileAccess::name_in(const Root& root, const std::string& name) {
  if (!leads_out(name)) return name;
  std::error_code problem;
  const fs::path whole = fs::absolute(name, problem).lexically_normal();
  if (problem || whole == root.path || !is_below(whole, root.path)) return {};
  return whole.lexically_relative(root.path).string();
}

/// In the first directory that has it.
template <class Open>
bool FileAccess::open(const std::string& name, breve_write_fn reason, void* sink, const char* option, Open open) {
  std::string why;
  bool asked = false;
  const breve_write_fn note = [](void* text, const char* bytes, std::size_t size) {
    auto& to = *static_cast<std::string*>(text);
    if (to.empty()) to.assign(bytes, size);
  };
  for (const Root& root : roots_) {
    const std::string own = name_in(root, name);
    if (own.empty()) continue;
    asked = true;
    if (!open(root, own.c_str(), note, &why)) continue;
    found_ = (root.asked / own).string();
    return true;
  }
  if (!asked) why = fmt::format("it is in none of the directories that the program may use; {} DIR adds one", option);
  if (!why.empty()) reason(sink, why.data(), why.size());
  return false;
}

breve_files FileAccess::files() {
  breve_files files{};
  files.user = this;
  files.open_for_reading = [](void* user, breve_world* world, const char* name, breve_file* file, breve_write_fn reason,
                              void* sink) {
    auto& access = *static_cast<FileAccess*>(user);
    const auto open = [&](const Root& root, const char* own, breve_write_fn note, void* why) {
      return root.files.open_for_reading(root.files.user, world, own, file, note, why);
    };
    if (!access.open(name, reason, sink, "--allow-read", open)) return false;
    file->path = access.found_.c_str();
    return true;
  };
  files.open_for_writing = [](void* user, breve_world* world, const char* name, bool append, breve_file* file,
                              breve_write_fn reason, void* sink) {
    return static_cast<FileAccess*>(user)->open(
        name, reason, sink, "--allow-write", [&](const Root& root, const char* own, breve_write_fn note, void* why) {
          return root.files.open_for_writing(root.files.user, world, own, append, file, note, why);
        });
  };
  return files;
}

}  // namespace breve::command

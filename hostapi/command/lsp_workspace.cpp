// Open files, and their programs, looked at again when a file of theirs changes.
#include "lsp_workspace.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "lsp_text.hpp"
#include "module_loader.hpp"

namespace breve::command {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kLibrary = "library:";

std::string canonical_path(const std::string& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(path, error);
  return error ? path : found.string();
}

/// Does a line begin with the word? Text that does not compile yet also counts.
bool names_controller(std::string_view text) {
  constexpr std::string_view kWord = "Controller";
  for (std::size_t at = text.find(kWord); at != std::string_view::npos; at = text.find(kWord, at + 1)) {
    const std::size_t before = text.find_last_not_of(" \t", at == 0 ? std::string_view::npos : at - 1);
    const bool first = at == 0 || before == std::string_view::npos || text[before] == '\n' || text[before] == '\r';
    const std::size_t after = at + kWord.size();
    if (first && after < text.size() && (text[after] == ' ' || text[after] == '\t')) return true;
  }
  return false;
}

struct RuntimeDeleter {
  void operator()(breve_runtime* runtime) const { breve_runtime_destroy(runtime); }
};
using RuntimeHandle = std::unique_ptr<breve_runtime, RuntimeDeleter>;

}  // namespace

/// Modules for one analysis: from the editor if it has them, else from disk.
class LspWorkspace::Modules {
 public:
  Modules(const LspWorkspace& workspace, const std::string& main) : workspace_(workspace), loader_(workspace.paths_) {
    if (!main.empty()) loader_.add_path(fs::path(main).parent_path().string());
  }

  RuntimeHandle runtime() {
    breve_runtime_config config = breve_runtime_config_default();
    config.user = this;
    config.resolve_module = [](void* user, const char* name, const char* from, breve_module* module) {
      return static_cast<Modules*>(user)->resolve(name, from, *module);
    };
    config.add_path = [](void* user, const char* directory) {
      static_cast<Modules*>(user)->loader_.add_path(directory);
    };
    breve_runtime* made = nullptr;
    if (breve_runtime_create(&config, &made) != BREVE_OK) throw std::runtime_error("cannot make a runtime");
    return RuntimeHandle(made);
  }

 private:
  bool resolve(const char* name, const char* from, breve_module& module) {
    const bool found = loader_.resolve(name, from, module);
    const std::string path = canonical_path(found ? module.name : (fs::path(from).parent_path() / name).string());
    for (const auto& [uri, document] : workspace_.documents_) {
      if (document.path.empty() || document.path != path) continue;
      if (!found) module.name = document.path.c_str();  // not saved yet
      module.text = document.text.data();
      module.size = document.text.size();
      return true;
    }
    return found;
  }

  const LspWorkspace& workspace_;
  ModuleLoader loader_;
};

fs::path library_cache() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path base;
  if (cache && *cache == '/') {
    base = cache;
  } else if (home && *home == '/') {
    base = fs::path(home) / ".cache";
  } else {
    return {};
  }
  return base / "breve" / (std::string("library-") + breve_version());
}

void LspWorkspace::open(const std::string& uri, std::string text) {
  Document& document = documents_[uri];
  const auto path = path_of_uri(uri);
  document.path = path ? canonical_path(*path) : "";
  change(uri, std::move(text));
}

void LspWorkspace::close(const std::string& uri) {
  const auto found = documents_.find(uri);
  if (found == documents_.end()) return;
  documents_.erase(found);
  forget_programs();  // the file is that on disk from now on
}

const std::string* LspWorkspace::text(const std::string& uri) const {
  const auto found = documents_.find(uri);
  return found == documents_.end() ? nullptr : &found->second.text;
}

// Programs that hold the file are looked at again; so are those that miss a file, which may be this one.
void LspWorkspace::change(const std::string& uri, std::string text) {
  documents_[uri].text = std::move(text);
  for (auto& [other, document] : documents_) {
    ProgramView* program = document.program.get();
    if (program == nullptr) continue;
    bool concerned = other == uri || program->names.find(uri) != program->names.end();
    for (std::size_t i = 0; !concerned && i < breve_analysis_diagnostic_count(program->analysis.get()); ++i) {
      breve_diagnostic d;
      concerned = breve_analysis_diagnostic(program->analysis.get(), i, &d) == BREVE_OK &&
                  std::string_view(d.code) == "file-not-found";
    }
    if (concerned) document.program.reset();
  }
}

void LspWorkspace::forget_programs() {
  for (auto& [uri, document] : documents_) document.program.reset();
}

std::vector<std::string> LspWorkspace::open_uris() const {
  std::vector<std::string> uris;
  for (const auto& [uri, document] : documents_) uris.push_back(uri);
  return uris;
}

FileView LspWorkspace::view(const std::string& uri) {
  const auto found = documents_.find(uri);
  if (found == documents_.end()) return {};
  ProgramView& own = program_of(uri, found->second);
  if (!own.whole) {
    for (auto& [other, document] : documents_) {
      if (other == uri) continue;
      ProgramView& program = program_of(other, document);
      const auto name = program.names.find(uri);
      if (program.whole && name != program.names.end()) return {&program, name->second};
    }
  }
  const auto name = own.names.find(uri);
  return name == own.names.end() ? FileView{} : FileView{&own, name->second};
}

ProgramView& LspWorkspace::program_of(const std::string& uri, Document& document) {
  if (!document.program) document.program = look(uri, document);
  return *document.program;
}

// A module of the class library that is shown from the cache is itself, and no program that redefines it.
std::unique_ptr<ProgramView> LspWorkspace::look(const std::string& uri, const Document& document) {
  auto view = std::make_unique<ProgramView>();
  const std::string module = library_module(document.path);
  const std::string name = document.path.empty() ? uri : document.path;
  const std::string text = module.empty() ? document.text : "@use " + module.substr(0, module.size() - 3) + ".\n";
  Modules modules(*this, module.empty() ? document.path : "");
  const RuntimeHandle runtime = modules.runtime();
  breve_analysis* made = nullptr;
  const std::string main = module.empty() ? name : "main";
  if (breve_analysis_create(runtime.get(), main.c_str(), text.c_str(), text.size(), &made) != BREVE_OK) return view;
  view->analysis.reset(made);
  for (std::size_t i = 0; i < breve_analysis_file_count(made); ++i) {
    breve_source file;
    if (breve_analysis_file(made, i, &file) != BREVE_OK || file.library) continue;
    const std::string where = i == 0 ? uri : uri_of_path(canonical_path(file.name));
    view->whole = view->whole || names_controller({file.text, file.size});
    view->uris.emplace(file.name, where);
    view->names.emplace(where, file.name);
  }
  if (!module.empty()) view->names = {{uri, std::string(kLibrary) + module}};
  return view;
}

std::string LspWorkspace::library_module(const std::string& path) const {
  const fs::path cache = library_cache();
  if (path.empty() || cache.empty() || fs::path(path).parent_path() != canonical_path(cache.string())) return {};
  const std::string name = fs::path(path).filename().string();
  for (std::size_t i = 0; i < breve_library_module_count(); ++i) {
    breve_source module;
    if (breve_library_module(i, &module) == BREVE_OK && name == module.name) return name;
  }
  return {};
}

std::string LspWorkspace::uri_of(const ProgramView& program, const std::string& name) {
  if (name.starts_with(kLibrary)) return library_uri(name.substr(kLibrary.size()));
  const auto found = program.uris.find(name);
  return found == program.uris.end() ? std::string() : found->second;
}

std::string LspWorkspace::library_uri(const std::string& module) {
  const fs::path cache = library_cache();
  for (std::size_t i = 0; !cache.empty() && i < breve_library_module_count(); ++i) {
    breve_source source;
    if (breve_library_module(i, &source) != BREVE_OK || module != source.name) continue;
    const fs::path path = cache / module;
    std::error_code error;
    fs::create_directories(cache, error);
    std::ifstream old(path, std::ios::binary);
    const std::string before((std::istreambuf_iterator<char>(old)), std::istreambuf_iterator<char>());
    const std::string_view text(source.text, source.size);
    if (before != text) {
      fs::remove(path, error);
      std::ofstream out(path, std::ios::binary);
      out << text;
      out.close();
      if (!out) return {};
      constexpr auto kReadOnly = fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read;
      fs::permissions(path, kReadOnly, error);
    }
    return uri_of_path(path.string());
  }
  return {};
}

}  // namespace breve::command

// Completion from breve.h's analysis of the program, and the session's own variables.
#include "repl_names.hpp"

#include <algorithm>

namespace breve::command {

const std::vector<std::string> kReplCommands = {"describe", "effects", "help", "objects", "quit",
                                                "reload",   "run",     "step", "time"};

void ProgramNames::use(const std::string& module, const std::string* text, breve_world* world) {
  world_ = world;
  breve_analysis* made = nullptr;
  const breve_status status =
      breve_analysis_create(runtime_, module.c_str(), text ? text->c_str() : nullptr, text ? text->size() : 0, &made);
  if (status != BREVE_OK) return;  // then the names are those of before
  breve_analysis_destroy(analysis_);
  analysis_ = made;
}

std::vector<std::string> ProgramNames::session_names() const {
  std::vector<std::string> found;
  breve_value hash, keys, key;
  std::size_t size = 0;
  if (breve_world_session(world_, &hash) != BREVE_OK || breve_hash_keys(world_, &hash, &keys) != BREVE_OK ||
      breve_list_size(world_, &keys, &size) != BREVE_OK)
    return found;
  for (std::size_t i = 0; i < size; ++i)
    if (breve_list_get(world_, &keys, i, &key) == BREVE_OK && key.type == BREVE_TYPE_STRING)
      found.emplace_back(key.as.string.bytes, key.as.string.size);
  return found;
}

std::vector<std::string> ProgramNames::names(const std::string& line, const std::string& typed) {
  std::vector<std::string> found;
  const auto add = [&](const std::string& name) {
    if (name.compare(0, typed.size(), typed) == 0 && std::find(found.begin(), found.end(), name) == found.end())
      found.push_back(name);
  };
  if (!line.empty() && line.front() == ':' && line.find(' ') == std::string::npos) {
    for (const auto& command : kReplCommands) add(command);
    return found;
  }
  for (const auto& name : session_names()) add(name);
  if (!analysis_) return found;
  const std::size_t start = line.front() == ':' ? line.find(' ') : 0;
  const std::string statement = line.substr(start);
  const char* self = breve_object_class(world_, breve_world_controller(world_));
  std::size_t count = 0;
  const auto ask = [&](breve_completion* items, std::size_t capacity) {
    return breve_analysis_statement_completions(analysis_, self, statement.data(), statement.size(), statement.size(),
                                                nullptr, items, capacity, &count);
  };
  if (ask(nullptr, 0) != BREVE_OK) return found;
  std::vector<breve_completion> items(count);
  if (ask(items.data(), items.size()) != BREVE_OK) return found;
  for (const auto& item : items) add(item.name);
  return found;
}

std::vector<std::string> ProgramNames::variables(const std::string& class_name) const {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < breve_analysis_symbol_count(analysis_); ++i) {
    breve_symbol symbol;
    if (breve_analysis_symbol(analysis_, i, &symbol) == BREVE_OK && symbol.kind == BREVE_NAME_VARIABLE &&
        class_name == symbol.owner)
      found.emplace_back(symbol.name);
  }
  return found;
}

std::vector<std::string> ProgramNames::line_of(const std::string& class_name) const {
  std::vector<std::string> line{class_name};
  const std::size_t count = breve_analysis_symbol_count(analysis_);
  for (bool more = true; more && line.size() <= count;) {
    more = false;
    for (std::size_t i = 0; i < count && !more; ++i) {
      breve_symbol symbol;
      if (breve_analysis_symbol(analysis_, i, &symbol) != BREVE_OK || symbol.kind != BREVE_NAME_CLASS ||
          (line.back() != symbol.name && line.back() != symbol.alias))
        continue;
      more = *symbol.parent_class != '\0' && std::string(symbol.parent_class) != "NULL";
      if (more) line.emplace_back(symbol.parent_class);
      break;
    }
  }
  return line;
}

}  // namespace breve::command

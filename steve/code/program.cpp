// Queries on a compiled program: symbols, classes, variables, methods.
#include "steve/code/program.hpp"

#include <algorithm>

#include "steve/code/bytecode.hpp"

namespace breve::steve {

Symbol SymbolTable::intern(std::string_view name) {
  if (const auto known = by_name_.find(name); known != by_name_.end()) return known->second;
  const auto at = by_name_.emplace(name, static_cast<Symbol>(names_.size())).first;
  names_.push_back(&at->first);
  return at->second;
}

SymbolTable::SymbolTable(const SymbolTable& other) : by_name_(other.by_name_) {
  names_.resize(by_name_.size());
  for (const auto& [name, symbol] : by_name_) names_[symbol] = &name;
}

void SymbolTable::truncate(std::size_t count) {
  while (names_.size() > count) {
    by_name_.erase(by_name_.find(*names_.back()));
    names_.pop_back();
  }
}

Symbol SymbolTable::find(std::string_view name) const {
  const auto at = by_name_.find(name);
  return at == by_name_.end() ? kNoSymbol : at->second;
}

MethodInfo::MethodInfo() = default;
MethodInfo::~MethodInfo() = default;
MethodInfo::MethodInfo(MethodInfo&&) noexcept = default;

namespace {
std::uint64_t key_of(Symbol name, std::size_t count) { return std::uint64_t{name} << 32 | count; }
}  // namespace

void ClassInfo::add_variable(const VariableInfo& variable) {
  variable_indices_.emplace(variable.name, variables.size());
  variables.push_back(variable);
}

void ClassInfo::add_method(std::unique_ptr<MethodInfo> method) {
  by_count_.emplace(key_of(method->name, method->parameters.size()), method.get());
  responds_.insert(method->name);
  methods.push_back(std::move(method));
}

const VariableInfo* ClassInfo::find_variable(Symbol wanted) const {
  for (const ClassInfo* c = this; c; c = c->parent)
    if (const auto index = c->variable_indices_.find(wanted); index != c->variable_indices_.end())
      return &c->variables[index->second];
  return nullptr;
}

const MethodInfo* ClassInfo::own_method(Symbol wanted, std::size_t count) const {
  const auto found = by_count_.find(key_of(wanted, count));
  return found == by_count_.end() ? nullptr : found->second;
}

const MethodInfo* ClassInfo::find_method(Symbol wanted, std::size_t count) const {
  for (const ClassInfo* c = this; c; c = c->parent)
    if (const MethodInfo* method = c->own_method(wanted, count)) return method;
  return nullptr;
}

bool ClassInfo::responds(Symbol wanted) const {
  for (const ClassInfo* c = this; c; c = c->parent)
    if (c->responds_.contains(wanted)) return true;
  return false;
}

Program::Program(const LibrarySource& library) : code_(std::make_unique<CodeTables>()), library_(&library) {}
Program::~Program() = default;

namespace {
template <class T>
void copy_with_room(const std::vector<T>& from, std::vector<T>& to, std::size_t room) {
  to.reserve(from.size() + room);
  to = from;
}
}  // namespace

Program::Program(const Program& base, std::size_t room)
    : classes_(base.classes_),
      class_names_(base.class_names_),
      controller_(base.controller_),
      symbols_(base.symbols_),
      sources_(base.sources_),
      defines_(base.defines_),
      code_(std::make_unique<CodeTables>()),
      diagnostics_(base.diagnostics_),
      fingerprint_(base.fingerprint_),
      library_(base.library_),
      foreign_(base.foreign_),
      foreign_classes_(base.foreign_classes_),
      fragment_methods_(base.fragment_methods_) {
  copy_with_room(base.code_->strings, code_->strings, room);
  copy_with_room(base.code_->texts, code_->texts, room);
  copy_with_room(base.code_->sites, code_->sites, room);
  copy_with_room(base.code_->members, code_->members, room);
  copy_with_room(base.code_->interpolations, code_->interpolations, room);
}

const ClassInfo* Program::find_class(std::string_view name) const {
  const auto at = class_names_.find(name);
  return at == class_names_.end() ? nullptr : at->second;
}

}  // namespace breve::steve

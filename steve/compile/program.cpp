// What is known of a compiled program: symbols, classes, variables, methods.
#include "steve/compile/program.hpp"

#include <algorithm>

#include "steve/compile/bytecode.hpp"

namespace breve::steve {

Symbol SymbolTable::intern(std::string_view name) {
  const auto [at, added] = by_name_.try_emplace(std::string(name), static_cast<Symbol>(names_.size()));
  if (added) names_.push_back(&at->first);
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
  const auto at = by_name_.find(std::string(name));
  return at == by_name_.end() ? kNoSymbol : at->second;
}

MethodInfo::MethodInfo() = default;
MethodInfo::~MethodInfo() = default;
MethodInfo::MethodInfo(MethodInfo&&) noexcept = default;

const VariableInfo* ClassInfo::find_variable(Symbol wanted) const {
  for (const ClassInfo* c = this; c; c = c->parent)
    for (const auto& variable : c->variables)
      if (variable.name == wanted) return &variable;
  return nullptr;
}

const MethodInfo* ClassInfo::find_method(Symbol wanted, std::size_t count) const {
  for (const ClassInfo* c = this; c; c = c->parent)
    for (const auto& method : c->methods)
      if (method->name == wanted && method->parameters.size() == count) return method.get();
  return nullptr;
}

bool ClassInfo::responds(Symbol wanted) const {
  for (const ClassInfo* c = this; c; c = c->parent)
    for (const auto& method : c->methods)
      if (method->name == wanted) return true;
  return false;
}

Program::Program() : code_(std::make_unique<CodeTables>()) {}
Program::~Program() = default;

const ClassInfo* Program::find_class(std::string_view name) const {
  const auto at = class_names_.find(std::string(name));
  return at == class_names_.end() ? nullptr : at->second;
}

}  // namespace breve::steve

// The methods that handlers name: found once for each class and name, not at each of their calls.
#pragma once

#include <array>
#include <memory_resource>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "steve/code/program.hpp"

namespace breve::steve {

class HandlerMethods {
 public:
  /// The methods of a name, by number of parameters; null if the class has none.
  using ByCount = std::array<const MethodInfo*, 6>;

  explicit HandlerMethods(std::pmr::memory_resource* memory) : by_class_(memory) {}

  /// What stays valid until `clear`, or the next class or name that is new.
  const ByCount& find(const ClassInfo& cls, std::string_view name, const SymbolTable& symbols) {
    auto& entries = by_class_[&cls];
    for (const Entry& entry : entries)
      if (entry.name == name) return entry.methods;
    ByCount methods{};
    if (const Symbol symbol = symbols.find(name); symbol != kNoSymbol)
      for (std::size_t count = 0; count < methods.size(); ++count) methods[count] = cls.find_method(symbol, count);
    return entries.emplace_back(Entry{std::pmr::string(name, by_class_.get_allocator().resource()), methods}).methods;
  }
  /// Classes or methods were replaced.
  void clear() noexcept { by_class_.clear(); }

 private:
  struct Entry {
    std::pmr::string name;
    ByCount methods;
  };
  std::pmr::unordered_map<const ClassInfo*, std::pmr::vector<Entry>> by_class_;  // found by key only
};

}  // namespace breve::steve

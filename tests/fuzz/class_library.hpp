// What the class library offers to programs, as breve.h tells it: classes, their variables and selectors, functions.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace breve::fuzz {

struct LibraryKeyword {
  std::string name, type, parameter;
  bool optional = false;
};

struct LibrarySelector {
  std::string name, type;
  std::vector<LibraryKeyword> keywords;
};

struct LibraryVariable {
  std::string name, type;
};

struct LibraryClass {
  std::string name, parent, module;
  std::vector<LibrarySelector> selectors;
  std::vector<LibraryVariable> variables;
};

class ClassLibrary {
 public:
  /// Read once.
  static const ClassLibrary& get();

  const std::vector<std::string>& modules() const { return modules_; }
  const std::vector<LibraryClass>& classes() const { return classes_; }
  const std::vector<LibrarySelector>& functions() const { return functions_; }
  const LibraryClass* find(std::string_view name) const;
  bool derives(std::string_view name, std::string_view from) const;

 private:
  ClassLibrary();
  void add_function(std::string_view name, std::string_view type, std::string_view signature);

  std::vector<std::string> modules_;
  std::vector<LibraryClass> classes_;
  std::map<std::string, std::size_t, std::less<>> numbers_;
  std::vector<LibrarySelector> functions_;
};

}  // namespace breve::fuzz

// The contents of reference pages about classes, gathered from analyses.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "breve/analysis.h"
#include "breve/breve.h"

namespace breve::command {

struct DocKeyword {
  std::string name, variable, type, value;  // value: the default, "" if there is none
};

struct DocMethod {
  std::string name, signature, type, text;
  bool hidden = false;  // declared with '-' or '='
  std::vector<DocKeyword> keywords;

  /// "set-velocity-to": one for each method of a class, also where several share a name.
  std::string anchor() const;
  /// "set-velocity to"
  std::string title() const;
};

struct DocVariable {
  std::string name, type, text;
};

struct DocClass {
  std::string name, alias, parent, module, text;
  bool library = false;  // `module` then has no folder
  std::vector<DocVariable> variables;
  std::vector<DocMethod> methods;
};

/// Classes by name. Pages are made of those that are `chosen`; the others are known as their ancestors.
class DocModel {
 public:
  /// Take the classes of an analysis.
  /// @param library  choose those of the class library too
  /// @return  names of classes that another file has defined before, with other contents
  std::vector<std::string> add(const breve_analysis* analysis, bool library);

  const std::map<std::string, DocClass>& classes() const { return classes_; }
  bool chosen(const std::string& name) const { return chosen_.find(name) != chosen_.end(); }
  /// Parent first, then its parent. Bounded, also where classes are each other's parents.
  std::vector<const DocClass*> ancestors(const DocClass& cls) const;
  std::vector<const DocClass*> children(const std::string& name) const;
  /// Methods of an ancestor that no class between it and `cls` defines anew.
  std::vector<const DocMethod*> inherited(const DocClass& cls, const DocClass& ancestor) const;

 private:
  std::map<std::string, DocClass> classes_;
  std::map<std::string, bool> chosen_;
};

/// The first sentence of a text.
std::string first_sentence(const std::string& text);

}  // namespace breve::command

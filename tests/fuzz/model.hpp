// What the generator knows of the program that it is making: classes, variables, methods.
#pragma once

#include <string>
#include <vector>

namespace breve::fuzz {

enum class Type { Int, Double, Vector, Matrix, String, Object, List, Hash };

/// The contents of a list or of a hash, so that reading it back gives what is wanted most of the time.
struct Kind {
  Type type = Type::Int;
  int cls = -1;              // Object: number of the class, -1: any
  Type element = Type::Int;  // List, Hash: of the elements; never List or Hash
  int element_cls = -1;
};

struct Variable {
  std::string name;
  Kind kind;
  int array = 0;  // elements; 0: no array
};

struct Parameter {
  std::string keyword, name;
  Kind kind;
  std::string default_text;  // "": none
};

struct Method {
  std::string name;
  std::vector<Parameter> parameters;
  Kind result;
  bool special = false;  // called by the machine, not by other methods
  std::string prologue;  // statements that come first
  std::string after;     // statements that come last
};

enum class Base { Object, Mobile, Stationary, Control };

struct Class {
  std::string name, alias, parent_name;
  int parent = -1;  // number, or -1 if it is of the library
  Base base = Base::Object;
  std::vector<Variable> variables;
  std::vector<Method> methods;
};

}  // namespace breve::fuzz

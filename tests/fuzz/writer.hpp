// The part of the generator that writes bodies of methods: expressions of a wanted type, and statements.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "choices.hpp"
#include "model.hpp"

namespace breve::fuzz {

/// Draws in the order in which it is written: the operands of + may be evaluated in any, and each compiler has its own.
inline std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const auto part : parts) text += part;
  return text;
}

class Writer {
 public:
  Writer(Choices& choices, const std::vector<Class>& classes) : choose_(choices), classes_(classes) {}

  /// The whole text of a method.
  std::string method(int cls, const Method& method);
  /// A default: a literal of the kind's type; "" for types that have none.
  std::string literal(const Kind& kind);
  /// "(int)", "(C1 object)".
  std::string declared(const Kind& kind) const;
  Kind any_kind(bool containers);

 private:
  struct Scope {
    int cls = 0;
    const Method* method = nullptr;
    std::vector<Variable> locals;  // and parameters
    int loops = 0, depth = 0;      // nested loops; nested expressions
  };

  // expressions.cpp
  std::string expression(const Kind& kind);
  std::string leaf(const Kind& kind);
  std::string int_expression();
  std::string double_expression();
  std::string vector_expression();
  std::string matrix_expression();
  std::string string_expression();
  std::string object_expression(int cls);
  std::string list_expression(const Kind& kind);
  std::string hash_expression(const Kind& kind);
  std::string condition();
  std::string text_literal(bool interpolated);
  std::string key();
  std::string named(const std::string& name, const Kind& kind, int array);
  std::string element_of_container(const Kind& kind);
  std::string variable(const Kind& kind);  // "" if there is none of that kind
  std::string container(Type type, Kind& found);

  // calls.cpp
  std::string call(const Kind& result);  // parenthesised; "" if no method gives that
  std::string call_text(const std::string& receiver, int cls, const Method& method);
  std::string native_call();  // a method of the class library on self, without a value
  std::string native_value(const Kind& kind);
  std::string mobile_call(const std::string& receiver);
  std::string control_call(const std::string& receiver);
  const Method* some_method(int cls, bool parameterless);
  std::string method_name(std::size_t parameters);

  // statements.cpp
  std::string statements(std::size_t count, int indent);
  std::string statement(int indent);
  std::string assignment();
  std::string loop(int indent);
  std::string branch(int indent);
  std::string block(int indent);
  std::string list_statement();
  std::string event_statement();
  std::string lifetime_statement();
  std::string target(Kind& kind);
  std::string objects_list();

  std::vector<Variable> visible() const;
  bool derives(int cls, int from) const;
  static bool fits(const Kind& have, const Kind& want);

  Choices& choose_;
  const std::vector<Class>& classes_;
  Scope scope_;
};

}  // namespace breve::fuzz

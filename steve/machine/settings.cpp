// Variables of the controller that the host sets, as text, before the controller's init runs.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>

#include "steve/machine/machine.hpp"

namespace breve::steve {

namespace {

std::string_view stripped(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// A number, all of the text.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  text = stripped(text);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// (x, y, z), the parentheses left out or not.
std::optional<Vector3> vector_in(std::string_view text) {
  text = stripped(text);
  if (text.starts_with('(') && text.ends_with(')')) text = text.substr(1, text.size() - 2);
  Vector3 v(0, 0, 0);
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (i == 2)) return std::nullopt;
    const auto component = number_in<double>(text.substr(0, comma));
    if (!component) return std::nullopt;
    v[i] = *component;
    if (i < 2) text.remove_prefix(comma + 1);
  }
  return v;
}

[[noreturn]] void fail_unknown_setting(const ClassInfo& controller, std::string_view name, const SymbolTable& symbols) {
  std::vector<std::string_view> names;
  for (const ClassInfo* c = &controller; c; c = c->parent)
    for (const auto& v : c->variables) names.push_back(symbols.name(v.name));
  const std::string near = nearest(name, names);
  throw Error(ErrorCode::Argument, fmt::format("the controller's class {} has no variable '{}'{}", controller.name,
                                               name, near.empty() ? "" : fmt::format(": did you mean '{}'?", near)));
}

}  // namespace

void Machine::apply_settings(Instance& controller) {
  for (const auto& [name, text] : host_.settings) {
    const Symbol symbol = program_->symbols().find(name);
    const VariableInfo* variable = symbol == kNoSymbol ? nullptr : controller.cls->find_variable(symbol);
    if (!variable) fail_unknown_setting(*controller.cls, name, program_->symbols());
    const auto refuse = [&, &key = name, &value = text](const char* wanted) {
      throw Error(ErrorCode::Argument, fmt::format("the variable '{}' of class {} cannot be set to '{}': {}", key,
                                                   controller.cls->name, value, wanted));
    };
    if (variable->array_size >= 0) refuse("it is an array");
    std::optional<Value> value;
    switch (variable->type) {
      case StaticType::Int:
        if (const auto n = number_in<std::int32_t>(text)) value = Value::of(*n);
        if (!value) refuse("it is an int");
        break;
      case StaticType::Double:
        if (const auto n = number_in<double>(text)) value = Value::of(*n);
        if (!value) refuse("it is a float");
        break;
      case StaticType::Vector:
        if (const auto v = vector_in(text)) value = Value::of(*v);
        if (!value) refuse("it is a vector: write (x, y, z)");
        break;
      case StaticType::String: value = Value::of(Tag::String, heap_->string(text)); break;
      default: refuse("only ints, floats, vectors and strings can be set");
    }
    set_variable(controller, *variable, *value);
  }
  host_.settings.clear();
}

}  // namespace breve::steve

// Variables by name, methods by name and keywords, prepared selectors.
#include <algorithm>
#include <array>
#include <span>

#include "internal.hpp"
#include "runtime/base/hasher.hpp"

namespace breve::host {

using steve::ClassInfo;
using steve::Instance;
using steve::Value;

const steve::VariableInfo& variable_named(const breve_world& world, const Instance& instance, const char* name) {
  need(name, "name");
  const steve::Symbol symbol = world.program->symbols().find(name);
  const auto* variable = symbol == steve::kNoSymbol ? nullptr : instance.cls->find_variable(symbol);
  if (!variable) fail(BREVE_ERROR_NOT_FOUND, "class " + instance.cls->name + " has no variable '" + name + "'");
  if (variable->array_size >= 0)
    fail(BREVE_ERROR_UNSUPPORTED,
         "variable '" + std::string(name) + "' of class " + instance.cls->name + " is an array");
  return *variable;
}

namespace {

void need_method(const breve_world& world, const ClassInfo& cls, std::string_view method) {
  if (!world.machine->responds(cls, method))
    fail(BREVE_ERROR_NOT_FOUND, "class " + cls.name + " has no method '" + std::string(method) + "'");
}

/// Find what `selector` means for `cls`: a method with exactly its keywords can be called by position.
void resolve(const breve_world& world, Selector& selector, const ClassInfo& cls) {
  selector.order.reserve(selector.keywords.size());  // nothing may fail half-way
  const ClassInfo* start = &cls;
  if (!selector.super_of.empty()) {
    const ClassInfo& from = class_named(world, selector.super_of.c_str());
    if (!cls.derives_from(from))
      fail(BREVE_ERROR_TYPE, "the object is of class " + cls.name + ", not of " + from.name + " or a descendant");
    selector.super_class = &from;
    start = from.parent;
    if (!start) fail(BREVE_ERROR_NOT_FOUND, "class " + from.name + " has no parent");
  }
  selector.cls = &cls;
  selector.resolved = world.machine->find_method(*start, selector.method, selector.keywords.size());
  selector.order.clear();
  if (!selector.resolved) return;
  for (const auto& parameter : selector.resolved->parameters) {
    const auto& keyword = world.program->symbols().name(parameter.keyword);
    const auto found = std::find(selector.keywords.begin(), selector.keywords.end(), std::string_view(keyword));
    if (found == selector.keywords.end()) {
      selector.resolved = nullptr;  // has other keywords: the machine finds the right overload or says what is wrong
      return;
    }
    selector.order.push_back(static_cast<std::uint32_t>(found - selector.keywords.begin()));
  }
}

Value call_by_keywords(breve_world& world, Instance& receiver, std::string_view method,
                       std::span<const std::pair<std::string_view, Value>> keywords,
                       const ClassInfo* super_of = nullptr) {
  need_method(world, super_of ? *super_of->parent : *receiver.cls, method);
  const ScriptScope script(world);
  return world.machine->call_with_keywords(receiver, method, keywords, super_of);
}

std::uint32_t digest(const Selector& selector) {
  Hasher hasher;
  hasher.add(std::string_view(selector.method));
  for (const auto& keyword : selector.keywords) hasher.add(std::string_view(keyword));
  if (!selector.super_of.empty()) hasher.add(std::string_view(selector.super_of));
  return static_cast<std::uint32_t>(hasher.value() >> 32) | 1U;  // the all-zero selector is invalid
}

}  // namespace

Value call_prepared(breve_world& world, Instance& receiver, Selector& selector, const breve_value* arguments) {
  constexpr std::size_t kInPlace = 8;  // arguments that need no allocation
  const std::size_t count = selector.keywords.size();
  if (selector.cls != receiver.cls) resolve(world, selector, *receiver.cls);
  if (!selector.resolved || count > kInPlace) {
    std::pmr::vector<std::pair<std::string_view, Value>> keywords(&world.meter);
    for (std::size_t i = 0; i < count; ++i) keywords.emplace_back(selector.keywords[i], from_host(world, arguments[i]));
    return call_by_keywords(world, receiver, selector.method, keywords,
                            selector.super_of.empty() ? nullptr : selector.super_class);
  }
  std::array<Value, kInPlace> values;
  for (std::size_t i = 0; i < count; ++i) values[i] = from_host(world, arguments[selector.order[i]]);
  const ScriptScope script(world);
  return world.machine->call(receiver, *selector.resolved, std::span<const Value>(values.data(), count));
}

Selector& selector_of(breve_world& world, breve_selector handle, const breve_value* arguments, std::size_t count) {
  if (handle.index >= world.selectors.size() || world.selectors[handle.index].check != handle.generation)
    fail(BREVE_ERROR_STALE, "this world has not prepared that selector");
  Selector& prepared = world.selectors[handle.index];
  if (count != prepared.keywords.size())
    fail(BREVE_ERROR_ARGUMENT, std::to_string(count) + " arguments for the " +
                                   std::to_string(prepared.keywords.size()) + " keywords of '" +
                                   std::string(prepared.method) + "'");
  if (count != 0) need(arguments, "arguments");
  return prepared;
}

}  // namespace breve::host

using namespace breve::host;
using breve::steve::Value;

breve_status breve_object_get(breve_world* world, breve_object object, const char* name, breve_value* value) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(value, "value");
    const auto& instance = live_instance(*world, object);
    *value = to_host(*world, world->machine->get_variable(instance, variable_named(*world, instance, name)));
  });
}

breve_status breve_object_set(breve_world* world, breve_object object, const char* name, const breve_value* value) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(value, "value");
    auto& instance = live_instance(*world, object);
    const auto& variable = variable_named(*world, instance, name);
    const Value v = from_host(*world, *value);
    try {
      world->machine->set_variable(instance, variable, v);
    } catch (const breve::steve::RunError& e) {
      fail(BREVE_ERROR_TYPE, e.what());
    }
  });
}

breve_status breve_object_call(breve_world* world, breve_object object, const char* method,
                               const breve_keyword* keywords, size_t count, breve_value* result) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(method, "method");
    if (count != 0) need(keywords, "keywords");
    auto& instance = live_instance(*world, object);
    std::pmr::vector<std::pair<std::string_view, Value>> values(&world->meter);
    for (std::size_t i = 0; i < count; ++i) {
      need(keywords[i].name, "the name of a keyword");
      values.emplace_back(keywords[i].name, from_host(*world, keywords[i].value));
    }
    const Value value = call_by_keywords(*world, instance, method, values);
    if (result) *result = to_host(*world, value);
  });
}

namespace {

/// @param super_of  null: a usual call
breve_selector prepare(breve_world& world, const breve::steve::ClassInfo* super_of, const char* method,
                       const char* const* keywords, size_t count) {
  need(method, "method");
  if (count != 0) need(keywords, "keywords");
  Selector made(&world.meter);
  made.method = method;
  if (super_of) made.super_of = super_of->name;
  for (std::size_t i = 0; i < count; ++i) {
    need(keywords[i], "the name of a keyword");
    made.keywords.emplace_back(keywords[i]);
  }
  made.check = digest(made);
  const breve_selector handle{static_cast<std::uint32_t>(world.selectors.size()), made.check};
  world.selectors.push_back(std::move(made));
  return handle;
}

}  // namespace

breve_status breve_world_prepare(breve_world* world, const char* method, const char* const* keywords, size_t count,
                                 breve_selector* selector) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(selector, "selector");
    *selector = prepare(*world, nullptr, method, keywords, count);
  });
}

breve_status breve_world_prepare_super(breve_world* world, const char* class_name, const char* method,
                                       const char* const* keywords, size_t count, breve_selector* selector) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(selector, "selector");
    const auto& cls = class_named(*world, class_name);
    if (!cls.parent) fail(BREVE_ERROR_ARGUMENT, "class " + cls.name + " has no parent");
    *selector = prepare(*world, &cls, method, keywords, count);
  });
}

breve_status breve_object_call_prepared(breve_world* world, breve_object object, breve_selector selector,
                                        const breve_value* arguments, size_t count, breve_value* result) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    Selector& prepared = selector_of(*world, selector, arguments, count);
    const Value value = call_prepared(*world, live_instance(*world, object), prepared, arguments);
    if (result) *result = to_host(*world, value);
  });
}

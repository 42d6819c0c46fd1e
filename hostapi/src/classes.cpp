// Classes of the host: from a description to the text that the compiler reads, and what binds them to worlds.
#include "classes.hpp"

#include <algorithm>
#include <array>

#include "steve/syntax/words.hpp"

namespace breve::host {

namespace {

/// A name that a program can write; the text of the class is made of such names alone.
void check_word(const char* name, const std::string& what) {
  need(name, what.c_str());
  const std::string_view text(name);
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto fits = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; };
  if (text.empty() || !letter(text.front()) || text.back() == '-' || !std::all_of(text.begin(), text.end(), fits))
    fail(BREVE_ERROR_ARGUMENT, what + " is '" + std::string(text) +
                                   "': a name is made of letters, digits, '_' and '-', begins with a letter and does "
                                   "not end with '-'");
}

/// As it stands in parentheses in a program; `any` where every value is one.
std::string type_text(std::uint32_t type, const std::string& what) {
  switch (letter_of(type, what)) {
    case 'i': return "(int)";
    case 'd': return "(float)";
    case 'v': return "(vector)";
    case 'm': return "(matrix)";
    case 's': return "(string)";
    case 'o': return "(object)";
    case 'l': return "(list)";
    case 'h': return "(hash)";
    case 'b': return "(data)";
    default: return "(?)";
  }
}

/// Lines of a comment; a class is read with it, so that editors show it.
std::string comment(const char* doc, const char* indent) {
  std::string text;
  for (std::string_view rest = doc ? doc : ""; !rest.empty();) {
    const auto end = std::min(rest.find('\n'), rest.size());
    text += indent + std::string("% ") + std::string(rest.substr(0, end)) + '\n';
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return text;
}

std::string method_text(const breve_class& c, std::size_t index, std::string& signature) {
  const breve_method& m = c.methods[index];
  const std::string name = "method '" + std::string(m.name) + "'";
  if (m.parameter_count > steve::ForeignFunction::kMostParameters)
    fail(BREVE_ERROR_ARGUMENT, name + " has " + std::to_string(m.parameter_count) + " parameters (must be at most " +
                                   std::to_string(steve::ForeignFunction::kMostParameters) + ")");
  if (m.parameter_count != 0) need(m.parameters, "breve_method.parameters");
  need(reinterpret_cast<const void*>(m.call), "breve_method.call");
  for (const bool reserved : m.reserved)
    if (reserved) fail(BREVE_ERROR_ARGUMENT, "a reserved field of " + name + " is not false");
  std::string text = comment(m.doc, "  ") + "  + to " + m.name;
  for (std::size_t i = 0; i < m.parameter_count; ++i) {
    const breve_parameter& p = m.parameters[i];
    const std::string what = "parameter " + std::to_string(i + 1) + " of " + name;
    check_word(p.keyword, what);
    if (p.reserved != 0) fail(BREVE_ERROR_ARGUMENT, "a reserved field of " + what + " is not 0");
    text += std::string(" ") + p.keyword + " argument" + std::to_string(i + 1) + ' ' + type_text(p.type, what);
    signature += letter_of(p.type, what);
  }
  const std::string result = "the result of " + name;
  signature += std::string(":") + letter_of(m.result, result);
  return text + ": @native \"" + std::to_string(index) + "\" " + type_text(m.result, result) + ".\n";
}

/// Two methods are one where they have the same number of parameters.
void check_twice(const breve_class& c) {
  const std::string name = "class '" + std::string(c.name) + "'";
  for (std::size_t i = 0; i < c.method_count; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (c.methods[i].parameter_count == c.methods[j].parameter_count &&
          std::string_view(c.methods[i].name) == c.methods[j].name)
        fail(BREVE_ERROR_ARGUMENT,
             name + " has two methods '" + std::string(c.methods[i].name) + "' with as many parameters");
  for (std::size_t i = 0; i < c.variable_count; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (std::string_view(c.variables[i].name) == c.variables[j].name)
        fail(BREVE_ERROR_ARGUMENT, name + " has two variables '" + std::string(c.variables[i].name) + "'");
}

std::string variables_text(const breve_class& c) {
  if (c.variable_count == 0) return {};
  need(c.variables, "breve_class.variables");
  std::string text = "  + variables:\n";
  for (std::size_t i = 0; i < c.variable_count; ++i) {
    const breve_variable& v = c.variables[i];
    const std::string what = "variable " + std::to_string(i + 1) + " of class '" + c.name + "'";
    check_word(v.name, what);
    if (v.type == BREVE_TYPE_NULL || v.reserved != 0)
      fail(BREVE_ERROR_ARGUMENT, what + " has no type, or a reserved field that is not 0");
    text += std::string("    ") + v.name + ' ' + type_text(v.type, what) + ".\n";
  }
  return text;
}

}  // namespace

HostClass::HostClass(const breve_class& c) : bind_(c.bind), unbind_(c.unbind), places_(c.places), user_(c.user) {
  check_word(c.name, "the name of the class");
  check_word(c.parent, "the parent of class '" + std::string(c.name) + "'");
  if (c.alias) check_word(c.alias, "the alias of class '" + std::string(c.name) + "'");
  name_ = c.name;
  alias_ = c.alias ? c.alias : "";
  if (c.module_count != 0) need(c.modules, "breve_class.modules");
  for (std::size_t i = 0; i < c.module_count; ++i) {
    need(c.modules[i], "one of breve_class.modules");
    modules_.emplace_back(c.modules[i]);
  }
  describe(c);
  if (const std::string fault = steve::fault_of_foreign_class(text_); !fault.empty())
    fail(BREVE_ERROR_ARGUMENT, "class '" + name_ + "': " + fault);
}

void HostClass::describe(const breve_class& c) {
  text_ = comment(c.doc, "") + c.parent + std::string(" : ") + name_;
  if (c.alias) text_ += " (aka " + alias_ + ")";
  text_ += " {\n" + variables_text(c);
  if (c.method_count != 0) need(c.methods, "breve_class.methods");
  for (std::size_t i = 0; i < c.method_count; ++i) {
    check_word(c.methods[i].name, "method " + std::to_string(i + 1) + " of class '" + name_ + "'");
    std::string signature;
    text_ += method_text(c, i, signature);
    methods_.push_back(std::make_unique<HostMethod>(*this, name_, c.methods[i], std::move(signature),
                                                    c.method_places ? &c.method_places[i] : nullptr));
  }
  text_ += "}\n";
  check_twice(c);
}

std::vector<steve::ForeignPlace> HostClass::places(const breve_call& call) const {
  constexpr std::size_t kMost = 32;
  if (!places_) return {};
  std::array<breve_place, kMost> places{};
  const std::size_t count = std::min(places_(user_, &call, places.data(), kMost), kMost);
  std::vector<steve::ForeignPlace> result;
  for (std::size_t i = 0; i < count; ++i) {
    const auto text = [](const char* t) { return std::string(t ? t : ""); };
    result.push_back({text(places[i].function), text(places[i].file), places[i].line});
  }
  return result;
}

std::vector<steve::ForeignPlace> places_of(const breve_world& world, std::size_t depth) {
  for (const ActiveCall* active = world.active; active; active = active->outer)
    if (active->depth == depth) return active->cls->places(*active->call);
  return world.failed_depth == depth ? world.failed_places : std::vector<steve::ForeignPlace>();
}

Binding::~Binding() {
  if (bound) cls->unbind(data);
}

void bind_classes(breve_world& world, const steve::Program& program) {
  const std::size_t before = world.bindings.size();
  try {
    for (const auto& given : program.foreign_classes()) {
      const auto cls = std::static_pointer_cast<const HostClass>(given);
      const auto bound = [&](const auto& b) { return b->cls == cls; };
      if (std::any_of(world.bindings.begin(), world.bindings.end(), bound)) continue;
      auto& binding = *world.bindings.emplace_back(std::make_unique<Binding>(cls));
      Answer reason;
      const CallbackScope busy(world);
      const breve_status status = cls->bind(world, binding.data, reason);
      if (status != BREVE_OK) {
        const std::string text = without_zeros(reason.text());
        fail(status, text.empty() ? "class " + cls->name() + ": " + breve_status_name(status) : text);
      }
      binding.bound = true;
    }
  } catch (...) {
    while (world.bindings.size() > before) world.bindings.pop_back();
    throw;
  }
}

void unbind_others(breve_world& world) {
  const auto& used = world.program->foreign_classes();
  const auto is_used = [&](const auto& binding) {
    return std::any_of(used.begin(), used.end(), [&](const auto& cls) { return cls == binding->cls; });
  };
  for (std::size_t i = world.bindings.size(); i-- > 0;)
    if (!is_used(world.bindings[i])) world.bindings.erase(world.bindings.begin() + static_cast<std::ptrdiff_t>(i));
}

}  // namespace breve::host

using namespace breve::host;

breve_status breve_runtime_add_class(breve_runtime* runtime, const breve_class* description) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(description, "description");
    const auto c = read_config(description, breve_class_default(), "breve_class");
    const AddingScope adding(*runtime);
    auto made = std::make_shared<HostClass>(c);
    if (runtime->loading) made->keep(runtime->loading->library);
    auto& classes = runtime->loading ? runtime->loading->classes : runtime->classes;
    const auto old =
        std::find_if(classes.begin(), classes.end(), [&](const auto& other) { return made->same_name(*other); });
    if (old != classes.end())
      *old = made;
    else
      classes.push_back(made);
    made->own(c.destroy);  // nothing fails any more
  });
}

namespace {

using breve::steve::ClassInfo;
using breve::steve::MethodInfo;

/// Those that objects of the class answer to: of one name and number of parameters, the most derived.
std::vector<const MethodInfo*> methods_of(const ClassInfo& cls) {
  std::vector<const MethodInfo*> all;
  for (const ClassInfo* c = &cls; c; c = c->parent)
    for (const auto& method : c->methods)
      if (cls.find_method(method->name, method->parameters.size()) == method.get()) all.push_back(method.get());
  return all;
}

}  // namespace

breve_status breve_world_methods(breve_world* world, const char* class_name, breve_method_info* methods,
                                 size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(count, "count");
    if (capacity != 0) need(methods, "methods");
    const auto all = methods_of(class_named(*world, class_name));
    const auto& symbols = world->program->symbols();
    const std::size_t told = std::min(all.size(), capacity);
    std::size_t keywords = 0;
    for (std::size_t i = 0; i < told; ++i) keywords += all[i]->parameters.size();
    world->method_keywords.resize(keywords);
    world->method_types.resize(keywords);
    world->method_defaults = std::make_unique<bool[]>(keywords);
    std::size_t at = 0;
    for (std::size_t i = 0; i < told; ++i) {
      const MethodInfo& m = *all[i];
      methods[i] = {m.owner->name.c_str(),
                    symbols.name(m.name).c_str(),
                    m.parameters.size(),
                    world->method_keywords.data() + at,
                    world->method_types.data() + at,
                    world->method_defaults.get() + at};
      for (const auto& p : m.parameters) {
        world->method_keywords[at] = symbols.name(p.keyword).c_str();
        world->method_types[at] = p.type == breve::steve::StaticType::Any ? std::uint32_t{BREVE_TYPE_NULL}
                                                                          : static_cast<std::uint32_t>(p.type);
        world->method_defaults[at++] = p.has_default;
      }
    }
    *count = all.size();
  });
}

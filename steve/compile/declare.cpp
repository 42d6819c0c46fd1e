// Classes from tree to ClassInfo: parents, variables and their slots, methods and their parameters, natives.
#include <algorithm>
#include <set>

#include "steve/code/numbers.hpp"
#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"

namespace breve::steve {

namespace {

constexpr std::uint32_t kDeepestClass = 256;  // each class has the tables of all its ancestors

char letter_of(StaticType type) {
  static constexpr char kLetters[] = "nidvmsolhpba";
  return kLetters[static_cast<int>(type)];
}

std::string number_text(double d) {
  std::string text;
  append_double(text, d);
  return text;
}

}  // namespace

/// The class that a new one is derived from; null for Object itself. `Bird : Mobile` where `Mobile : Bird` is meant is
/// reported, and reversed.
const ClassInfo* ProgramBuilder::parent_of(ast::Class& tree) {
  if (tree.parent == "NULL") return nullptr;
  if (const ClassInfo* parent = class_named(tree.parent)) return parent;
  // The one that is known is the parent.
  const ClassInfo* known = class_named(tree.name);
  if (known) {
    diagnostics_.error(tree.parent_span, "class-header", "the parent comes before the ':', the new class after it",
                       "write: " + tree.name + " : " + tree.parent + " {");
    std::swap(tree.name, tree.parent);
    return known;
  }
  const auto near = near_class(tree.parent);
  const bool of_host = program_->sources().file(tree.parent_span.file).name == "host:" + tree.name;
  const std::string help =
      !near.empty() ? "did you mean '" + near + "'?"
      : of_host ? "add '" + tree.parent + "' to the runtime, or name the file that defines it in breve_class.modules"
                : "a parent must be defined before its children";
  diagnostics_.error(tree.parent_span, "unknown-class", "unknown parent class '" + tree.parent + "'", help);
  return class_named("Object");
}

void ProgramBuilder::declare(ast::Class tree) {
  const auto clash = [&](const std::string& name, const Span& span) {
    if (name.empty()) return false;
    const auto* other = program_->find_class(name);
    if (!other) return false;
    diagnostics_.error(span, "redefinition", "class '" + name + "' is defined twice",
                       embedded(other->span)
                           ? "the class library has a class of that name; choose another"
                           : "the other one is in " + program_->sources().file(other->span.file).name + ", line " +
                                 std::to_string(other->span.line) + "; choose another name");
    return true;
  };
  const ClassInfo* parent = parent_of(tree);
  if (clash(tree.name, tree.name_span) || clash(tree.alias, tree.alias_span)) return;
  auto owned = std::make_unique<ClassInfo>();
  auto& info = *owned;
  info.id = static_cast<ClassId>(program_->classes_.size());
  info.name = tree.name;
  info.alias = tree.alias;
  info.doc = tree.doc;
  info.parent = parent;
  info.depth = parent ? parent->depth + 1 : 0;
  if (info.depth > kDeepestClass) {
    diagnostics_.error(tree.name_span, "too-deep",
                       "class " + tree.name + " has more than " + std::to_string(kDeepestClass) + " ancestors",
                       "derive it from a class that is closer to Object");
    info.parent = class_named("Object");
    info.depth = 1;
  }
  info.version = tree.version;
  info.span = tree.name_span;
  program_->class_names_[info.name] = &info;
  if (!info.alias.empty()) program_->class_names_[info.alias] = &info;
  program_->classes_.push_back(std::move(owned));
  declare_variables(tree, info);
  declare_methods(tree, info);
  declared_.push_back({std::move(tree), &info});
}

void ProgramBuilder::declare_variables(const ast::Class& tree, ClassInfo& info) {
  std::uint64_t slot = 0;
  if (info.parent) {
    slot = info.parent->slot_count;
    info.reference_slots = info.parent->reference_slots;
  }
  std::set<std::string> names;
  for (const auto& v : tree.variables) {
    if (!names.insert(v.name).second) {
      diagnostics_.error(v.span, "redefinition", "variable '" + v.name + "' is declared twice in class " + tree.name,
                         "remove one of the two");
      continue;
    }
    VariableInfo variable;
    variable.name = symbol(v.name);
    variable.type = static_type(v.type.kind);
    variable.array_size = v.type.broken ? kBrokenType : v.type.array_size;
    if (!v.type.class_name.empty()) variable.class_name = symbol(v.type.class_name);
    variable.slot = static_cast<std::uint32_t>(slot);
    variable.span = v.span;
    const auto count = v.type.array_size >= 0 ? static_cast<std::uint64_t>(v.type.array_size) : 1;
    const auto size = static_cast<std::uint64_t>(slot_count(variable.type));
    if (slot + count * size > 0xffff) {
      diagnostics_.error(v.span, "class-too-large",
                         "the variables of class " + tree.name + " need more than 65,535 slots",
                         "keep large arrays in lists");
      continue;
    }
    if (variable.type >= StaticType::String && variable.type <= StaticType::Data)
      for (std::uint64_t i = 0; i < count; ++i) info.reference_slots.push_back(static_cast<std::uint16_t>(slot + i));
    slot += count * size;
    info.add_variable(variable);
  }
  info.slot_count = static_cast<std::uint32_t>(slot);
}

void ProgramBuilder::declare_methods(const ast::Class& tree, ClassInfo& info) {
  for (const auto& m : tree.methods) {
    auto method = std::make_unique<MethodInfo>();
    method->name = symbol(m.name);
    method->owner = &info;
    method->doc = m.doc;
    method->span = m.name_span;
    std::set<std::string> variables;
    for (const auto& p : m.parameters) declare_parameter(p, *method, variables);
    const auto foreign = foreign_bases_.find(tree.name);
    if (m.native && foreign != foreign_bases_.end()) {
      bind_foreign(m, *method, foreign->second);
      adopt_keywords(*method, info);
    }
    if (info.own_method(method->name, method->parameters.size()))
      diagnostics_.error(m.name_span, "redefinition",
                         "class " + tree.name + " defines method '" + m.name + "' with " +
                             std::to_string(m.parameters.size()) +
                             (m.parameters.size() == 1 ? " parameter twice" : " parameters twice"),
                         "give one of them another name or a different number of parameters");
    for (const auto& p : m.parameters) checked_.push_back(p.type);
    if (m.native && !method->foreign)
      bind_native(m, *method);
    else if (!m.native)
      method->function = std::make_unique<Function>();
    info.add_method(std::move(method));
  }
}

void ProgramBuilder::declare_parameter(const ast::Parameter& tree, MethodInfo& method,
                                       std::set<std::string>& variables) {
  if (!variables.insert(tree.variable).second)
    diagnostics_.error(tree.variable_span, "redefinition", "parameter '" + tree.variable + "' is declared twice",
                       "rename one of the two");
  ParameterInfo p;
  p.keyword = symbol(tree.keyword);
  p.variable = symbol(tree.variable);
  p.type = tree.type.dynamic ? StaticType::Any : static_type(tree.type.kind);
  if (!tree.type.class_name.empty()) p.class_name = symbol(tree.type.class_name);
  if (tree.type.array_size >= 0)
    diagnostics_.error(tree.type.span, "array-parameter",
                       "an array cannot be passed: parameter '" + tree.variable + "'", "pass a list");
  if (tree.default_value) {
    p.has_default = true;
    const auto number = [&](double d) {
      if (p.type == StaticType::Int)
        p.default_numbers[0] = truncate_to_int(d);
      else if (p.type == StaticType::Double)
        p.default_numbers[0] = d;
      else if (p.type == StaticType::String)
        p.default_string = string_number(number_text(d)) + 1;
      else if ((p.type == StaticType::Object || p.type == StaticType::Pointer) && d == 0)
        return;
      else
        p.default_fails = true;
    };
    const auto& value = tree.default_value->value;
    if (const auto* i = std::get_if<std::int32_t>(&value)) {
      number(*i);
    } else if (const auto* d = std::get_if<double>(&value)) {
      number(*d);
    } else if (const auto* s = std::get_if<std::string>(&value)) {
      if (p.type == StaticType::String)
        p.default_string = s->empty() ? 0 : string_number(*s) + 1;
      else if (p.type == StaticType::Int)
        p.default_numbers[0] = leading_int(*s);
      else if (p.type == StaticType::Double)
        p.default_numbers[0] = leading_double(*s);
      else
        p.default_fails = true;
    } else if (const auto* v = std::get_if<std::array<double, 3>>(&value)) {
      if (p.type == StaticType::Vector)
        std::copy(v->begin(), v->end(), p.default_numbers.begin());
      else
        p.default_fails = true;
    } else if (const auto* m = std::get_if<std::array<double, 9>>(&value)) {
      if (p.type == StaticType::Matrix)
        p.default_numbers = *m;
      else
        p.default_fails = true;
    }
  }
  method.parameters.push_back(p);
}

StaticType ProgramBuilder::result_of_native(const ast::Method& tree) {
  if (tree.native_dynamic) return StaticType::Any;
  return tree.native_result ? static_type(tree.native_result->kind) : StaticType::Null;
}

void ProgramBuilder::bind_native(const ast::Method& tree, MethodInfo& method) {
  const auto at = natives_.find(*tree.native);
  std::string wanted;
  std::uint32_t slot = 0;
  for (auto& p : method.parameters) {
    wanted += letter_of(p.type);
    p.slot = slot;
    slot += static_cast<std::uint32_t>(slot_count(p.type));
  }
  wanted += ':';
  wanted += tree.native_dynamic ? 'a' : tree.native_result ? letter_of(static_type(tree.native_result->kind)) : 'n';
  if (at == natives_.end()) {
    diagnostics_.error(tree.name_span, "native", "no native method is called '" + *tree.native + "'");
    return;
  }
  if (at->second->signature != wanted) {
    diagnostics_.error(tree.name_span, "native",
                       "native '" + *tree.native + "' has the signature " + std::string(at->second->signature) +
                           ", but is declared as " + wanted);
    return;
  }
  method.native = at->second->function;
  method.native_result = result_of_native(tree);
}

void ProgramBuilder::compile_methods() {
  // Compiling and checking may load further classes of the library: the lists grow while they are worked through.
  for (std::size_t i = 0; i < checked_.size(); ++i) {
    const ast::TypeRef type = checked_[i];
    checked_class(type);
  }
  for (; compiled_ < declared_.size(); ++compiled_) {
    const auto index = compiled_;
    std::size_t n = 0;
    for (std::size_t m = 0; m < declared_[index].tree.methods.size() && n < declared_[index].info->methods.size();
         ++m, ++n) {
      auto& info = *declared_[index].info;
      auto& method = *info.methods[n];
      if (!method.function || method.foreign) continue;
      FunctionCompiler(*this, info, declared_[index].tree.methods[m], method).compile();
    }
    for (const auto& v : declared_[index].tree.variables) checked_class(v.type);
  }
  for (const auto& cls : program_->classes_) finish_class(*cls);
}

Symbol ProgramBuilder::checked_class(const ast::TypeRef& type) {
  if (type.class_name.empty()) return kNoSymbol;
  if (!class_named(type.class_name) && !embedded(type.span))
    report_unknown_class(type.class_name, type.span, Severity::Error);
  return symbol(type.class_name);
}

void ProgramBuilder::finish_class(ClassInfo& info) {
  const auto init = symbol("init"), remove = symbol("delete");
  std::vector<const ClassInfo*> line;
  for (const ClassInfo* c = &info; c; c = c->parent) line.push_back(c);
  std::reverse(line.begin(), line.end());
  for (const auto* c : line)
    for (const auto& method : c->methods) {
      if (!method->parameters.empty()) continue;
      if (method->name == init) info.init_chain.push_back(method.get());
      if (method->name == remove) info.delete_chain.push_back(method.get());
    }
  info.iterate = info.find_method(symbol("iterate"), 0);
  info.post_iterate = info.find_method(symbol("post-iterate"), 0);
  info.destroy = info.find_method(symbol("destroy"), 0);
  info.get_description = info.find_method(symbol("get-description"), 0);
}

}  // namespace breve::steve

// Classes that the host gives: taken in when a program names them, by a text of their own, which is read as a file of
// the class library is. A method of one is a function of two instructions: the call of the host, and the return of what
// it gave; so it is called, overridden and traced as any other.
#include <algorithm>

#include "steve/compile/builder.hpp"

namespace breve::steve {

const ForeignClass* ProgramBuilder::foreign_class(std::string_view name) const {
  for (const auto& cls : foreign_given_)
    if (cls->name() == name || (!name.empty() && cls->alias() == name)) return cls.get();
  return nullptr;
}

/// @param directive  where the program names it, for errors; null: as an expression or a parent
bool ProgramBuilder::load_foreign_class(std::string_view name, const ast::Directive* directive,
                                        const std::string& from) {
  const auto given = std::find_if(foreign_given_.begin(), foreign_given_.end(),
                                  [&](const auto& cls) { return cls.get() == foreign_class(name); });
  if (given == foreign_given_.end()) return false;
  const auto cls = *given;  // a module that it loads may name a plugin, with more classes
  const std::string key = "host:" + cls->name();
  if (program_->find_class(cls->name()) || !loaded_.insert(key).second) return true;
  const ast::Directive unknown{ast::Directive::Kind::Include, {}, {}, {}, 0, {}};
  for (const auto& module : cls->modules()) load_named(module, directive ? *directive : unknown, from, false);
  foreign_bases_[cls->name()] = program_->foreign_.size();
  for (const auto& method : cls->methods()) program_->foreign_.emplace_back(cls, method.get());
  load({key, cls->text()}, true);
  program_->foreign_classes_.push_back(cls);
  return true;
}

/// @param first  number of the class's first method in the program
void ProgramBuilder::bind_foreign(const ast::Method& tree, MethodInfo& method, std::size_t first) {
  const std::size_t number = first + std::stoul(*tree.native);
  method.foreign = static_cast<const ForeignMethod*>(program_->foreign_[number].get());
  method.native_result = result_of_native(tree);
  auto function = std::make_unique<Function>();
  std::uint32_t slot = 0;
  for (auto& p : method.parameters) {
    p.slot = slot;
    if (p.type == StaticType::Any)
      function->any_slots.push_back(static_cast<std::uint16_t>(slot));
    else if (p.type >= StaticType::String)
      function->reference_slots.push_back(static_cast<std::uint16_t>(slot));
    slot += static_cast<std::uint32_t>(slot_count(p.type));
  }
  function->parameter_slots = function->zeroed_slots = function->frame_slots = slot;
  Instruction call{Op::Foreign, 0, 0, 0};
  call.set_imm(static_cast<std::int32_t>(number));
  function->code = {call, {Op::ReturnResult, 0, 0, 0}};
  function->spans.assign(function->code.size(), tree.name_span);
  method.function = std::move(function);
}

/// Callers know the keywords of the method that this one overrides. Those that both have, in another order, stay.
void ProgramBuilder::adopt_keywords(MethodInfo& method, const ClassInfo& cls) {
  if (!method.foreign->adopts_keywords() || !cls.parent) return;
  const MethodInfo* overridden = cls.parent->find_method(method.name, method.parameters.size());
  if (!overridden) return;
  const auto& theirs = overridden->parameters;
  const bool same = std::all_of(method.parameters.begin(), method.parameters.end(), [&](const auto& p) {
    return std::any_of(theirs.begin(), theirs.end(), [&](const auto& t) { return t.keyword == p.keyword; });
  });
  if (same) return;
  for (std::size_t i = 0; i < theirs.size(); ++i) method.parameters[i].keyword = theirs[i].keyword;
}

std::string fault_of_foreign_class(const std::string& text) {
  Sources sources;
  Diagnostics diagnostics;
  Defines defines;
  const auto file = sources.add("class", text, true);
  const auto tree = parse(lex(sources, file, diagnostics), defines, diagnostics, sources, true);
  if (diagnostics.error_count() == 0 && tree.classes.size() == 1) return {};
  return diagnostics.all().empty() ? "the class cannot be read" : diagnostics.all().front().message;
}

}  // namespace breve::steve

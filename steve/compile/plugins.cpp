// Plugins of a program: what they add is known from their directive on, to all of the program's methods.
#include "steve/compile/builder.hpp"

namespace breve::steve {

PluginParts ModuleResolver::load_plugin(const std::string&, const std::string&, const std::string&) {
  return {
      {}, {}, "the host does not allow plugins", "remove the line; a host can provide functions in place of a plugin"};
}

std::string ProgramBuilder::taken_name(const PluginParts& parts) const {
  for (const auto& function : parts.functions)
    if (function_exists(function->name())) return "function '" + function->name() + "'";
  for (const auto& cls : parts.classes)
    for (const std::string& name : {cls->name(), cls->alias()})
      if (!name.empty() && (foreign_class(name) || program_->find_class(name))) return "class '" + name + "'";
  return {};
}

void ProgramBuilder::load_plugin(const ast::Directive& directive, const std::string& from) {
  if (!plugins_.emplace(directive.text, directive.entry).second) return;
  PluginParts parts = resolver_.load_plugin(directive.text, directive.entry, from);
  const std::string plugin = "cannot load plugin '" + directive.text + "': ";
  if (!parts.fault.empty()) {
    diagnostics_.error(directive.span, "plugin", plugin + parts.fault, parts.help);
    return;
  }
  if (const std::string name = taken_name(parts); !name.empty()) {
    diagnostics_.error(directive.span, "plugin", plugin + "the program has another " + name,
                       "two plugins, or a plugin and the host, cannot define the same name");
    return;
  }
  program_->foreign_.insert(program_->foreign_.end(), parts.functions.begin(), parts.functions.end());
  foreign_given_.insert(foreign_given_.end(), parts.classes.begin(), parts.classes.end());
  renew_function_table();
}

}  // namespace breve::steve

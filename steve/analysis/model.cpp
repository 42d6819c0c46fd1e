// Reading a program for analysis: compiled once for what the compiler says, parsed again for its trees, which the
// compiler does not keep. Then the modules of the class library that the program does not use, so that they are known.
#include "steve/analysis/model.hpp"

#include <algorithm>

#include "steve/library/library.hpp"

namespace breve::steve {

namespace {

void parse_file(Model& model, std::uint32_t number) {
  Diagnostics unheard;  // the compiler has reported them
  FileModel& file = model.files[number];
  if (file.tokens.empty()) file.tokens = lex(model.sources, number, unheard);
  file.tree = parse(file.tokens, model.defines, unheard, model.sources, model.sources.file(number).embedded);
}

}  // namespace

Model read_model(ModuleSource main, ModuleResolver& resolver, const AllowedLints& allowed,
                 const ForeignFunctions& foreign, const ForeignClasses& classes) {
  Model model;
  CompileResult result = compile(std::move(main), resolver, library_source(), allowed, foreign, classes);
  model.foreign = foreign;
  model.sources = std::move(result.sources);
  model.diagnostics = result.diagnostics.all();
  const std::size_t loaded = model.sources.size();
  for (const LibraryFile& file : library_files()) {
    const std::string name = "library:" + std::string(file.name);
    bool known = false;
    for (std::uint32_t i = 0; i < loaded && !known; ++i) known = model.sources.file(i).name == name;
    if (!known) model.sources.add(name, std::string(file.text), true);
  }
  model.files.resize(model.sources.size());
  for (std::uint32_t i = 0; i < model.files.size(); ++i) {
    model.files[i].loaded = i < loaded;
    parse_file(model, i);
  }
  // A file may use the constants of one that stands behind it in this list: again, now that all are known.
  if (!model.defines.seen().empty()) {
    for (std::uint32_t i = 0; i < loaded; ++i)
      if (!model.sources.file(i).embedded) parse_file(model, i);
  }
  make_symbols(model);
  guess_types(model);
  return model;
}

std::size_t Model::class_named(std::string_view name) const {
  const auto found = class_names.find(name);
  return found == class_names.end() ? kNoIndex : found->second;
}

std::vector<std::size_t> Model::line(std::size_t cls) const {
  std::vector<std::size_t> result;
  for (; cls != kNoIndex && std::find(result.begin(), result.end(), cls) == result.end(); cls = classes[cls].parent)
    result.push_back(cls);
  return result;
}

bool Model::derives_from(std::size_t cls, std::size_t ancestor) const {
  const std::vector<std::size_t> ancestors = line(cls);
  return std::find(ancestors.begin(), ancestors.end(), ancestor) != ancestors.end();
}

std::size_t Model::find_member(std::size_t cls, std::string_view name) const {
  for (const std::size_t c : line(cls)) {
    const ClassModel& model = classes[c];
    for (std::size_t i = 0; i < model.tree->variables.size(); ++i)
      if (model.tree->variables[i].name == name) return model.variables + i;
  }
  return kNoIndex;
}

std::size_t Model::find_variable(std::size_t cls, const MethodModel* method, std::string_view name) const {
  if (method != nullptr) {
    const std::vector<ast::Parameter>& parameters = method->tree->parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (parameters[i].variable == name) return method->parameters + 2 * i + 1;
    const std::vector<ast::Variable>& locals = method->tree->locals;
    for (std::size_t i = 0; i < locals.size(); ++i)
      if (locals[i].name == name) return method->locals + i;
  }
  return find_member(cls, name);
}

}  // namespace breve::steve

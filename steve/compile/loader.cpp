// Loads a program's files: directives before the text of the file that holds them, each file once, the class library
// when it is named.
#include <fmt/format.h>

#include <algorithm>

#include "runtime/base/hasher.hpp"
#include "steve/compile/builder.hpp"

namespace breve::steve {

namespace {
constexpr int kMaxIncludeDepth = 100;

std::string stem(std::string_view name) {
  if (const auto slash = name.rfind('/'); slash != std::string_view::npos) name.remove_prefix(slash + 1);
  if (name.ends_with(".tz")) name.remove_suffix(3);
  return std::string(name);
}
}  // namespace

ProgramBuilder::ProgramBuilder(ModuleResolver& resolver, const LibrarySource& library, const ForeignFunctions& foreign,
                               const ForeignClasses& classes)
    : CompileScope(std::shared_ptr<Program>(new Program(library)), function_table(library, foreign)),
      resolver_(resolver),
      library_(library),
      foreign_given_(classes) {
  program_->foreign_ = foreign;
  for (const auto& native : library.natives) natives_.emplace(native.name, &native);
}

CompileResult ProgramBuilder::build(ModuleSource main, const AllowedLints& allowed) {
  loaded_.insert(main.name);
  load(std::move(main), false);
  // A class that only the directive names is loaded now, so that its methods are compiled with the others.
  if (!controller_name_.empty()) class_named(controller_name_);
  compile_methods();
  check_versions();
  choose_controller();
  if (diagnostics_.error_count() == 0) {
    check_calls();
    check_sums();
    check_unused_variables();
    check_iterate();
    check_special_methods();
    check_overrides();
    check_implicit_returns();
  }
  Hasher hasher;
  for (std::uint32_t i = 0; i < program_->sources_.size(); ++i) {
    hasher.add(program_->sources_.file(i).name);
    hasher.add(program_->sources_.file(i).text);
  }
  program_->fingerprint_ = hasher.value();
  gather_foreign_library();
  diagnostics_ = finished(diagnostics_, program_->sources_, allowed);
  program_->diagnostics_ = diagnostics_.all();
  CompileResult result;
  result.diagnostics = diagnostics_;
  result.sources = program_->sources_;
  if (diagnostics_.error_count() == 0) result.program = program_;
  return result;
}

void ProgramBuilder::load(ModuleSource module, bool embedded) {
  if (depth_ >= kMaxIncludeDepth) {
    diagnostics_.error({}, "include-depth",
                       "files include one another more than " + std::to_string(kMaxIncludeDepth) + " deep",
                       "include fewer files from one another");
    return;
  }
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  constexpr std::string_view kTooLarge = "read large data from files while the program runs";
  bytes_ += embedded ? 0 : module.text.size();
  if (bytes_ > kMostBytes) {
    diagnostics_.error({}, "program-too-large",
                       "the files of the program have more than 64 MB together, with '" + module.name + "'",
                       std::string(kTooLarge));
    return;
  }
  ++depth_;
  const auto name = module.name;
  const auto file = program_->sources_.add(std::move(module.name), std::move(module.text), embedded);
  const auto tokens = lex(program_->sources_, file, diagnostics_);
  tokens_ += embedded ? 0 : tokens.size();
  if (tokens_ > kMaxTokens + 1) {
    diagnostics_.error({file, 0, 1, 1, 1}, "program-too-large",
                       fmt::format("the files of the program have more than {} tokens together", kMaxTokens),
                       std::string(kTooLarge));
    --depth_;
    return;
  }
  for (const auto& directive : scan_directives(tokens)) load_directive(directive, name, embedded);
  auto tree = parse(tokens, program_->defines_, diagnostics_, program_->sources_, embedded);
  for (const auto& directive : tree.directives) late_directive(directive);
  for (auto& cls : tree.classes) declare(std::move(cls));
  --depth_;
}

void ProgramBuilder::load_directive(const ast::Directive& directive, const std::string& from, bool embedded) {
  using enum ast::Directive::Kind;
  switch (directive.kind) {
    case Path: resolver_.add_path(directive.text); break;
    case Include: load_named(directive.text, directive, from, embedded); break;
    case Use: load_named(directive.text + ".tz", directive, from, embedded); break;
    case Plugin: load_plugin(directive, from); break;
    default: break;
  }
}

void ProgramBuilder::load_named(const std::string& name, const ast::Directive& directive, const std::string& from,
                                bool embedded) {
  const auto wanted = stem(name);
  if (directive.kind == ast::Directive::Kind::Use && load_foreign_class(wanted, &directive, from)) return;
  if (!embedded) {
    if (auto module = resolver_.resolve(name, from)) {
      if (loaded_.insert(module->name).second) load(std::move(*module), false);
      return;
    }
  }
  if (load_library(wanted)) return;
  const bool use = directive.kind == ast::Directive::Kind::Use;
  const auto near = near_class(wanted);
  const std::string help = near.empty() ? "check its spelling, or add the directory it is in with @path or --path"
                                        : "did you mean '" + near + "' of the class library?";
  if (use)
    diagnostics_.error(
        directive.span, "file-not-found",
        "cannot find '" + wanted + "': there is no file '" + name + "', and no such class in the library", help);
  else
    diagnostics_.error(directive.span, "file-not-found", "cannot find the file '" + name + "'", help);
}

bool ProgramBuilder::load_library(std::string_view name) {
  const auto* file = library_.find_file(name);
  if (!file) return false;
  const auto key = "library:" + std::string(file->name);
  if (loaded_.insert(key).second) load({key, std::string(file->text)}, true);
  return true;
}

void ProgramBuilder::late_directive(const ast::Directive& directive) {
  using enum ast::Directive::Kind;
  switch (directive.kind) {
    case Controller:
      if (!controller_name_.empty()) {
        diagnostics_.error(directive.span, "second-controller",
                           "the controller is chosen twice: '" + controller_name_ + "' and '" + directive.text + "'",
                           "keep one Controller line");
        break;
      }
      controller_name_ = directive.text;
      controller_span_ = directive.span;
      break;
    case Use:
      if (!directive.version_op.empty()) versions_.push_back(directive);
      break;
    case NibFile:
      lint(directive.span, "lint-nib-file", "the interface file '" + directive.text + "' is ignored",
           "remove the line");
      break;
    default: break;
  }
}

const ClassInfo* ProgramBuilder::class_named(std::string_view name) {
  if (const auto* cls = program_->find_class(name)) return cls;
  if (load_foreign_class(name, nullptr, {})) return program_->find_class(name);
  const auto* file = library_.find_file(name);
  if (!file || !file->defines(name)) return nullptr;
  load_library(name);
  return program_->find_class(name);
}

void ProgramBuilder::report_unknown_class(std::string_view name, const Span& span, Severity severity) {
  const auto near = near_class(name);
  const auto message = "unknown class '" + std::string(name) + "'";
  const auto help = near.empty() ? "define it, or load its file with @use" : "did you mean '" + near + "'?";
  if (severity == Severity::Error)
    diagnostics_.error(span, "unknown-class", message, help);
  else
    lint(span, "lint-unknown-class", message, help);
}

// The name of a class, of the program or the library, near to this one; "" if none is.
std::string ProgramBuilder::near_class(std::string_view name) const {
  std::vector<std::string_view> names;
  for (const auto& cls : program_->classes_) {
    names.push_back(cls->name);
    if (!cls->alias.empty()) names.push_back(cls->alias);
  }
  for (const auto& cls : foreign_given_) names.push_back(cls->name());
  for (const auto& file : library_.files)
    for (auto rest = file.classes; !rest.empty();) {
      const auto end = std::min(rest.find(' '), rest.size());
      names.push_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  return nearest(name, names);
}

void ProgramBuilder::check_versions() {
  for (const auto& directive : versions_) {
    const auto* cls = program_->find_class(directive.text);
    if (!cls) {
      diagnostics_.error(directive.span, "version",
                         "the file defines no class '" + directive.text + "' whose version could be checked",
                         "leave the version out");
      continue;
    }
    const float have = static_cast<float>(cls->version), want = static_cast<float>(directive.version);
    const auto& op = directive.version_op;
    const bool holds = op == "=="   ? have == want
                       : op == "!=" ? have != want
                       : op == "<"  ? have < want
                       : op == "<=" ? have <= want
                       : op == ">"  ? have > want
                                    : have >= want;
    if (!holds)
      diagnostics_.error(directive.span, "version",
                         "class " + cls->name + " has version " + fmt::format("{:g}", cls->version) + ", but " + op +
                             " " + fmt::format("{:g}", directive.version) + " is required",
                         "load another version of the file, or change what is required");
  }
}

void ProgramBuilder::choose_controller() {
  if (controller_name_.empty()) {
    if (diagnostics_.error_count() != 0) return;
    std::string name = "NAME";  // the one class that can be meant, if there is one
    const auto* control = program_->find_class("Control");
    for (const auto& cls : program_->classes_)
      if (control && cls->parent && cls->derives_from(*control) && !embedded(cls->span))
        name = name == "NAME" ? cls->name : "CLASS";
    diagnostics_.error({0, 0, 0, 1, 1}, "missing-controller", "the program names no controller",
                       "a program begins with the class that runs it: add a line   Controller " + name + ".");
    return;
  }
  const auto* cls = class_named(controller_name_);
  if (cls)
    program_->controller_ = cls;
  else if (diagnostics_.error_count() == 0)
    diagnostics_.error(controller_span_, "unknown-class",
                       "the controller class '" + controller_name_ + "' is not defined",
                       near_class(controller_name_).empty() ? "define it, or name another class"
                                                            : "did you mean '" + near_class(controller_name_) + "'?");
}

CompileResult compile(ModuleSource main, ModuleResolver& resolver, const LibrarySource& library,
                      const AllowedLints& allowed, const ForeignFunctions& foreign, const ForeignClasses& classes) {
  return ProgramBuilder(resolver, library, foreign, classes).build(std::move(main), allowed);
}

}  // namespace breve::steve

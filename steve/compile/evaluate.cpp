// The tables of a program with room for fragments, and fragments put there.
#include "steve/compile/evaluate.hpp"

#include <algorithm>

#include "steve/compile/function_compiler.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kRoom = 4096;  // entries of each table
constexpr const char* kMethodName = "evaluate";

/// Compiles one fragment against the classes that are there.
class FragmentScope final : public CompileScope {
 public:
  using CompileScope::CompileScope;

  const ClassInfo* class_named(std::string_view name) override { return program_->find_class(name); }

  void report_unknown_class(std::string_view name, const Span& span, Severity) override {
    const auto message = "unknown class '" + std::string(name) + "'";
    if (program_->library().find_file(name)) {
      diagnostics_.error(span, "unknown-class", message,
                         "the class library has it, but this program does not use it: add @use " + std::string(name) +
                             ". to the program");
      return;
    }
    std::vector<std::string_view> names;
    for (const auto& cls : program_->classes()) names.push_back(cls->name);
    const auto near = nearest(name, names);
    diagnostics_.error(span, "unknown-class", message,
                       near.empty() ? "the program defines no such class" : "did you mean '" + near + "'?");
  }
};

/// The help for an unknown name differs here from that in a file.
Diagnostics with_remedies(const Diagnostics& given, const std::vector<std::string_view>& known,
                          const SymbolTable& symbols, const ClassInfo& self, const Sources& sources) {
  Diagnostics out;
  for (auto diagnostic : given.all()) {
    const auto& text = sources.file(diagnostic.span.file).text;
    if (diagnostic.code == "unknown-variable" && diagnostic.help.find("declare") != std::string::npos &&
        diagnostic.span.offset + diagnostic.span.length <= text.size()) {
      const auto name = std::string_view(text).substr(diagnostic.span.offset, diagnostic.span.length);
      auto candidates = known;
      for (const ClassInfo* c = &self; c; c = c->parent)
        for (const auto& v : c->variables) candidates.push_back(symbols.name(v.name));
      const auto near = nearest(name, candidates);
      diagnostic.help =
          near.empty() ? "give it a value first: " + std::string(name) + " = 1." : "did you mean '" + near + "'?";
    }
    out.add(std::move(diagnostic));
  }
  return out;
}

bool gives_value(const ast::Method& tree) {
  if (tree.body.empty()) return false;
  bool gives = std::holds_alternative<ast::ExprStmt>(tree.body.back()->node);
  for (const auto& statement : tree.body)
    walk_statements(*statement,
                    [&](const ast::Stmt& s) { gives = gives || std::holds_alternative<ast::Return>(s.node); });
  return gives;
}

}  // namespace

Fragments::Fragments(const Program& base)
    : program_(new Program(base, kRoom)), functions_(CompileScope::function_table(base.library(), base.foreign())) {
  program_->symbols_.intern(kMethodName);
  program_->symbols_.intern(kSessionVariable);
}

// One that is free, or a new one: however much is evaluated, it is one method for each class and depth.
std::shared_ptr<MethodInfo> Fragments::method_of(const ClassInfo& self) {
  for (const auto& method : program_->fragment_methods_)
    if (method->owner == &self && !method->function) return method;
  auto method = std::make_shared<MethodInfo>();
  method->name = program_->symbols_.find(kMethodName);
  method->owner = &self;
  method->span = self.span;
  method->parameters.emplace_back();
  auto& hash = method->parameters[0];
  hash.keyword = hash.variable = program_->symbols_.find(kSessionVariable);
  hash.type = StaticType::Hash;
  program_->fragment_methods_.push_back(method);
  return method;
}

TableSizes Fragments::sizes() const {
  const auto& code = *program_->code_;
  return {code.strings.size(),        code.texts.size(),         code.sites.size(),        code.members.size(),
          code.interpolations.size(), program_->symbols_.size(), program_->sources_.size()};
}

// Running code may hold on to an entry of a table while a callback evaluates: tables never move, they are replaced.
void Fragments::make_room(std::size_t entries) {
  const auto& code = *program_->code_;
  const auto lacks = [entries](const auto& table) { return table.capacity() - table.size() < entries; };
  if (!lacks(code.strings) && !lacks(code.texts) && !lacks(code.sites) && !lacks(code.members) &&
      !lacks(code.interpolations))
    return;
  std::shared_ptr<Program> larger(new Program(*program_, entries * 2));
  retired_.push_back(program_);
  program_ = std::move(larger);
}

std::unique_ptr<Fragment> Fragments::compile(std::string_view text, const ClassInfo& self,
                                             const std::vector<std::string_view>& known) {
  auto fragment = std::make_unique<Fragment>();
  fragment->before = sizes();
  try {
    const auto file = program_->sources_.add(kSourceName, std::string(text));
    Diagnostics found;
    const auto tokens = lex(program_->sources_, file, found);
    make_room(2 * tokens.size() + 64);  // no construct takes more entries of a table than that
    auto tree = parse_statement(tokens, program_->defines_, found, program_->sources_);
    FragmentScope scope(program_, functions_);
    for (const auto& diagnostic : found.all()) scope.diagnostics().add(diagnostic);
    const auto session = use_session(tree, self, program_->symbols_, known);
    fragment->uses_session = session.used;
    fragment->gives_value = gives_value(tree);
    ast::Parameter hash;
    hash.variable = kSessionVariable;
    hash.type.kind = ast::TypeKind::Hash;
    tree.parameters.push_back(std::move(hash));
    fragment->method = method_of(self);
    fragment->method->function = std::make_unique<Function>();
    // Statements with syntax errors are not compiled: the errors would be reported twice.
    if (scope.diagnostics().error_count() == 0)
      FunctionCompiler(scope, self, tree, *fragment->method, session.loop_variables).compile();
    fragment->diagnostics = with_remedies(scope.diagnostics(), known, program_->symbols_, self, program_->sources_);
  } catch (...) {
    end(*fragment);
    throw;
  }
  return fragment;
}

void Fragments::end(const Fragment& fragment) {
  if (fragment.method) fragment.method->function.reset();
  const auto& to = fragment.before;
  auto& code = *program_->code_;
  code.strings.resize(to.strings);
  code.texts.resize(to.texts);
  code.sites.resize(to.sites);
  code.members.resize(to.members);
  code.interpolations.resize(to.interpolations);
  program_->symbols_.truncate(to.symbols);
  program_->sources_.truncate(to.sources);
}

bool statements_complete(std::string_view text) {
  Sources sources;
  Diagnostics diagnostics;
  const auto file = sources.add(Fragments::kSourceName, std::string(text));
  const auto tokens = lex(sources, file, diagnostics);
  for (const auto& diagnostic : diagnostics.all())
    if (diagnostic.code == "unterminated-string" || diagnostic.code == "unclosed-comment") return false;
  int open = 0;
  const Token* last = nullptr;
  for (const auto& token : tokens) {
    if (token.kind == TokenKind::Doc || token.kind == TokenKind::End) continue;
    last = &token;
    if (token.kind != TokenKind::Punctuation) continue;
    if (token.text == "(" || token.text == "[" || token.text == "{") ++open;
    if (token.text == ")" || token.text == "]" || token.text == "}") --open;
  }
  if (open > 0) return false;
  if (!last) return true;
  if (last->kind == TokenKind::Punctuation && (last->text == "." || last->text == "}")) return true;
  // The parser knows what may follow: a complaint about the very end of the text means that something must.
  Diagnostics complaints;
  parse_statement(tokens, {}, complaints, sources);
  return std::none_of(complaints.all().begin(), complaints.all().end(), [&](const Diagnostic& d) {
    return d.severity == Severity::Error && d.span.offset >= last->span.offset + last->span.length;
  });
}

}  // namespace breve::steve

// From what is expected at a place to the names that fit there, the likeliest first.
#include "steve/analysis/completions.hpp"

#include <algorithm>
#include <set>

#include "steve/analysis/context.hpp"
#include "steve/analysis/types.hpp"
#include "steve/analysis/uses.hpp"
#include "steve/analysis/word_notes.hpp"
#include "steve/library/library.hpp"

namespace breve::steve {

namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool begins_with(std::string_view name, std::string_view typed) {
  return name.size() >= typed.size() &&
         std::equal(typed.begin(), typed.end(), name.begin(), [](char a, char b) { return lower(a) == lower(b); });
}

std::vector<Token> without_docs(const std::vector<Token>& tokens) {
  std::vector<Token> result;
  std::copy_if(tokens.begin(), tokens.end(), std::back_inserter(result),
               [](const Token& token) { return token.kind != TokenKind::Doc; });
  return result;
}

class Completer {
 public:
  Completer(const Model& model, const Sources& sources, std::uint32_t file, const std::vector<Token>& tokens,
            const Scope& scope, std::uint32_t offset, bool body)
      : model_(model),
        sources_(sources),
        tokens_(tokens),
        scope_(scope),
        context_(context_at(sources.file(file).text, tokens, offset, body)) {
    const std::string_view text = sources.file(file).text;
    const std::size_t position = std::min<std::size_t>(offset, text.size());
    typed_ = text.substr(position - context_.typed, context_.typed);
  }

  Completions run() {
    result_.typed = context_.typed;
    switch (context_.expected) {
      case Expected::Nothing: break;
      case Expected::TopLevel:
        notes(top_level_words());
        classes(false);
        break;
      case Expected::Directive: notes(directive_words()); break;
      case Expected::Module: modules(); break;
      case Expected::Class: classes(false); break;
      case Expected::TypeOrOperand:
        types();
        operands();
        break;
      case Expected::Type: types(); break;
      case Expected::ArrayType: notes(array_type_words()); break;
      case Expected::ObjectWord: word("object", "(Name object)"); break;
      case Expected::AkaWord: word("aka", "Parent : Name (aka Names) {"); break;
      case Expected::MemberWord:
        word("to", "+ to NAME keyword variable (type):");
        word("variables", "+ variables:");
        break;
      case Expected::MethodName: overridable(); break;
      case Expected::StatementStart:
        variables();
        notes(statement_words());
        operands();
        break;
      case Expected::Operand: operands(); break;
      case Expected::Selector: selectors(receiver_type(context_.receiver, context_.count)); break;
      case Expected::Keyword: keywords(); break;
      case Expected::Member: members(); break;
      case Expected::StringVariable: variables(); break;
      case Expected::InWord: word("in", "foreach item in list: statement"); break;
      case Expected::OntoWord: word("onto", "push value onto list"); break;
      case Expected::AtWord: word("at", "insert value at list{index}"); break;
      case Expected::WithWord: word("with", "sort list with method"); break;
      case Expected::SortMethod: selectors({ast::TypeKind::Object, scope_.cls}); break;
    }
    return std::move(result_);
  }

  std::optional<CallContext> call() {
    if (!context_.call) return std::nullopt;
    CallContext result;
    for (const MethodIndex& index : methods()) result.methods.push_back(model_.method(index).symbol);
    result.keyword = context_.call->keyword;
    return result;
  }

 private:
  void add(Completion item) {
    if (!begins_with(item.name, typed_) || !seen_.insert(item.name + '\n' + item.detail).second) return;
    result_.items.push_back(std::move(item));
  }

  void add_symbol(std::size_t number) {
    const SymbolInfo& symbol = model_.symbols[number];
    add({symbol.kind, symbol.name, symbol.signature, symbol.owner, symbol.doc, number});
  }

  void word(std::string_view name, std::string_view detail) {
    add({NameKind::Word, std::string(name), std::string(detail), {}, {}, kNoIndex});
  }

  void notes(std::span<const WordNote> words) {
    for (const WordNote& note : words)
      add({note.kind, std::string(note.word), std::string(note.usage), {}, std::string(note.note), kNoIndex});
  }

  // The program's own classes, then those of the library that it uses, then the rest.
  void classes(bool as_types) {
    for (const int rank : {0, 1, 2}) {
      for (const auto& [name, number] : model_.class_names) {
        const ClassModel& cls = model_.classes[number];
        const SymbolInfo& symbol = model_.symbols[cls.symbol];
        if (rank != (symbol.library ? (cls.loaded ? 1 : 2) : 0)) continue;
        const std::string shown = as_types ? name + " object" : name;
        if (!as_types || name == cls.tree->name)
          add({NameKind::Class, shown, symbol.signature, {}, symbol.doc, cls.symbol});
      }
    }
  }

  void types() {
    notes(type_words());
    classes(true);
  }

  void modules() {
    for (const LibraryFile& file : library_files()) {
      const std::string name(file.name.substr(0, file.name.size() - 3));
      const std::size_t cls = model_.class_named(name);
      const std::size_t symbol = cls == kNoIndex ? kNoIndex : model_.classes[cls].symbol;
      add({NameKind::Module,
           name,
           "@use " + name + '.',
           {},
           symbol == kNoIndex ? std::string() : model_.symbols[symbol].doc,
           kNoIndex});
    }
  }

  void variables() {
    if (scope_.method != nullptr) {
      for (std::size_t i = 0; i < scope_.method->tree->locals.size(); ++i) add_symbol(scope_.method->locals + i);
      for (std::size_t i = 0; i < scope_.method->tree->parameters.size(); ++i)
        add_symbol(scope_.method->parameters + 2 * i + 1);
    }
    instance_variables(scope_.cls);
  }

  void instance_variables(std::size_t cls) {
    for (const std::size_t c : model_.line(cls))
      for (std::size_t i = 0; i < model_.classes[c].tree->variables.size(); ++i)
        add_symbol(model_.classes[c].variables + i);
  }

  void operands() {
    variables();
    notes(operand_words());
    for (const auto& [name, symbol] : model_.constants) add_symbol(symbol);
    for (const auto& [name, symbol] : model_.functions) add_symbol(symbol);
  }

  // The type of the expression that tokens [begin, end) are.
  KnownType receiver_type(std::size_t begin, std::size_t end) const {
    std::vector<Token> tokens(tokens_.begin() + static_cast<std::ptrdiff_t>(begin),
                              tokens_.begin() + static_cast<std::ptrdiff_t>(end));
    if (tokens.empty()) return {};
    Token last;
    last.span = tokens.back().span;
    last.span.offset += last.span.length;
    last.span.length = 0;
    tokens.push_back(last);
    Diagnostics unheard;
    const ast::Method read = parse_statement(tokens, model_.defines, unheard, sources_);
    if (read.body.size() != 1 || unheard.error_count() > 0) return {};
    const auto* statement = std::get_if<ast::ExprStmt>(&read.body.front()->node);
    return statement == nullptr ? KnownType() : type_of(model_, scope_, *statement->expr);
  }

  // Methods by class, the receiver's own first; of an unknown receiver all, those of the program first.
  void selectors(const KnownType& receiver) {
    using ast::TypeKind;
    if (receiver.kind && receiver.kind != TypeKind::Object && receiver.kind != TypeKind::List) return;
    if (receiver.cls != kNoIndex) return methods_of(receiver.cls);
    for (const int rank : {0, 1})
      for (const auto& [name, index] : model_.selectors) {
        const ClassModel& cls = model_.classes[index.cls];
        if (cls.loaded && rank == (model_.symbols[cls.symbol].library ? 1 : 0)) add_symbol(model_.method(index).symbol);
      }
  }

  // What a subclass overrides is shown once: the same name with as many keywords.
  void methods_of(std::size_t cls) {
    std::set<std::pair<std::string_view, std::size_t>> shown;
    for (const bool hidden : {false, true})
      for (const std::size_t c : model_.line(cls))
        for (const MethodModel& method : model_.classes[c].methods) {
          if (method.tree->is_public == hidden) continue;
          if (shown.emplace(method.tree->name, method.tree->parameters.size()).second) add_symbol(method.symbol);
        }
  }

  void overridable() {
    notes(special_methods());
    if (scope_.cls != kNoIndex && model_.classes[scope_.cls].parent != kNoIndex)
      methods_of(model_.classes[scope_.cls].parent);
  }

  std::vector<MethodIndex> methods() const {
    const WrittenCall& call = *context_.call;
    const std::string_view selector = tokens_[call.selector].text;
    const KnownType receiver = receiver_type(call.receiver, call.selector);
    std::vector<MethodIndex> found = methods_of_call(model_, receiver, selector, call.keywords);
    if (found.empty()) found = methods_of_call(model_, {}, selector, call.keywords);
    return found;
  }

  void keywords() {
    const std::vector<std::string_view>& given = context_.call->keywords;
    for (const MethodIndex& index : methods()) {
      const MethodModel& method = model_.method(index);
      for (std::size_t i = 0; i < method.tree->parameters.size(); ++i) {
        const bool used = std::find(given.begin(), given.end(), method.tree->parameters[i].keyword) != given.end();
        if (used) continue;
        const std::size_t number = method.parameters + 2 * i;
        const SymbolInfo& symbol = model_.symbols[number];
        const SymbolInfo& owner = model_.symbols[method.symbol];
        add({NameKind::Keyword, symbol.name, symbol.signature, owner.owner, owner.signature, number});
      }
    }
  }

  void members() {
    const KnownType base = receiver_type(context_.receiver, context_.count - 1);
    const bool vector = base.kind == ast::TypeKind::Vector;
    if (vector || !base.kind)
      for (const std::string_view letter : {"x", "y", "z"}) word(letter, "component of a vector (float)");
    if (base.kind == ast::TypeKind::Object) instance_variables(base.cls);
  }

  const Model& model_;
  const Sources& sources_;
  const std::vector<Token>& tokens_;
  Scope scope_;
  Context context_;
  std::string_view typed_;
  Completions result_;
  std::set<std::string> seen_;
};

}  // namespace

Completions complete(const Model& model, std::uint32_t file, std::uint32_t offset) {
  const std::vector<Token> tokens = without_docs(model.files[file].tokens);
  return Completer(model, model.sources, file, tokens, scope_at(model, file, offset), offset, false).run();
}

std::optional<CallContext> find_call(const Model& model, std::uint32_t file, std::uint32_t offset) {
  const std::vector<Token> tokens = without_docs(model.files[file].tokens);
  return Completer(model, model.sources, file, tokens, scope_at(model, file, offset), offset, false).call();
}

Completions complete_statement(const Model& model, std::size_t cls, std::string_view text, std::uint32_t offset) {
  Sources sources;
  Diagnostics unheard;
  const std::uint32_t file = sources.add("statement", std::string(text));
  const std::vector<Token> tokens = without_docs(lex(sources, file, unheard));
  return Completer(model, sources, file, tokens, {cls, nullptr}, offset, true).run();
}

}  // namespace breve::steve

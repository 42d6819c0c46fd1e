// The recursive-descent parser behind parse(). Its parts: parser.cpp (tokens, errors, recovery, entry points),
// declarations.cpp, methods.cpp, statements.cpp, expressions.cpp, primaries.cpp, calls.cpp, strings.cpp.
// Private to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "steve/syntax/parser.hpp"
#include "steve/syntax/words.hpp"

namespace breve::steve {

/// A sign of one or two characters as a number, so that comparing tokens is cheap.
constexpr std::uint16_t sign(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint16_t>(static_cast<unsigned char>(text[i])); };
  return text.size() == 1 ? byte(0) : static_cast<std::uint16_t>(byte(0) | (byte(1) << 8U));
}

/// Thrown to leave a construct that cannot be parsed; caught where parsing can resume.
struct SyntaxError {
  Diagnostic diagnostic;
  bool too_deep = false;  // resume only at the next method
};

class Parser {
 public:
  Parser(const std::vector<Token>& tokens, const Defines& defines, Defines* new_defines, Diagnostics& diagnostics,
         const Sources& sources, bool embedded);
  ast::File file();
  ast::Method interactive();

 private:
  struct Item {
    const Token* token;
    std::uint16_t sign = 0;   // of punctuation
    Word word = Word::None;   // of a reserved name
    bool block_like = false;  // of '{': statements follow, not the items of a list or an index
    bool has_comma = false;   // of '{': a comma stands directly inside
    std::uint32_t match = 0;  // of '{': index of its '}', 0 if none
  };
  struct Doc {
    std::size_t before;  // index of the item that follows
    std::string_view text;
  };
  /// One more level of nesting for as long as it lives.
  class Nest {
   public:
    explicit Nest(Parser& parser);
    Nest(const Nest&) = delete;
    Nest& operator=(const Nest&) = delete;
    ~Nest() { --parser_.depth_; }

   private:
    Parser& parser_;
  };

  // --- tokens (parser.cpp)
  const Item& item(std::size_t ahead = 0) const;
  const Token& token(std::size_t ahead = 0) const { return *item(ahead).token; }
  bool previous_is(std::string_view text) const { return pos_ > 0 && items_[pos_ - 1].sign == sign(text); }
  const Token& previous() const { return *items_[pos_ > 0 ? pos_ - 1 : 0].token; }
  bool at(std::string_view text, std::size_t ahead = 0) const { return item(ahead).sign == sign(text); }
  bool at_word(Word word, std::size_t ahead = 0) const { return item(ahead).word == word; }
  bool at_text(std::string_view name, std::size_t ahead = 0) const;
  bool at_name(std::size_t ahead = 0) const;  // a name that is not a reserved word
  bool at_closing() const;
  bool at_end() const { return token().kind == TokenKind::End; }
  bool at_kind(TokenKind kind, std::size_t ahead = 0) const { return token(ahead).kind == kind; }
  void advance();
  bool accept(std::string_view text);
  void expect(std::string_view text, std::string_view where);
  std::string expect_name(std::string_view what, Span& span);
  bool at_member_header(std::size_t ahead = 0) const;  // `+ to NAME`, `- to NAME`, `= to NAME`
  bool at_run_on_header() const;
  bool at_variables_header(std::size_t ahead = 0) const;
  bool at_class_header(std::size_t ahead = 0) const;

  // methods.cpp
  bool at_type(std::size_t ahead = 0) const;  // "(" and a type

  // parser.cpp
  const ast::Constant* constant_named(std::string_view name) const;
  std::string describe(std::size_t ahead = 0) const;
  Span span_from(std::size_t start) const;
  Span after_previous() const;
  void find_braces();
  bool inside_list(std::size_t i, std::size_t open) const;

  // --- errors (parser.cpp)
  void report(Diagnostic diagnostic);
  void error(const Span& span, std::string code, std::string message, std::string help = {});
  void lint(const Span& span, std::string code, std::string message, std::string help = {});
  [[noreturn]] void fail(const Span& span, std::string code, std::string message, std::string help = {}) const;
  [[noreturn]] void fail_expected(std::string_view what, std::string help = {}) const;
  void missing(std::string_view text, std::string_view where, std::string help = {});

  // habits.cpp
  // --- habits.cpp
  bool adjacent(std::size_t ahead) const;
  std::size_t behind_parentheses(std::size_t ahead) const;
  std::size_t broken_header() const;
  void report_broken_header();
  void header_parentheses(std::string_view name, bool reported);
  bool foreign_declaration();
  bool foreign_statement();
  bool at_elif() const;
  Diagnostic after_statement(std::size_t start);
  std::optional<ast::BinaryOp> foreign_operator(ast::BinaryOp op);
  bool at_c_for() const;
  std::string loop_pattern(std::string_view variable) const;
  void semicolon();

  // --- meant.cpp
  struct FileNames {
    std::set<std::string_view> variables, methods;
    std::set<std::string_view> sized, unsized;  // variables that are lists or strings, and that are not
  };
  const FileNames& names_of_file();
  bool is_variable(const Token& name);
  bool is_variable_only(std::string_view name);  // and no method
  bool is_sized(std::string_view name);          // wherever it is declared
  std::string source_of(std::size_t first, std::size_t end) const;
  std::string_view before_dot(std::size_t word) const;
  void refuse_dotted(std::size_t word) const;
  std::size_t statement_end() const;
  std::optional<Diagnostic> meant_by_number() const;
  std::optional<Diagnostic> meant_by_first_word(std::size_t start);
  std::optional<Diagnostic> meant_by_foreign_statement(std::size_t start);
  std::optional<Diagnostic> meant_by_value(std::size_t start);
  std::optional<Diagnostic> meant_by_assignment();
  std::optional<Diagnostic> meant_by_operator(std::size_t start);
  std::optional<Diagnostic> meant_by_list_word(std::size_t start);
  std::optional<Diagnostic> meant_by_access(std::size_t receiver, std::size_t selector);
  bool at_binary_operator() const;
  bool lacks_self();
  Diagnostic without_self();
  bool at_foreign_declaration();

  // --- declarations.cpp
  void top_level(ast::File& file);
  void skip_to_top_level();
  void directive(ast::File& file);
  void directive_period();
  double version_number();
  void use_version(ast::Directive& directive);
  void define();
  void controller(ast::File& file);
  void class_declaration(ast::File& file);
  void class_clauses(ast::Class& result);
  void class_body(ast::Class& result);
  void variables(ast::Class& result);
  bool stray_brace() const;
  bool more_braces_close() const;
  bool foreign_class(ast::File& file);
  void stray_member();
  void members(ast::Class& result);
  std::string docs(std::size_t from, std::size_t to) const;  // before the items from + 1 ... to

  // --- methods.cpp
  void method(ast::Class& owner);
  void method_header(ast::Method& result);
  void parameter(ast::Method& result);
  void native_body(ast::Method& result);
  void body(ast::Method& result);
  bool at_declaration() const;
  void declaration(std::vector<ast::Variable>& into, std::string_view what);
  ast::TypeRef type();
  ast::TypeRef array_type();
  void broken_type(ast::TypeRef& result);
  ast::Constant constant();
  double number(std::string_view where);
  std::array<double, 3> number_row(std::string_view where);

  // --- statements.cpp
  ast::StmtPtr statement();
  ast::StmtPtr statement_proper();
  ast::StmtPtr c_for_statement(std::size_t start);
  ast::StmtPtr block(std::size_t start);
  ast::StmtPtr if_statement(std::size_t start);
  ast::StmtPtr while_statement(std::size_t start);
  ast::StmtPtr for_statement(std::size_t start);
  ast::StmtPtr foreach_statement(std::size_t start);
  ast::StmtPtr print_statement(std::size_t start);
  ast::StmtPtr simple_statement(std::size_t start);
  ast::ExprPtr condition();
  ast::ExprPtr header_part();
  void lint_condition(const ast::Expr& condition);
  void read_statements(std::vector<ast::StmtPtr>& into);
  void misplaced_declaration();
  void expect_colon(std::string_view where);
  void expect_period(std::size_t start);
  void lint_dot();
  bool brace_opens_block() const;
  void recover(std::size_t start, const SyntaxError& problem);
  void skip_statement(std::size_t start);
  void leave_braces(std::size_t start);
  bool starts_statement(std::size_t ahead) const;
  bool at_statement_word(std::size_t ahead) const;
  std::size_t run_on_line(std::size_t start) const;
  template <typename Node>
  ast::StmtPtr make_statement(std::size_t start, Node node);

  // --- expressions.cpp
  ast::ExprPtr expression();
  ast::ExprPtr value();  // an expression where a beginner may have forgotten the parentheses of a call
  ast::ExprPtr assignment(bool statement_level);
  void check_target(const ast::Expr& target);
  ast::ExprPtr chain(int level);
  ast::ExprPtr prefix();
  ast::ExprPtr negation();
  ast::ExprPtr list_operation();
  ast::ExprPtr insert_operation();
  ast::ExprPtr sort_operation();
  void lint_chain(const ast::Chain& chain, std::size_t first_end);
  void lint_comparisons(const ast::Chain& chain);
  std::string text_of(const ast::Expr& expression) const;
  template <typename Node>
  ast::ExprPtr make(std::size_t start, Node node);

  // --- primaries.cpp
  ast::ExprPtr postfix();
  void deepen();
  ast::ExprPtr member(std::size_t start, ast::ExprPtr base);
  ast::ExprPtr counted_new(std::size_t start, ast::ExprPtr count);
  void foreign_sign() const;
  ast::ExprPtr primary();
  bool at_fraction_point() const;
  ast::ExprPtr name_expression(std::size_t start);
  ast::ExprPtr word_expression(std::size_t start);
  ast::ExprPtr parenthesised(std::size_t start);
  ast::ExprPtr vector_rest(std::size_t start, ast::ExprPtr x);
  ast::ExprPtr magnitude(std::size_t start);
  ast::ExprPtr list_literal(std::size_t start);
  void lint_element(const ast::Expr& element);
  ast::ExprPtr matrix_literal(std::size_t start);
  std::vector<ast::ExprPtr> items(std::string_view close, std::string_view where);
  std::string class_name(Span& span);

  // --- calls.cpp
  bool at_call(std::size_t start) const;
  bool at_stray_call() const;
  bool at_assignment(std::size_t ahead) const;
  bool run_on_call() const;
  ast::ExprPtr call(std::size_t start, ast::ExprPtr receiver);
  void unparenthesised_call();
  [[noreturn]] void fail_keyword(const ast::Call& call, std::size_t start, std::size_t keyword);
  Diagnostic call_mistake();
  Diagnostic needs_parentheses(std::size_t receiver, std::size_t selector, std::size_t end) const;

  // --- strings.cpp
  ast::ExprPtr string_literal();
  ast::ExprPtr lone_expression();
  friend class Interpolation;

  std::vector<Item> items_;
  std::vector<Doc> docs_;
  std::size_t pos_ = 0;
  const Defines& defines_;
  Defines* new_defines_;  // null: @define is not allowed here
  Diagnostics& diagnostics_;
  const Sources& sources_;
  bool embedded_;
  bool interactive_ = false;
  bool in_header_ = false;  // of an if, while or foreach: a block's brace cannot be a list's
  int depth_ = 0;
  int deepest_ = 0;                // depth of the deepest node of the primary being parsed
  std::size_t primary_start_ = 1;  // items [start, end) of the primary that was parsed last
  std::size_t primary_end_ = 0;
  std::size_t sign_at_ = 0;  // the item behind the last unary minus
  std::size_t errors_ = 0;
  std::size_t statement_errors_ = 0;  // as errors_ was where the statement began
  std::size_t lints_ = 0;
  std::size_t class_close_ = 0;  // the item that closes the class being parsed, 0 if none does
  std::uint32_t last_error_offset_ = 0;
  std::size_t call_end_ = 0;             // the item behind the call that was parsed last
  std::string call_name_;                // its selector
  std::size_t call_start_ = 0;           // the item that its receiver begins with
  std::size_t call_method_ = 0;          // the item of its selector
  std::size_t call_new_ = 0;             // the 'new' of its last argument, if another keyword follows that; else 0
  std::optional<FileNames> file_names_;  // found when a mistake asks for them
  bool semicolon_reported_ = false;
  bool elif_reported_ = false;
  bool method_brace_ = false;               // a '{' stood in place of the ':' of the method header
  bool header_colon_ = false;               // the ':' of the method header was read, too early
  bool open_brace_reported_ = false;        // a '{' has no '}': missing braces around it are not reported
  bool cut_off_ = false;                    // the scanner gave up: errors of the parser are not reported
  std::set<std::uint32_t> garbled_lines_;   // lines with errors of the scanner: what the parser says there is no news
  std::vector<ast::Variable> late_locals_;  // declared after a statement: reported, and yet declared
  std::set<Word> misused_;                  // reserved words that were reported as names
};

}  // namespace breve::steve

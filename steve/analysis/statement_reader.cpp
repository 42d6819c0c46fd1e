// A small machine over tokens: for each open bracket, is an operand expected or was one read, and of which call are the
// keywords that may follow? It accepts more than the language does, as half-written text needs it to.
#include "steve/analysis/statement_reader.hpp"

#include "steve/syntax/words.hpp"

namespace breve::steve {

namespace {

class StatementReader {
 public:
  StatementReader(const std::vector<Token>& tokens, std::size_t start, Context& context)
      : tokens_(tokens), start_(start), context_(context) {}

  void run() {
    restart(start_);
    for (i_ = start_; i_ < context_.count; ++i_) {
      const Token& token = tokens_[i_];
      switch (token.kind) {
        case TokenKind::Name: name(token); break;
        case TokenKind::Punctuation: punctuation(token.text); break;
        default: operand(); break;
      }
    }
    conclude();
  }

 private:
  /// An open bracket, or the statement itself.
  struct Frame {
    char opener = '.';
    bool after = false;           // an operand was read: an operator, a selector or a keyword follows
    std::size_t start = 0;        // the operand's first token
    Word operation = Word::None;  // push, insert, sort, foreach: what word follows its operand
    std::optional<WrittenCall> call;
  };
  Frame& top() { return frames_.back(); }

  void restart(std::size_t start) {
    frames_.assign(1, Frame{});
    start_ = start;
  }

  void operand() {
    top().start = i_;
    top().after = true;
  }

  void name(const Token& token) {
    if (i_ > start_ && is_sign(tokens_[i_ - 1], "::")) {
      top().after = true;
      return;
    }
    const Word word = word_of(token.text);
    if (top().after && begins_statement(token, word)) restart(i_);
    if (top().after) {
      after_operand(token, word);
    } else {
      before_operand(word);
    }
  }

  // A period was forgotten, or is still to be written: what stands further left than its statement begins another.
  bool begins_statement(const Token& token, Word word) const {
    switch (word) {
      case Word::None: break;
      case Word::New: return false;
      default: return true;
    }
    return token.starts_line && frames_.size() == 1 && i_ > start_ &&
           token.span.column <= tokens_[start_].span.column && tokens_[start_].span.line != token.span.line;
  }

  void before_operand(Word word) {
    switch (word) {
      case Word::None:
      case Word::Self:
      case Word::Super:
      case Word::Random: return operand();
      case Word::New:
      case Word::All:
        operand();
        if (i_ + 1 < context_.count) ++i_;  // the class
        return;
      case Word::Push:
      case Word::Prepend: top().operation = Word::Push; return;
      case Word::Insert:
      case Word::Sort:
      case Word::Foreach: top().operation = word; return;
      default: return;
    }
  }

  void after_operand(const Token& token, Word word) {
    if (word == Word::New) {
      if (i_ + 1 < context_.count) ++i_;
      return;
    }
    const std::string_view wanted = word_after_operand(top().operation);
    if (!wanted.empty() && token.text == wanted) {
      const bool sort = top().operation == Word::Sort;
      top() = Frame{top().opener, false, i_, Word::None, std::nullopt};
      if (sort && i_ + 1 < context_.count) ++i_, operand();
      if (sort && i_ + 1 == context_.count && is_name(tokens_[i_], "with")) sort_method_ = true;
      return;
    }
    if (top().call) {
      top().call->keyword = token.text;
      top().call->keywords.push_back(token.text);
      top().after = false;
    } else {
      top().call = WrittenCall{top().start, i_, {}, {}};
    }
  }

  static std::string_view word_after_operand(Word operation) {
    switch (operation) {
      case Word::Push: return "onto";
      case Word::Insert: return "at";
      case Word::Sort: return "with";
      case Word::Foreach: return "in";
      default: return {};
    }
  }

  void punctuation(std::string_view sign) {
    if (sign == "(" || sign == "[" || sign == "{") {
      if (!top().after || top().call) top().start = i_;  // else it is an index or the arguments of a function
      frames_.push_back(Frame{sign[0], false, i_, Word::None, std::nullopt});
    } else if (sign == ")" || sign == "]" || sign == "}") {
      close();
    } else if (sign == "|") {
      if (top().after && top().opener == '|') {
        close();
      } else if (!top().after) {
        top().start = i_;
        frames_.push_back(Frame{'|', false, i_, Word::None, std::nullopt});
      }
    } else if (sign == "," || sign == "=") {
      top().after = false;
      top().call.reset();
    } else if (sign != "::" && sign != "++" && sign != "--") {
      top().after = false;
    }
  }

  void close() {
    if (frames_.size() > 1) frames_.pop_back();
    top().after = true;
  }

  void conclude() {
    for (auto frame = frames_.rbegin(); frame != frames_.rend() && !context_.call; ++frame) context_.call = frame->call;
    const bool member = context_.count > start_ && is_sign(tokens_[context_.count - 1], "::");
    context_.receiver = top().start;
    if (member) {
      context_.expected = Expected::Member;
    } else if (sort_method_) {
      context_.expected = Expected::SortMethod;
    } else if (!top().after) {
      context_.expected = start_ == context_.count ? Expected::StatementStart : Expected::Operand;
      if (context_.count == start_ + 1 && is_name(tokens_[start_], "else"))
        context_.expected = Expected::StatementStart;
    } else if (top().call) {
      context_.expected = Expected::Keyword;
    } else {
      context_.expected = after_operation();
    }
  }

  Expected after_operation() {
    switch (top().operation) {
      case Word::Push: return Expected::OntoWord;
      case Word::Insert: return Expected::AtWord;
      case Word::Sort: return Expected::WithWord;
      case Word::Foreach: return Expected::InWord;
      default: return Expected::Selector;
    }
  }

  const std::vector<Token>& tokens_;
  std::size_t start_, i_ = 0;
  Context& context_;
  std::vector<Frame> frames_;
  bool sort_method_ = false;
};

}  // namespace

void read_statement(const std::vector<Token>& tokens, std::size_t start, Context& context) {
  StatementReader(tokens, start, context).run();
}

}  // namespace breve::steve

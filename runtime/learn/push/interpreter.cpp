// The loop of the Push interpreter, and what names stand for.
#include "runtime/learn/push/interpreter.hpp"

#include <algorithm>

#include "runtime/learn/push/instructions.hpp"
#include "runtime/learn/push/text.hpp"

namespace breve::push {

Interpreter::Interpreter(std::pmr::memory_resource* memory)
    : settings(memory),
      integers(memory),
      floats(memory),
      booleans(memory),
      vectors(memory),
      names(memory),
      codes(memory),
      execs(memory),
      words_(memory) {}

void Interpreter::begin(const Code& program) {
  if (settings.push_code) push(codes, program);
  push(execs, program);
}

void Interpreter::end() {
  if (settings.pop_code && !codes.empty()) codes.pop_back();
}

Outcome Interpreter::advance(std::uint64_t& steps, Random& random) {
  const Instruction* const all = instructions().data();
  random_ = &random;
  full_ = calls_ = false;
  work_ = 0;
  while (!execs.empty()) {
    if (calls_) return Outcome::Called;
    if (steps == 0 || full_) return Outcome::CutOff;
    if (work_ >= kPiece) return Outcome::Paused;
    Code top = std::move(execs.back());
    execs.pop_back();
    --steps;
    ++effort;
    ++work_;
    const Node& node = top.root();
    switch (node.kind) {
      case Kind::List: open_list(top); break;
      case Kind::Integer: push(integers, node.integer); break;
      case Kind::Float: push(floats, node.real); break;
      case Kind::Boolean: push(booleans, static_cast<std::uint8_t>(node.boolean)); break;
      case Kind::Vector: push(vectors, node.as_vector()); break;
      case Kind::Instruction: {
        const std::uint16_t number = node.instruction;
        { const Code done = std::move(top); }  // loops look whether others can see their code
        all[number].run(*this);
        break;
      }
      case Kind::Name: do_name(std::move(top)); break;
    }
  }
  return calls_ ? Outcome::Called : full_ ? Outcome::CutOff : Outcome::Finished;
}

void Interpreter::open_list(const Code& list) {
  const std::size_t below = execs.size();
  for (std::uint32_t i = 1; i < list.points(); i = list.next(i)) push(execs, list.part(i));
  std::reverse(execs.begin() + static_cast<std::ptrdiff_t>(below), execs.end());
  spend(execs.size() - below);
}

void Interpreter::do_name(Code name) {
  if (quotes_name_) {
    quotes_name_ = false;
    return push(names, std::move(name));
  }
  const Word* word = find_word(name.root().name->text());
  if (!word) return push(names, std::move(name));
  if (word->kind != Word::Kind::Callback) return push(execs, *word->code);
  calls_ = true;
  called_ = word->callback;
}

void Interpreter::clear() {
  integers.clear();
  floats.clear();
  booleans.clear();
  vectors.clear();
  names.clear();
  codes.clear();
  execs.clear();
  quotes_name_ = false;
  std::erase_if(words_, [](const auto& entry) { return entry.second.kind == Word::Kind::Defined; });
}

void Interpreter::add_word(std::string_view name, Word word) {
  if (!is_name(name))
    throw Error(ErrorCode::Argument, "'" + std::string(name.substr(0, 40)) +
                                         "' cannot name an instruction: it must be one word that is neither a number, "
                                         "TRUE, FALSE nor an instruction of Push");
  words_.insert_or_assign(std::pmr::string(name, memory()), std::move(word));
}

void Interpreter::add_callback(std::string_view name, std::uint32_t number) {
  add_word(name, {Word::Kind::Callback, number, std::nullopt});
}

void Interpreter::add_macro(std::string_view name, const Code& code) { add_word(name, {Word::Kind::Macro, 0, code}); }

const Word* Interpreter::find_word(std::string_view name) const {
  const auto found = words_.find(name);
  return found == words_.end() ? nullptr : &found->second;
}

void Interpreter::define(const Code& name, Code value) {
  const std::string_view text = name.root().name->text();
  const auto found = words_.find(text);
  if (found == words_.end()) {
    if (words_.size() >= kMaxDepth) {
      full_ = true;
      return;
    }
    words_.emplace(std::pmr::string(text, memory()), Word{Word::Kind::Defined, 0, std::move(value)});
  } else if (found->second.kind == Word::Kind::Defined) {
    found->second.code = std::move(value);
  }
}

std::optional<Code> Interpreter::random_bound_name(Random& random) {
  spend(words_.size());
  std::size_t bound = 0;
  for (const auto& [text, word] : words_) bound += word.kind == Word::Kind::Defined ? 1 : 0;
  if (bound == 0) return {};
  std::uint64_t chosen = random.below(bound);
  for (const auto& [text, word] : words_)
    if (word.kind == Word::Kind::Defined && chosen-- == 0) return push::name(text, memory());
  return {};
}

}  // namespace breve::push

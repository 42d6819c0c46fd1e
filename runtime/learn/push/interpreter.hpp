// A Push 3 interpreter: seven stacks, and a loop that takes what is on the EXEC stack and does it.
//
// Source: Spector, Klein and Keijzer, "The Push3 Execution Stack and the Evolution of Control", GECCO 2005; Spector,
// Perry, Klein and Keijzer, "Push 3.0 Programming Language Description", 2004. VECTOR is an addition for three
// dimensions.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/base/random.hpp"
#include "runtime/learn/push/code.hpp"
#include "runtime/learn/push/settings.hpp"

namespace breve::push {

template <class T>
using Stack = std::pmr::vector<T>;

/// What a name stands for.
struct Word {
  enum class Kind : std::uint8_t { Defined, Macro, Callback };
  Kind kind = Kind::Defined;
  std::uint32_t callback = 0;  // Callback: the owner's number for it
  std::optional<Code> code;    // Defined, Macro: what it stands for
};

/// Why advance() came back.
enum class Outcome : std::uint8_t {
  Finished,  // the EXEC stack is empty
  CutOff,    // the steps are used up, or a stack is full
  Paused,    // some work was done: count it and call again
  Called,    // the program called the callback called(): do it and call again
};

class Interpreter {
 public:
  static constexpr std::size_t kMaxDepth = std::size_t{1} << 20;  // items of a stack
  /// Atoms and lists that a loop adds to its body may go beyond the list limit.
  static constexpr std::uint32_t kLoopRoom = 8;

  explicit Interpreter(std::pmr::memory_resource* memory);

  /// Put a program on the EXEC stack (and, if so set, on the CODE stack).
  void begin(const Code& program);
  /// Do at most `steps` of what is on the EXEC stack. `steps` becomes what is left.
  Outcome advance(std::uint64_t& steps, Random& random);
  std::uint32_t called() const { return called_; }
  /// What begin() set aside for the end: pops the CODE stack if so set.
  void end();
  /// Work done since it was last asked for, in units of about a step.
  std::uint64_t take_work() { return std::exchange(work_, 0); }
  std::uint64_t effort = 0;  // steps since somebody set it to 0

  /// Empties all stacks and forgets what names were defined as.
  void clear();

  /// A name that stands for a callback or for code. It becomes an active instruction.
  /// @throws Error{Argument} if it cannot be a name
  void add_callback(std::string_view name, std::uint32_t number);
  void add_macro(std::string_view name, const Code& code);
  const std::pmr::map<std::pmr::string, Word, std::less<>>& words() const { return words_; }

  Settings settings;
  Stack<std::int32_t> integers;
  Stack<double> floats;  // finite
  Stack<std::uint8_t> booleans;
  Stack<Vector3> vectors;  // finite
  Stack<Code> names, codes, execs;

  // --- for instructions ----------------------------------------------------------------------------------------------
  std::pmr::memory_resource* memory() const { return integers.get_allocator().resource(); }
  Random& random() { return *random_; }
  /// Onto a stack; a stack that is full stays as it is, and the run is cut off.
  template <class T, class U>
  void push(Stack<T>& stack, U&& value) {
    if (stack.size() >= kMaxDepth) [[unlikely]]
      full_ = true;
    else
      stack.push_back(std::forward<U>(value));
  }
  void push_float(double value) { push(floats, value); }
  /// Count work beyond that of a step: points of code, items moved.
  void spend(std::uint64_t items) { work_ += items / kItemsPerUnit; }
  /// May an instruction make code of so many points?
  bool fits(std::uint64_t points) const { return points <= static_cast<std::uint64_t>(settings.list_limit); }
  void quote_next_name() { quotes_name_ = true; }
  /// Let `name` stand for `value`. Does nothing if it stands for an instruction.
  void define(const Code& name, Code value);
  const Word* find_word(std::string_view name) const;
  /// One of the names that were defined; none: nothing.
  std::optional<Code> random_bound_name(Random& random);

  void save(ByteWriter& out) const;
  void load(ByteReader& in);  // Error{Image}
  void hash(Hasher& hasher) const;

 private:
  static constexpr std::uint64_t kItemsPerUnit = 8;
  static constexpr std::uint64_t kPiece = 4096;  // units of work between two pauses

  void open_list(const Code& list);
  void do_name(Code name);
  void add_word(std::string_view name, Word word);
  void load_words(ByteReader& in, CodeReader& code_reader);

  std::pmr::map<std::pmr::string, Word, std::less<>> words_;
  bool quotes_name_ = false;  // NAME.QUOTE waits for its name
  bool full_ = false;         // within advance()
  bool calls_ = false;        // within advance()
  std::uint32_t called_ = 0;
  std::uint64_t work_ = 0;
  Random* random_ = nullptr;  // within advance()
};

}  // namespace breve::push

// Instructions, registers and jumps of one function while it is being compiled.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "steve/code/bytecode.hpp"

namespace breve::steve {

/// Where a value is and what it is. A temporary is given back with Emitter::release.
struct Operand {
  StaticType type = StaticType::Null;
  std::uint16_t slot = 0;
  bool temporary = false;
};

/// A place to jump to, possibly not known yet.
struct Label {
  std::int32_t position = -1;
  std::vector<std::uint32_t> uses;  // instructions that wait for it
};

class Emitter {
 public:
  Emitter(Function& function, Diagnostics& diagnostics) : function_(function), diagnostics_(diagnostics) {}

  // --- registers -----------------------------------------------------------------------------------------------------
  Operand temporary(StaticType type);
  void release(const Operand& operand);
  /// Registers for a parameter, local or array; never given back.
  std::uint16_t reserve(StaticType type, std::uint32_t count = 1);
  /// Consecutive registers of the given types, one call's arguments; given back with release_block.
  std::vector<Operand> block(const std::vector<StaticType>& types);
  void release_block(const std::vector<Operand>& block);
  /// The free temporaries, which are not given out any more until they are given back: for code that may run after code
  /// that follows it, so that the one's scratch is not the other's result.
  using FreeRegisters = std::array<std::vector<std::uint16_t>, 5>;  // by kind
  FreeRegisters set_aside() { return std::exchange(free_, {}); }
  void give_back(const FreeRegisters& some);
  void finish();

  // --- code ----------------------------------------------------------------------------------------------------------
  void at(const Span& span) { span_ = span; }
  const Span& span() const { return span_; }
  std::uint32_t emit(Op op, std::uint16_t a = 0, std::uint16_t b = 0, std::uint16_t c = 0);
  std::uint32_t emit_imm(Op op, std::uint16_t a, std::int32_t imm);
  std::uint32_t ext(std::uint16_t a, std::int32_t imm = 0);  // a data word
  std::uint32_t number(double value);
  std::uint32_t numbers(const double* values, std::size_t count);

  // --- jumps ---------------------------------------------------------------------------------------------------------
  void jump(Op op, std::uint16_t a, Label& label);   // imm form
  void jump_ext(Label& label, std::uint16_t a = 0);  // the data word of an instruction that jumps
  void compare_jump(Op op, std::uint16_t a, std::uint16_t b, Label& label);
  void place(Label& label);
  /// The instruction before, if it put a temporary into `slot` and no jump leads here: it may be made part of the next.
  Instruction* just_made(const Operand& temporary);
  void drop_last();
  static bool is_product(Op op) { return op == Op::MulDouble || op == Op::MulConstant || op == Op::ScaleVector; }
  /// Take back the instruction before, if it made `temporary` as a product of variables.
  std::optional<Instruction> take_product(const Operand& temporary);
  std::int32_t here() const { return static_cast<std::int32_t>(function_.code.size()); }

 private:
  void patch(std::uint32_t use, std::int32_t target);
  std::uint16_t pooled(StaticType type);
  std::uint16_t fresh(StaticType type, std::uint32_t count);
  static int pool_of(StaticType type);

  Function& function_;
  Diagnostics& diagnostics_;
  Span span_;
  FreeRegisters free_;
  std::vector<bool> temporaries_;  // for each slot: it is one, or an argument of a call
  std::map<std::string, std::vector<std::vector<Operand>>> free_blocks_;
  std::int32_t placed_ = -1;  // the last label
  bool full_ = false;
};

}  // namespace breve::steve

// The table of instructions: their names, and what each does to the stacks.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace breve::push {

class Interpreter;

/// An instruction that finds too little on the stacks leaves them as they are, as every one of Push does.
struct Instruction {
  std::string_view name;
  void (*run)(Interpreter& on);
};

/// All of them, by name.
std::span<const Instruction> instructions();
/// The number of an instruction in instructions(), in capitals or not.
std::optional<std::uint16_t> find_instruction(std::string_view name);

/// Those that other instructions put into code.
struct Special {
  std::uint16_t code_quote, code_pop, code_range, exec_range, exec_y, integer_pop;
};
const Special& special();

/// By kind; instructions() joins them.
std::span<const Instruction> integer_instructions();
std::span<const Instruction> float_instructions();
std::span<const Instruction> boolean_instructions();
std::span<const Instruction> vector_instructions();
std::span<const Instruction> name_instructions();
std::span<const Instruction> code_instructions();
std::span<const Instruction> loop_instructions();
std::span<const Instruction> exec_instructions();

}  // namespace breve::push

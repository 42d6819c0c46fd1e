// The tables of instructions, joined and in order.
#include "runtime/learn/push/instructions.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "runtime/base/invariant.hpp"

namespace breve::push {

namespace {

constexpr std::size_t kMost = 256;

/// Filled once, then constant: the same for every world.
struct Table {
  std::array<Instruction, kMost> all{};
  std::size_t count = 0;
  Special special{};

  Table() {
    for (const std::span<const Instruction> table :
         {integer_instructions(), float_instructions(), boolean_instructions(), vector_instructions(),
          name_instructions(), code_instructions(), loop_instructions(), exec_instructions()})
      for (const Instruction& instruction : table) all.at(count++) = instruction;
    std::sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Instruction& a, const Instruction& b) { return a.name < b.name; });
    special = {number("CODE.QUOTE"),    number("CODE.POP"), number("CODE.DO*RANGE"),
               number("EXEC.DO*RANGE"), number("EXEC.Y"),   number("INTEGER.POP")};
  }
  std::optional<std::uint16_t> find(std::string_view name) const {
    const Instruction* end = all.data() + count;
    const Instruction* found =
        std::lower_bound(all.data(), end, name, [](const Instruction& a, std::string_view b) { return a.name < b; });
    if (found == end || found->name != name) return {};
    return static_cast<std::uint16_t>(found - all.data());
  }
  std::uint16_t number(std::string_view name) const {
    const std::optional<std::uint16_t> found = find(name);
    invariant(found.has_value(), "an instruction that others need is in the table");
    return *found;
  }
};

const Table& table() {
  static const Table all;
  return all;
}

}  // namespace

std::span<const Instruction> instructions() { return {table().all.data(), table().count}; }

std::optional<std::uint16_t> find_instruction(std::string_view name) {
  std::string capitals(name);
  for (char& c : capitals)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return table().find(capitals);
}

const Special& special() { return table().special; }

}  // namespace breve::push

// Instructions, registers and jumps of one function while it is being compiled. Slots never change kind, so that the
// collector can read a frame from two fixed lists.
#include "steve/compile/emitter.hpp"

#include <algorithm>

namespace breve::steve {

int slot_count(StaticType type) {
  switch (type) {
    case StaticType::Vector: return 3;
    case StaticType::Matrix: return 9;
    case StaticType::Any:
    case StaticType::Null: return 4;
    default: return 1;
  }
}

namespace {
bool is_compare_jump(Op op) { return op >= Op::JumpUnlessLtInt && op <= Op::StepJumpIfLtImm; }
}  // namespace

int Emitter::pool_of(StaticType type) {
  switch (type) {
    case StaticType::Int:
    case StaticType::Double: return 0;
    case StaticType::Vector: return 1;
    case StaticType::Matrix: return 2;
    case StaticType::Any:
    case StaticType::Null: return 4;
    default: return 3;
  }
}

std::uint16_t Emitter::fresh(StaticType type, std::uint32_t count) {
  const auto size = static_cast<std::uint32_t>(slot_count(type));
  const std::uint64_t end = function_.frame_slots + static_cast<std::uint64_t>(size) * count;
  if (end > kMaxSlots) {
    if (!full_)
      diagnostics_.error(span_, "method-too-large", "this method needs more registers than a method may have",
                         "split it, or keep large arrays in instance variables or lists");
    full_ = true;
    return 0;
  }
  const auto slot = static_cast<std::uint16_t>(function_.frame_slots);
  function_.frame_slots = static_cast<std::uint32_t>(end);
  const int pool = pool_of(type);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto at = static_cast<std::uint16_t>(slot + i * size);
    if (pool == 3) function_.reference_slots.push_back(at);
    if (pool == 4) function_.any_slots.push_back(at);
  }
  if (pool >= 3) function_.zeroed_slots = function_.frame_slots;
  return slot;
}

std::uint16_t Emitter::pooled(StaticType type) {
  const auto slot = fresh(type, 1);
  temporaries_.resize(std::max<std::size_t>(temporaries_.size(), function_.frame_slots));
  temporaries_[slot] = true;
  return slot;
}

Operand Emitter::temporary(StaticType type) {
  if (type == StaticType::Null) type = StaticType::Any;
  auto& pool = free_[pool_of(type)];
  if (!pool.empty()) {
    const auto slot = pool.back();
    pool.pop_back();
    return {type, slot, true};
  }
  return {type, pooled(type), true};
}

void Emitter::release(const Operand& operand) {
  if (operand.temporary) free_[pool_of(operand.type)].push_back(operand.slot);
}

void Emitter::give_back(const FreeRegisters& some) {
  for (std::size_t kind = 0; kind < free_.size(); ++kind)
    free_[kind].insert(free_[kind].end(), some[kind].begin(), some[kind].end());
}

std::uint16_t Emitter::reserve(StaticType type, std::uint32_t count) {
  const auto slot = fresh(type, count);
  function_.zeroed_slots = function_.frame_slots;
  return slot;
}

std::vector<Operand> Emitter::block(const std::vector<StaticType>& types) {
  std::string key;
  for (const auto type : types) key += static_cast<char>('A' + static_cast<int>(type));
  auto& free = free_blocks_[key];
  if (!free.empty()) {
    auto block = std::move(free.back());
    free.pop_back();
    return block;
  }
  std::vector<Operand> block;
  for (const auto type : types) block.push_back({type, pooled(type), false});
  return block;
}

void Emitter::release_block(const std::vector<Operand>& block) {
  std::string key;
  for (const auto& operand : block) key += static_cast<char>('A' + static_cast<int>(operand.type));
  free_blocks_[key].push_back(block);
}

void Emitter::finish() {
  if (function_.code.empty() || function_.code.back().op != Op::ReturnNull) emit(Op::ReturnNull);
}

std::uint32_t Emitter::emit(Op op, std::uint16_t a, std::uint16_t b, std::uint16_t c) {
  function_.code.push_back({op, a, b, c});
  function_.spans.push_back(span_);
  return static_cast<std::uint32_t>(function_.code.size() - 1);
}

std::uint32_t Emitter::emit_imm(Op op, std::uint16_t a, std::int32_t imm) {
  const auto at = emit(op, a);
  function_.code[at].set_imm(imm);
  return at;
}

std::uint32_t Emitter::ext(std::uint16_t a, std::int32_t imm) { return emit_imm(Op::Mov1, a, imm); }

std::uint32_t Emitter::number(double value) { return numbers(&value, 1); }

std::uint32_t Emitter::numbers(const double* values, std::size_t count) {
  function_.numbers.insert(function_.numbers.end(), values, values + count);
  return static_cast<std::uint32_t>(function_.numbers.size() - count);
}

void Emitter::jump(Op op, std::uint16_t a, Label& label) {
  const auto at = emit_imm(op, a, 0);
  if (label.position >= 0)
    patch(at, label.position);
  else
    label.uses.push_back(at);
}

void Emitter::jump_ext(Label& label, std::uint16_t a) {
  const auto at = ext(a, 0);
  if (label.position >= 0)
    patch(at, label.position);
  else
    label.uses.push_back(at);
}

void Emitter::compare_jump(Op op, std::uint16_t a, std::uint16_t b, Label& label) {
  const auto at = emit(op, a, b);
  if (label.position >= 0)
    patch(at, label.position);
  else
    label.uses.push_back(at);
}

void Emitter::place(Label& label) {
  label.position = placed_ = here();
  for (const auto use : label.uses) patch(use, label.position);
  label.uses.clear();
}

Instruction* Emitter::just_made(const Operand& temporary) {
  auto& code = function_.code;
  if (!temporary.temporary || code.empty() || placed_ == here() || code.back().a != temporary.slot) return nullptr;
  return &code.back();
}

std::optional<Instruction> Emitter::take_product(const Operand& temporary) {
  const auto* made = just_made(temporary);
  if (!made || !is_product(made->op)) return std::nullopt;
  const auto is_pooled = [this](std::uint16_t slot) { return slot < temporaries_.size() && temporaries_[slot]; };
  if (is_pooled(made->b) || (made->op != Op::MulConstant && is_pooled(made->c))) return std::nullopt;
  const auto product = *made;
  drop_last();
  return product;
}

void Emitter::drop_last() {
  function_.code.pop_back();
  function_.spans.pop_back();
}

void Emitter::patch(std::uint32_t use, std::int32_t target) {
  const std::int32_t distance = target - static_cast<std::int32_t>(use) - 1;
  auto& instruction = function_.code[use];
  if (!is_compare_jump(instruction.op)) {
    instruction.set_imm(distance);
    return;
  }
  if (distance < INT16_MIN || distance > INT16_MAX) {
    if (!full_) diagnostics_.error(span_, "method-too-large", "this method is too long", "split it");
    full_ = true;
    return;
  }
  instruction.c = static_cast<std::uint16_t>(static_cast<std::int16_t>(distance));
}

}  // namespace breve::steve

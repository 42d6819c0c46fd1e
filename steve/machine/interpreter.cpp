// The interpreter: one loop, direct threaded, untagged registers. Everything that is rare or long is a call away in
// slow_paths.cpp and calls.cpp. This file is longer than others because it is one function.
//
// The loop is compiled twice: execute<true> tells the profiler what it calls, execute<false> does not know of it and
// costs nothing. KEEP IN STEP: profile. Whatever enters a script's frame says profile_call before, whatever leaves one
// that the loop itself entered says profile_leave; natives, functions and reclaiming go through the ..._profiled
// helpers (profiled.cpp) if kProfiled. Frames left by an exception need no cleanup: the catch block below leaves them.
#include <bit>
#include <cmath>
#include <cstring>

#include "steve/machine/machine.hpp"
#include "steve/machine/operators.hpp"

#pragma GCC diagnostic ignored "-Wpedantic"  // labels as values: GNU C, understood by g++ and clang++

namespace breve::steve {

// A line an instruction, so that the loop reads as a table.
// clang-format off
// Registers and operands of the running instruction.
#define R(n) base[n]
#define ANY(n) (*reinterpret_cast<Value*>(base + (n)))
#define ANY_OR_RESULT(n) ((n) == kResult ? result_ : ANY(n))
#define LIST(n) static_cast<ListCell*>(R(n).ref)
#define K(n) numbers[n]
// A dynamic value in registers, and the result of a call, are written and copied word by word: a read that is wider than
// the write before it would wait until that has reached the cache.
#define BOX(n, tag, word) put_any(&R(n), Tag::tag, word)
#define RESULT(tag, word) (result_.head = Value::head_of(Tag::tag), result_.bits[0] = (word))
#define NEXT() do { in = pc++; goto *kLabels[static_cast<std::size_t>(in->op)]; } while (0)
#define SAVE() (frame->pc = pc)
#define EXT(n) (pc[n])
#define JUMP() (pc += in->imm())
#define RELOAD()                  \
  do {                            \
    frame = frame_;               \
    pc = frame->pc;               \
    base = frame->base();         \
    self = frame->self;           \
    numbers = frame->function->numbers.data(); \
  } while (0)
#define COUNT_CALL()                                                                   \
  do {                                                                                 \
    if (budget_.count_iteration()) [[unlikely]] { SAVE(); end_of_piece(); }                       \
    SAFE_POINT();                                                                      \
  } while (0)
#define SAFE_POINT()                                                                   \
  do {                                                                                 \
    if (heap_->wants_reclaim()) [[unlikely]] {                                           \
      SAVE();                                                                            \
      if constexpr (kProfiled) reclaim_profiled();                                       \
      else heap_->reclaim();                                                             \
    }                                                                                    \
  } while (0)
// A method of an object that was freed meanwhile is left at once.
#define LEAVE_IF_FREED() do { if (!self->live()) [[unlikely]] { RESULT(Null, 0); goto do_return; } } while (0)

namespace {
inline bool true_object(const Cell* cell) { return cell && static_cast<const Instance*>(cell)->live(); }
inline bool true_any(const Value& v) {
  switch (v.tag) {
    case Tag::Int: return v.i != 0;
    case Tag::Double: return v.d != 0;
    case Tag::Null: return false;
    case Tag::Object: return true_object(v.ref);
    default: return truth(v);
  }
}
inline void put_vector(Slot* to, double x, double y, double z) {
  to[0].d = x;
  to[1].d = y;
  to[2].d = z;
}
inline void copy3(Slot* to, const Slot* from) {
  const std::uint64_t x = from[0].bits, y = from[1].bits, z = from[2].bits;
  to[0].bits = x;
  to[1].bits = y;
  to[2].bits = z;
}
inline void put_any(Slot* to, Tag tag, std::uint64_t word) {
  to[0].bits = Value::head_of(tag);
  to[1].bits = word;
}
inline void copy_any(Slot* to, const Value& from) {
  const std::uint64_t head = from.head, word = from.bits[0];
  if (from.tag == Tag::Vector) {
    const std::uint64_t y = from.bits[1], z = from.bits[2];
    to[2].bits = y;
    to[3].bits = z;
  }
  to[0].bits = head;
  to[1].bits = word;
}
inline void copy_any(Value& to, const Value& from) { copy_any(reinterpret_cast<Slot*>(&to), from); }
inline std::uint64_t word(std::int32_t i) { return static_cast<std::uint32_t>(i); }
inline std::uint64_t word(double d) { return std::bit_cast<std::uint64_t>(d); }
/// The element of a list that is known to be there.
inline void copy_element(Slot* to, const ListCell& list, std::uint32_t i) {
  if (list.narrow()) put_any(to, list.kind, list.store[list.first + i].bits);
  else copy_any(to, list.values()[list.first + i]);
}
/// The operators on ints that cannot fail.
inline std::int32_t int_binary(ast::BinaryOp op, std::int32_t a, std::int32_t b) {
  switch (op) {
    case ast::BinaryOp::Add: return wrap_add(a, b);
    case ast::BinaryOp::Sub: return wrap_sub(a, b);
    case ast::BinaryOp::Mul: return wrap_mul(a, b);
    case ast::BinaryOp::Lt: return a < b;
    case ast::BinaryOp::Le: return a <= b;
    case ast::BinaryOp::Gt: return a > b;
    case ast::BinaryOp::Ge: return a >= b;
    case ast::BinaryOp::Eq: return a == b;
    default: return a != b;
  }
}
}  // namespace

template <bool kProfiled>
void Machine::execute(std::size_t depth) {
  static const void* const kLabels[] = {
#define X(name) &&op_##name,
      BREVE_OPCODES(X)
#undef X
  };
  const Instruction* pc = nullptr;
  const Instruction* in = nullptr;
  Frame* frame = nullptr;
  Slot* base = nullptr;
  Instance* self = nullptr;
  const double* numbers = nullptr;
  [[maybe_unused]] std::size_t profiled_depth = 0;
  if constexpr (kProfiled) profiled_depth = profile_depth();
  try {
    RELOAD();
    NEXT();

  op_Mov1: R(in->a).bits = R(in->b).bits; NEXT();
  op_Mov3: copy3(&R(in->a), &R(in->b)); NEXT();
  op_Mov9: std::memmove(static_cast<void*>(&R(in->a)), &R(in->b), 9 * sizeof(Slot)); NEXT();
  op_MovAny: copy_any(&R(in->a), ANY(in->b)); NEXT();
  op_LoadInt: R(in->a).i = in->imm(); NEXT();
  op_LoadDouble: R(in->a).d = K(in->imm()); NEXT();
  op_LoadVector: put_vector(&R(in->a), K(in->imm()), K(in->imm() + 1), K(in->imm() + 2)); NEXT();
  op_LoadMatrix: std::memcpy(static_cast<void*>(&R(in->a)), &K(in->imm()), 9 * sizeof(double)); NEXT();
  op_LoadString: R(in->a).ref = strings_[static_cast<std::size_t>(in->imm())]; NEXT();
  op_LoadSelf: R(in->a).ref = self; NEXT();
  op_ZeroRef: R(in->a).ref = nullptr; NEXT();
  op_ZeroAny: BOX(in->a, Null, 0); NEXT();
  op_EnsureList: if (!R(in->a).ref) R(in->a).ref = heap_->list(); NEXT();
  op_EnsureHash: if (!R(in->a).ref) R(in->a).ref = heap_->hash(); NEXT();

  op_GetVar1: R(in->a).bits = self->slots[in->imm()].bits; NEXT();
  op_GetVar3: copy3(&R(in->a), self->slots + in->imm()); NEXT();
  op_GetVar9: std::memcpy(static_cast<void*>(&R(in->a)), self->slots + in->imm(), 9 * sizeof(Slot)); NEXT();
  op_GetVarList: {
    Slot& slot = self->slots[in->imm()];
    if (!slot.ref) heap_->store(slot, heap_->list());
    R(in->a).ref = slot.ref;
    NEXT();
  }
  op_GetVarHash: {
    Slot& slot = self->slots[in->imm()];
    if (!slot.ref) heap_->store(slot, heap_->hash());
    R(in->a).ref = slot.ref;
    NEXT();
  }
  op_SetVar1: self->slots[in->imm()].bits = R(in->a).bits; NEXT();
  op_SetVar3: copy3(self->slots + in->imm(), &R(in->a)); NEXT();
  op_SetVar9: std::memcpy(static_cast<void*>(self->slots + in->imm()), &R(in->a), 9 * sizeof(Slot)); NEXT();
  op_SetVarRef: heap_->store(self->slots[in->imm()], R(in->a).ref); NEXT();

  op_ArraySlot: {
    const std::int32_t count = EXT(0).imm(), first = EXT(1).imm(), i = R(in->b).i;
    pc += 2;
    if (i < 0 || i >= count)
      throw RunError(RunErrorKind::Bounds, "array index " + std::to_string(i) + " is out of range: the array has " + std::to_string(count) + " elements, counted from 0");
    R(in->a).i = first + i * in->c;
    NEXT();
  }
  op_ArrayGet: {
    const Slot* from = ((in->c & kFrameArray) ? base : self->slots) + R(in->b).i;
    std::memcpy(static_cast<void*>(&R(in->a)), from, static_cast<std::size_t>(in->c & 0x7f) * sizeof(Slot));
    NEXT();
  }
  op_ArraySet: {
    Slot* to = ((in->c & kFrameArray) ? base : self->slots) + R(in->b).i;
    std::memcpy(static_cast<void*>(to), &R(in->a), static_cast<std::size_t>(in->c & 0x7f) * sizeof(Slot));
    NEXT();
  }
  op_ArraySetRef: heap_->store(self->slots[R(in->b).i], R(in->a).ref); NEXT();
  op_ArrayGetList: op_ArrayGetHash: {
    const bool local = (in->c & kFrameArray) != 0;
    Slot& slot = (local ? base : self->slots)[R(in->b).i];
    if (!slot.ref) {
      Cell* made = in->op == Op::ArrayGetList ? static_cast<Cell*>(heap_->list()) : static_cast<Cell*>(heap_->hash());
      if (local) slot.ref = made;
      else heap_->store(slot, made);
    }
    R(in->a).ref = slot.ref;
    NEXT();
  }

  op_AddInt: R(in->a).i = wrap_add(R(in->b).i, R(in->c).i); NEXT();
  op_SubInt: R(in->a).i = wrap_sub(R(in->b).i, R(in->c).i); NEXT();
  op_MulInt: R(in->a).i = wrap_mul(R(in->b).i, R(in->c).i); NEXT();
  op_DivInt: R(in->a).i = divide(R(in->b).i, R(in->c).i); NEXT();
  op_ModInt: R(in->a).i = remainder(R(in->b).i, R(in->c).i); NEXT();
  op_PowInt: R(in->a).i = power(R(in->b).i, R(in->c).i); NEXT();
  op_NegInt: R(in->a).i = wrap_negate(R(in->b).i); NEXT();
  op_AbsInt: R(in->a).i = R(in->b).i < 0 ? wrap_negate(R(in->b).i) : R(in->b).i; NEXT();
  op_MulIntImm: R(in->a).i = wrap_mul(R(in->b).i, static_cast<std::int16_t>(in->c)); NEXT();
  op_DivIntImm: R(in->a).i = R(in->b).i / static_cast<std::int16_t>(in->c); NEXT();
  op_ModIntImm: R(in->a).i = R(in->b).i % static_cast<std::int16_t>(in->c); NEXT();
  op_AddIntImm: R(in->a).i = wrap_add(R(in->b).i, static_cast<std::int16_t>(in->c)); NEXT();
  op_LtInt: R(in->a).i = R(in->b).i < R(in->c).i; NEXT();
  op_LeInt: R(in->a).i = R(in->b).i <= R(in->c).i; NEXT();
  op_EqInt: R(in->a).i = R(in->b).i == R(in->c).i; NEXT();
  op_NeInt: R(in->a).i = R(in->b).i != R(in->c).i; NEXT();
  op_NotInt: R(in->a).i = !R(in->b).i; NEXT();

  op_AddDouble: R(in->a).d = R(in->b).d + R(in->c).d; NEXT();
  op_SubDouble: R(in->a).d = R(in->b).d - R(in->c).d; NEXT();
  op_MulDouble: R(in->a).d = R(in->b).d * R(in->c).d; NEXT();
  op_DivDouble:
    if (R(in->c).d == 0) fail_division_by_zero();
    R(in->a).d = R(in->b).d / R(in->c).d;
    NEXT();
  op_AddConstant: R(in->a).d = R(in->b).d + K(in->c); NEXT();
  op_MulConstant: R(in->a).d = R(in->b).d * K(in->c); NEXT();
  op_DivConstant: R(in->a).d = R(in->b).d / K(in->c); NEXT();
  op_ConstantSub: R(in->a).d = K(in->c) - R(in->b).d; NEXT();
  op_ConstantDiv:
    if (R(in->b).d == 0) fail_division_by_zero();
    R(in->a).d = K(in->c) / R(in->b).d;
    NEXT();
  op_IntMulConstant: R(in->a).d = R(in->b).i * K(in->c); NEXT();
  // Two steps, each rounded: no fused multiply and add of the processor, whose result would differ.
  op_MulAdd: { const double product = R(in->b).d * R(in->c).d; R(in->a).d = product + R((pc++)->a).d; NEXT(); }
  op_MulSub: { const double product = R(in->b).d * R(in->c).d; R(in->a).d = product - R((pc++)->a).d; NEXT(); }
  op_SubMul: { const double product = R(in->b).d * R(in->c).d; R(in->a).d = R((pc++)->a).d - product; NEXT(); }
  op_MulConstantAdd: { const double product = R(in->b).d * K(in->c); R(in->a).d = product + R((pc++)->a).d; NEXT(); }
  op_MulConstantSub: { const double product = R(in->b).d * K(in->c); R(in->a).d = product - R((pc++)->a).d; NEXT(); }
  op_SubMulConstant: { const double product = R(in->b).d * K(in->c); R(in->a).d = R((pc++)->a).d - product; NEXT(); }
  op_AddAddConstant: R(in->a).d = R(in->b).d + R(in->c).d + K((pc++)->a); NEXT();
  op_SubAddConstant: R(in->a).d = R(in->b).d - R(in->c).d + K((pc++)->a); NEXT();
  op_ModDouble: R(in->a).d = remainder(R(in->b).d, R(in->c).d); NEXT();
  op_PowDouble: R(in->a).d = std::pow(R(in->b).d, R(in->c).d); NEXT();
  op_NegDouble: R(in->a).d = -R(in->b).d; NEXT();
  op_AbsDouble: R(in->a).d = std::fabs(R(in->b).d); NEXT();
  op_LtDouble: R(in->a).i = R(in->b).d < R(in->c).d; NEXT();
  op_LeDouble: R(in->a).i = R(in->b).d <= R(in->c).d; NEXT();
  op_EqDouble: R(in->a).i = R(in->b).d == R(in->c).d; NEXT();
  op_NeDouble: R(in->a).i = R(in->b).d != R(in->c).d; NEXT();
  op_IntToDouble: R(in->a).d = R(in->b).i; NEXT();
  op_DoubleToInt: R(in->a).i = truncate_to_int(R(in->b).d); NEXT();

  op_AddVector: {
    const Slot *x = &R(in->b), *y = &R(in->c);
    put_vector(&R(in->a), x[0].d + y[0].d, x[1].d + y[1].d, x[2].d + y[2].d);
    NEXT();
  }
  op_SubVector: {
    const Slot *x = &R(in->b), *y = &R(in->c);
    put_vector(&R(in->a), x[0].d - y[0].d, x[1].d - y[1].d, x[2].d - y[2].d);
    NEXT();
  }
  op_NegVector: {
    const Slot* x = &R(in->b);
    put_vector(&R(in->a), -x[0].d, -x[1].d, -x[2].d);
    NEXT();
  }
  op_ScaleVector: {
    const Slot* x = &R(in->b);
    const double s = R(in->c).d;
    put_vector(&R(in->a), x[0].d * s, x[1].d * s, x[2].d * s);
    NEXT();
  }
  op_DivVector: {
    const Slot* x = &R(in->b);
    const double s = R(in->c).d;
    if (s == 0) fail_division_by_zero();
    put_vector(&R(in->a), x[0].d / s, x[1].d / s, x[2].d / s);
    NEXT();
  }
  op_MulAddVector: {
    const Slot *x = &R(in->b), *y = &R((pc++)->a);
    const double s = R(in->c).d;
    put_vector(&R(in->a), x[0].d * s + y[0].d, x[1].d * s + y[1].d, x[2].d * s + y[2].d);
    NEXT();
  }
  op_MulSubVector: {
    const Slot *x = &R(in->b), *y = &R((pc++)->a);
    const double s = R(in->c).d;
    put_vector(&R(in->a), x[0].d * s - y[0].d, x[1].d * s - y[1].d, x[2].d * s - y[2].d);
    NEXT();
  }
  op_SubMulVector: {
    const Slot *x = &R(in->b), *y = &R((pc++)->a);
    const double s = R(in->c).d;
    put_vector(&R(in->a), y[0].d - x[0].d * s, y[1].d - x[1].d * s, y[2].d - x[2].d * s);
    NEXT();
  }
  op_EqVector: op_NeVector: {
    const Slot *x = &R(in->b), *y = &R(in->c);
    const bool same = x[0].d == y[0].d && x[1].d == y[1].d && x[2].d == y[2].d;
    R(in->a).i = same == (in->op == Op::EqVector);
    NEXT();
  }
  op_Length: {
    const Slot* x = &R(in->b);
    R(in->a).d = std::sqrt(x[0].d * x[0].d + x[1].d * x[1].d + x[2].d * x[2].d);
    NEXT();
  }
  op_Dot: {
    const Slot *x = &R(in->b), *y = &R(in->c);
    R(in->a).d = x[0].d * y[0].d + x[1].d * y[1].d + x[2].d * y[2].d;
    NEXT();
  }
  op_Cross: {
    const Slot *x = &R(in->b), *y = &R(in->c);
    put_vector(&R(in->a), x[1].d * y[2].d - x[2].d * y[1].d, x[2].d * y[0].d - x[0].d * y[2].d, x[0].d * y[1].d - x[1].d * y[0].d);
    NEXT();
  }
  op_EqObject: R(in->a).i = R(in->b).ref == R(in->c).ref; NEXT();
  op_NeObject: R(in->a).i = R(in->b).ref != R(in->c).ref; NEXT();

  op_BoxInt: BOX(in->a, Int, word(R(in->b).i)); NEXT();
  op_BoxDouble: BOX(in->a, Double, R(in->b).bits); NEXT();
  op_BoxVector: copy3(&R(in->a + 1), &R(in->b)); R(in->a).bits = Value::head_of(Tag::Vector); NEXT();
  op_BoxMatrix: ANY(in->a) = Value::of(Tag::Matrix, heap_->matrix(SlotType<Matrix3>::from(&R(in->b)))); NEXT();
  op_BoxRef: put_any(&R(in->a), static_cast<Tag>(in->c), R(in->b).bits); NEXT();

  op_ToInt: {
    const Value& v = ANY_OR_RESULT(in->b);
    if (v.tag == Tag::Int) R(in->a).i = v.i;
    else if (v.tag == Tag::Null) { SAVE(); R(in->a).i = null_default(StaticType::Int, in->c, in).i; }
    else R(in->a).i = to_int(v, program_->code().texts[in->c]);
    NEXT();
  }
  op_ToDouble: {
    const Value& v = ANY_OR_RESULT(in->b);
    if (v.tag == Tag::Double) R(in->a).d = v.d;
    else if (v.tag == Tag::Null) { SAVE(); R(in->a).d = null_default(StaticType::Double, in->c, in).d; }
    else R(in->a).d = to_double(v, program_->code().texts[in->c]);
    NEXT();
  }
  op_ToVector: {
    const Value& v = ANY_OR_RESULT(in->b);
    if (v.tag == Tag::Vector) {
      put_vector(&R(in->a), v.v[0], v.v[1], v.v[2]);
    } else if (v.tag == Tag::Null) {
      SAVE();
      null_default(StaticType::Vector, in->c, in);
      put_vector(&R(in->a), 0, 0, 0);
    } else {
      to_vector(v, program_->code().texts[in->c]);
    }
    NEXT();
  }
  op_ToMatrix: {
    Value v = ANY_OR_RESULT(in->b);
    if (v.tag == Tag::Null) { SAVE(); v = null_default(StaticType::Matrix, in->c, in); }
    const auto m = to_matrix(v, program_->code().texts[in->c]);
    std::memcpy(static_cast<void*>(&R(in->a)), m.data(), 9 * sizeof(double));
    NEXT();
  }
  op_ToRef: {
    const Instruction& ext = *pc++;
    const Value& v = ANY_OR_RESULT(in->b);
    if (static_cast<int>(v.tag) == ext.a && v.ref) {
      R(in->a).ref = v.ref;
    } else {
      SAVE();
      R(in->a) = converted_reference(static_cast<StaticType>(ext.a), v, in->c, ext.imm() != 0, in);
    }
    NEXT();
  }
  op_ToAny: copy_any(&R(in->a), result_); NEXT();
  op_ResultInt: R(in->a).i = result_.i; NEXT();
  op_ResultDouble: R(in->a).d = result_.d; NEXT();
  op_ResultVector: put_vector(&R(in->a), result_.v[0], result_.v[1], result_.v[2]); NEXT();
  op_ResultMatrix: std::memcpy(static_cast<void*>(&R(in->a)), result_.matrix()->m.data(), 9 * sizeof(double)); NEXT();
  op_ResultRef: R(in->a).ref = result_.ref; NEXT();
  op_CheckClass: {
    const Instruction& ext = *pc++;
    check_class(static_cast<Instance*>(R(in->a).ref), program_->cls(static_cast<ClassId>(in->imm())),
                program_->code().texts[static_cast<std::size_t>(ext.imm())]);
    NEXT();
  }
  op_Truth: R(in->a).i = true_any(ANY(in->b)); NEXT();
  op_Binary: {
    const Instruction& ext = *pc++;
    const auto op = static_cast<ast::BinaryOp>(ext.a);
    const Value &x = ANY(in->b), &y = ANY(in->c);
    if (x.tag == Tag::Int && y.tag == Tag::Int && (op <= ast::BinaryOp::Mul || op >= ast::BinaryOp::Lt)) {
      ANY(in->a) = Value::of(int_binary(op, x.i, y.i));
    } else if (x.tag == Tag::Double && y.tag == Tag::Double && op <= ast::BinaryOp::Mul) {
      ANY(in->a) = Value::of(op == ast::BinaryOp::Add ? x.d + y.d : op == ast::BinaryOp::Sub ? x.d - y.d : x.d * y.d);
    } else if (x.tag == Tag::Vector && y.tag == Tag::Vector && op <= ast::BinaryOp::Sub) {
      const double s = op == ast::BinaryOp::Add ? 1.0 : -1.0;
      ANY(in->a) = Value::of(Vector3(x.v[0] + s * y.v[0], x.v[1] + s * y.v[1], x.v[2] + s * y.v[2]));
    } else {
      SAVE();
      ANY(in->a) = calculate(op, x, y, ext.b != 0, in);
    }
    NEXT();
  }
#define ARITHMETIC(name, kind, op, of_ints)                                            \
  op_##name: {                                                                         \
    const Value &x = ANY(in->b), &y = ANY_OR_RESULT(in->c);                            \
    if (x.tag == Tag::Int && y.tag == Tag::Int) {                                      \
      BOX(in->a, Int, word(of_ints(x.i, y.i)));                                        \
    } else if (x.tag == Tag::Double && y.tag == Tag::Double) {                         \
      BOX(in->a, Double, word(x.d op y.d));                                            \
    } else {                                                                           \
      SAVE();                                                                          \
      copy_any(&R(in->a), calculate(ast::BinaryOp::kind, x, y, false, in));            \
    }                                                                                  \
    NEXT();                                                                            \
  }
  ARITHMETIC(AddAny, Add, +, wrap_add)
  ARITHMETIC(SubAny, Sub, -, wrap_sub)
  ARITHMETIC(MulAny, Mul, *, wrap_mul)
#undef ARITHMETIC
// A sum of what is known and what is not; `first`: the known one comes first.
#define MIXED_SUM(of_doubles, of_vectors, kind, op, first)                                                        \
  op_##of_doubles: {                                                                                              \
    const Value& v = ANY_OR_RESULT(in->c);                                                                        \
    const double known = R(in->b).d;                                                                              \
    if (v.tag == Tag::Double) {                                                                                   \
      R(in->a).d = first ? known op v.d : v.d op known;                                                           \
    } else if (v.tag == Tag::Int) {                                                                               \
      R(in->a).d = first ? known op v.i : v.i op known;                                                           \
    } else {                                                                                                      \
      SAVE();                                                                                                     \
      R(in->a).d = first ? binary(*heap_, ast::BinaryOp::kind, Value::of(known), v).d                             \
                         : binary(*heap_, ast::BinaryOp::kind, v, Value::of(known)).d;                            \
    }                                                                                                             \
    NEXT();                                                                                                       \
  }                                                                                                               \
  op_##of_vectors: {                                                                                              \
    const Value& v = ANY_OR_RESULT(in->c);                                                                        \
    const Slot* known = &R(in->b);                                                                                \
    if (v.tag != Tag::Vector) [[unlikely]] {                                                                      \
      SAVE();                                                                                                     \
      const Value other = Value::of(Vector3(known[0].d, known[1].d, known[2].d));                                 \
      first ? binary(*heap_, ast::BinaryOp::kind, other, v) : binary(*heap_, ast::BinaryOp::kind, v, other);      \
    }                                                                                                             \
    if (first) put_vector(&R(in->a), known[0].d op v.v[0], known[1].d op v.v[1], known[2].d op v.v[2]);           \
    else put_vector(&R(in->a), v.v[0] op known[0].d, v.v[1] op known[1].d, v.v[2] op known[2].d);                 \
    NEXT();                                                                                                       \
  }
  MIXED_SUM(AddDoubleAny, AddVectorAny, Add, +, true)
  MIXED_SUM(SubDoubleAny, SubVectorAny, Sub, -, true)
  MIXED_SUM(AddAnyDouble, AddAnyVector, Add, +, false)
  MIXED_SUM(SubAnyDouble, SubAnyVector, Sub, -, false)
#undef MIXED_SUM
  op_Negate: ANY(in->a) = negate(ANY(in->b)); NEXT();
  op_Magnitude: ANY(in->a) = magnitude(ANY(in->b)); NEXT();
  op_RandomInt: R(in->a).i = world_.random().below_or_equal(R(in->b).i); NEXT();
  op_RandomDouble: R(in->a).d = R(in->b).d * world_.random().uniform(); NEXT();
  op_RandomVector: {
    const Slot* x = &R(in->b);
    const double r0 = world_.random().uniform(), r1 = world_.random().uniform(), r2 = world_.random().uniform();
    put_vector(&R(in->a), x[0].d * r0, x[1].d * r1, x[2].d * r2);
    NEXT();
  }
  op_RandomAny: ANY(in->a) = random(ANY(in->b)); NEXT();

  op_Jump: JUMP(); NEXT();
  op_Loop:
    COUNT_CALL();
    JUMP();
    NEXT();
#define JUMP_BACK(distance)              \
  do {                                   \
    const std::int32_t far = (distance); \
    if (far < 0) COUNT_CALL();           \
    pc += far;                           \
  } while (0)
  op_JumpIfInt: if (R(in->a).i) JUMP_BACK(in->imm()); NEXT();
  op_JumpIfNotInt: if (!R(in->a).i) JUMP_BACK(in->imm()); NEXT();
  op_JumpIfDouble: if (R(in->a).d != 0) JUMP_BACK(in->imm()); NEXT();
  op_JumpIfNotDouble: if (!(R(in->a).d != 0)) JUMP_BACK(in->imm()); NEXT();
  op_JumpIfObject: if (true_object(R(in->a).ref)) JUMP_BACK(in->imm()); NEXT();
  op_JumpIfNotObject: if (!true_object(R(in->a).ref)) JUMP_BACK(in->imm()); NEXT();
  op_JumpIfAny: if (true_any(ANY_OR_RESULT(in->a))) JUMP_BACK(in->imm()); NEXT();
  op_JumpIfNotAny: if (!true_any(ANY_OR_RESULT(in->a))) JUMP_BACK(in->imm()); NEXT();
#define COMPARE_JUMP(name, field, op, wanted) \
  op_##name: if ((R(in->a).field op R(in->b).field) == wanted) JUMP_BACK(static_cast<std::int16_t>(in->c)); NEXT();
  COMPARE_JUMP(JumpUnlessLtInt, i, <, false)
  COMPARE_JUMP(JumpUnlessLeInt, i, <=, false)
  COMPARE_JUMP(JumpUnlessEqInt, i, ==, false)
  COMPARE_JUMP(JumpUnlessNeInt, i, !=, false)
  COMPARE_JUMP(JumpUnlessLtDouble, d, <, false)
  COMPARE_JUMP(JumpUnlessLeDouble, d, <=, false)
  COMPARE_JUMP(JumpUnlessEqDouble, d, ==, false)
  COMPARE_JUMP(JumpUnlessNeDouble, d, !=, false)
  COMPARE_JUMP(JumpIfLtInt, i, <, true)
  COMPARE_JUMP(JumpIfLeInt, i, <=, true)
  COMPARE_JUMP(JumpIfEqInt, i, ==, true)
  COMPARE_JUMP(JumpIfNeInt, i, !=, true)
  COMPARE_JUMP(JumpIfLtDouble, d, <, true)
  COMPARE_JUMP(JumpIfLeDouble, d, <=, true)
  COMPARE_JUMP(JumpIfEqDouble, d, ==, true)
  COMPARE_JUMP(JumpIfNeDouble, d, !=, true)
#undef COMPARE_JUMP
#define SMALL_JUMP(name, op) \
  op_##name: if (R(in->a).i op static_cast<std::int16_t>(in->b)) JUMP_BACK(static_cast<std::int16_t>(in->c)); NEXT();
  SMALL_JUMP(JumpIfLtSmall, <)
  SMALL_JUMP(JumpIfLeSmall, <=)
  SMALL_JUMP(JumpIfGtSmall, >)
  SMALL_JUMP(JumpIfGeSmall, >=)
  SMALL_JUMP(JumpIfEqSmall, ==)
  SMALL_JUMP(JumpIfNeSmall, !=)
#undef SMALL_JUMP
// The end of a `for` that counts: step and test in one.
#define STEP_JUMP(name, op, limit)                                      \
  op_##name: {                                                          \
    const Instruction& ext = EXT(0);                                    \
    R(in->a).i = wrap_add(R(in->a).i, static_cast<std::int16_t>(ext.a)); \
    if (R(in->a).i op (limit)) JUMP_BACK(static_cast<std::int16_t>(in->c)); \
    else ++pc;                                                          \
    NEXT();                                                             \
  }
  STEP_JUMP(StepJumpIfLt, <, R(in->b).i)
  STEP_JUMP(StepJumpIfLe, <=, R(in->b).i)
  STEP_JUMP(StepJumpIfLtImm, <, ext.imm())
#undef STEP_JUMP

  op_NewList: R(in->a).ref = heap_->list(static_cast<std::uint32_t>(in->imm())); NEXT();
  op_Append: op_Push: heap_->push(*LIST(in->a), ANY(in->b)); NEXT();
  op_PushInt:
    if (!heap_->push_slot(*LIST(in->a), Tag::Int, word(R(in->b).i))) heap_->push(*LIST(in->a), Value::of(R(in->b).i));
    NEXT();
  op_PushDouble:
    if (!heap_->push_slot(*LIST(in->a), Tag::Double, R(in->b).bits)) heap_->push(*LIST(in->a), Value::of(R(in->b).d));
    NEXT();
  op_PushRef:
    if (!heap_->push_slot(*LIST(in->a), static_cast<Tag>(in->c), R(in->b).bits)) heap_->push(*LIST(in->a), Value::of(static_cast<Tag>(in->c), R(in->b).ref));
    NEXT();
  op_Prepend: heap_->prepend(*LIST(in->a), ANY(in->b)); NEXT();
  op_Pop: ANY(in->a) = LIST(in->b)->size == 0 ? Value() : heap_->pop(*LIST(in->b)); NEXT();
  op_Unprepend: ANY(in->a) = LIST(in->b)->size == 0 ? Value() : heap_->unprepend(*LIST(in->b)); NEXT();
  op_Insert:
    SAVE();
    if (!insert_at(*heap_, *LIST(in->a), ANY(in->c), ANY(in->b))) {
      if (host_.strict) throw RunError(RunErrorKind::Bounds, "insert beyond the end of the list");
      warn("insert beyond the end of the list: nothing is inserted");
    }
    NEXT();
  op_Remove: {
    SAVE();
    bool found = false;
    ANY(in->a) = remove_at(*heap_, ANY(in->b), ANY(in->c), found);
    if (!found && ANY(in->b).tag == Tag::List) {
      if (host_.strict) throw RunError(RunErrorKind::Bounds, "remove beyond the end of the list");
      warn("remove beyond the end of the list: nothing is removed");
    }
    NEXT();
  }
  op_CopyList: R(in->a).ref = heap_->copy(*LIST(in->b)); NEXT();
  op_Sort:
    SAVE();
    sort(*LIST(in->a), static_cast<Symbol>(in->imm()), *self);
    LEAVE_IF_FREED();
    NEXT();
  op_Index: SAVE(); ANY(in->a) = read_index(ANY(in->b), ANY(in->c)); NEXT();
  op_IndexGuarded: SAVE(); ANY(in->a) = guarded_index(ANY(in->b), ANY(in->c)); NEXT();
  op_IndexList: {
    const auto& list = *LIST(in->b);
    copy_element(&R(in->a), list, list_position(list, R(in->c).i));
    NEXT();
  }
  op_SetIndex: {
    const Instruction& ext = *pc++;
    SAVE();
    if (write_index(ANY(in->a), ANY(in->b), ANY(in->c))) pc += ext.imm();
    NEXT();
  }
  op_SetIndexList: {
    auto& list = *LIST(in->a);
    const auto i = static_cast<std::uint32_t>(R(in->b).i);
    if (i < list.size) heap_->set(list, i, ANY(in->c));
    else if (i == list.size) heap_->push(list, ANY(in->c));
    else fail_list_bounds(R(in->b).i, list.size);
    NEXT();
  }
  op_Member: {
    const auto& site = program_->code().members[static_cast<std::size_t>((pc++)->imm())];
    SAVE();
    ANY(in->a) = read_member(ANY(in->b), site);
    NEXT();
  }
  op_SetMember: {
    const auto& site = program_->code().members[static_cast<std::size_t>(EXT(0).imm())];
    const Instruction& jump = EXT(1);
    pc += 2;
    SAVE();
    if (write_member(ANY(in->a), site, ANY(in->b))) pc += jump.imm();
    NEXT();
  }
  op_Foreach: {
    const Instruction& ext = *pc++;
    const auto& list = *LIST(in->a);
    const auto i = static_cast<std::uint32_t>(R(in->b).i);
    if (i < list.size) {
      copy_element(&R(in->c), list, i);
      R(in->b).i = static_cast<std::int32_t>(i + 1);
      JUMP_BACK(ext.imm());
    }
    NEXT();
  }
  op_ForeachObject: {
    const Instruction& ext = EXT(0);
    const Instruction& what = EXT(1);
    const auto& list = *LIST(in->a);
    const auto i = static_cast<std::uint32_t>(R(in->b).i);
    if (i < list.size) {
      pc += 1;
      R(in->b).i = static_cast<std::int32_t>(i + 1);
      const Value element = list[i];
      if (element.tag == Tag::Object) R(in->c).ref = element.ref;
      else { SAVE(); R(in->c) = converted_reference(StaticType::Object, element, static_cast<std::uint32_t>(what.imm()), false, in); }
      JUMP_BACK(ext.imm());
    } else {
      pc += 2;
    }
    NEXT();
  }

  op_New: SAVE(); R(in->a).ref = create(program_->cls(static_cast<ClassId>(in->imm()))); SAFE_POINT(); LEAVE_IF_FREED(); NEXT();
  op_NewCount: {
    const Instruction& ext = *pc++;
    SAVE();
    ANY(in->a) = make_many(ANY(in->b), program_->cls(static_cast<ClassId>(ext.imm())));
    SAFE_POINT();
    LEAVE_IF_FREED();
    NEXT();
  }
  op_NewNamed: fail_unknown_class(program_->code().strings[static_cast<std::size_t>(in->imm())]);
  op_All: R(in->a).ref = all_of(program_->cls(static_cast<ClassId>(in->imm()))); NEXT();

  {
    Instance* receiver;
    std::uint32_t site;
    const Plan* plan;
  op_Call:
    receiver = static_cast<Instance*>(R(in->a).ref);
    site = static_cast<std::uint32_t>(in->imm());
    SAVE();
    if (!receiver || !receiver->live()) [[unlikely]] fail_receiver(receiver, site);
    goto do_call;
  op_CallSelf:
    receiver = self;
    site = static_cast<std::uint32_t>(in->imm());
    SAVE();
    goto do_call;
  op_CallSuper:
    receiver = self;
    site = static_cast<std::uint32_t>(in->imm());
    SAVE();
    if (!program_->code().sites[site].super_of->parent) fail_receiver(nullptr, site);
  do_call:
    plan = &plan_for(site, *receiver->cls);
    COUNT_CALL();
    if (!plan->method) {
      RESULT(Null, 0);
      NEXT();
    }
    if (plan->method->native) {
      if constexpr (kProfiled) call_native_profiled(*plan, *receiver, base);
      else call_native(*plan, *receiver, base);
      LEAVE_IF_FREED();
      NEXT();
    }
    const Slot* caller = base;
    if constexpr (kProfiled) profile_call(*plan->method);
    frame = enter(*plan->method, *receiver);
    base = frame->base();
    apply(*plan, caller, base);
    self = receiver;
    numbers = frame->function->numbers.data();
    pc = frame->function->code.data();
    NEXT();
  }
  op_ResolveCall: {
    const auto number = static_cast<std::uint32_t>((pc++)->imm());
    SAVE();
    Instance* receiver = in->a == kResult ? self : static_cast<Instance*>(R(in->a).ref);
    if (!receiver || !receiver->live()) fail_receiver(receiver, number);
    const auto& site = program_->code().sites[number];
    if (site.super_of && !site.super_of->parent) fail_receiver(nullptr, number);
    const Plan& plan = plan_for(number, *receiver->cls);
    R(in->b).i = 0;
    R(in->b + 1).bits = reinterpret_cast<std::uintptr_t>(&plan);
    pc = frame->function->code.data() + (plan.order.empty() ? site.call : site.arguments[plan.order[0]].block);
    NEXT();
  }
  op_NextArgument: {
    const auto& site = program_->code().sites[static_cast<std::size_t>(in->imm())];
    const auto& order = reinterpret_cast<const Plan*>(static_cast<std::uintptr_t>(R(in->a + 1).bits))->order;
    const auto next = static_cast<std::size_t>(++R(in->a).i);
    pc = frame->function->code.data() + (next >= order.size() ? site.call : site.arguments[order[next]].block);
    NEXT();
  }
  op_Broadcast: {
    const Instruction& ext = *pc++;
    const Value& value = ANY(in->a);
    SAVE();
    if (value.tag == Tag::Object) {
      R(in->b).ref = value.ref;
      R(in->c).ref = nullptr;
    } else if (value.tag == Tag::List) {
      auto* elements = heap_->list();  // the call goes to those who are in the list now
      if (value.ref)
        for (const auto& element : *value.list()) heap_->push(*elements, element);
      R(in->c).ref = elements;
      R(ext.a).i = 0;
      if (elements->size == 0) {
        result_ = Value();
        pc += ext.imm();
      } else {
        R(in->b).ref = broadcast_member((*elements)[0]);
      }
    } else {
      fail_call_on(value);
    }
    NEXT();
  }
  op_BroadcastNext: {
    const Instruction& ext = *pc++;
    if (R(in->c).ref) {
      const auto& elements = *LIST(in->c);
      const auto i = static_cast<std::uint32_t>(++R(ext.a).i);
      if (i < elements.size) {
        SAVE();
        R(in->b).ref = broadcast_member(elements[i]);
        pc += ext.imm();
        COUNT_CALL();
      }
    }
    NEXT();
  }
  op_Function: {
    SAVE();
    poll();
    const auto& callee = functions_[static_cast<std::size_t>(in->imm())];
    if constexpr (kProfiled) call_function_profiled(callee, *self, &R(in->a), result_);
    else callee.function(*this, *self, &R(in->a), result_);
    COUNT_CALL();
    LEAVE_IF_FREED();
    NEXT();
  }
  op_Foreign:
    SAVE();
    poll();
    call_foreign(static_cast<std::size_t>(in->imm()), *self, &R(in->a));
    COUNT_CALL();
    LEAVE_IF_FREED();
    NEXT();
  op_Interpolate: {
    const Instruction& ext = *pc++;
    SAVE();
    R(in->a).ref = interpolate(program_->code().interpolations[static_cast<std::size_t>(ext.imm())], &ANY(in->b), in->c);
    NEXT();
  }
  op_Print: SAVE(); print_value(ANY(in->a), in->b); NEXT();
  op_Free:
    SAVE();
    free_value(ANY(in->a));
    LEAVE_IF_FREED();
    NEXT();
  op_Die: SAVE(); throw RunError(RunErrorKind::User, text(ANY(in->a)));
  op_FailIfStrict:
    if (!host_.strict) NEXT();
  op_Fail: throw RunError(static_cast<RunErrorKind>(in->a), program_->code().texts[static_cast<std::size_t>(in->imm())]);

  op_ReturnInt: RESULT(Int, word(R(in->a).i)); goto do_return;
  op_ReturnDouble: RESULT(Double, R(in->a).bits); goto do_return;
  op_ReturnVector:
    result_.head = Value::head_of(Tag::Vector);
    copy3(reinterpret_cast<Slot*>(result_.bits), &R(in->a));
    goto do_return;
  op_ReturnMatrix: result_ = Value::of(Tag::Matrix, heap_->matrix(SlotType<Matrix3>::from(&R(in->a)))); goto do_return;
  op_ReturnRef: put_any(reinterpret_cast<Slot*>(&result_), static_cast<Tag>(in->b), R(in->a).bits); goto do_return;
  op_ReturnAny: copy_any(result_, ANY(in->a)); goto do_return;
  op_ReturnNull: RESULT(Null, 0); goto do_return;
  op_ReturnResult:
  do_return:
    leave();
    if (depth_ == depth) return;
    if constexpr (kProfiled) profile_leave();
    RELOAD();
    LEAVE_IF_FREED();
    NEXT();
  } catch (...) {
    if constexpr (kProfiled) profile_unwind(profiled_depth);
    rethrow(depth, pc);
  }
}
// clang-format on

template void Machine::execute<false>(std::size_t depth);
template void Machine::execute<true>(std::size_t depth);

}  // namespace breve::steve

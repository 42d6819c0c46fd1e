// The instructions of the register machine. A register is a frame slot (8 untagged bytes); a vector takes three, a
// matrix nine, a dynamic value four. What kind of value a slot holds never changes within a function.
#pragma once

#include <cstdint>
#include <vector>

#include "steve/code/program.hpp"

namespace breve::steve {

// Operands: a, b, c are slots unless said; imm is the 32 bits of b and c. "ext": the next instruction word is data.
// clang-format off
#define BREVE_OPCODES(X) \
  /* moves and constants */ \
  X(Mov1) X(Mov3) X(Mov9) X(MovAny) \
  X(LoadInt)      /* a = imm */ \
  X(LoadDouble)   /* a = numbers[imm] */ \
  X(LoadVector)   /* a = numbers[imm..imm+2] */ \
  X(LoadMatrix)   /* a = numbers[imm..imm+8] */ \
  X(LoadString)   /* a = string constant imm */ \
  X(LoadSelf)     /* a = self */ \
  X(ZeroRef)      /* a = null */ \
  X(ZeroAny)      /* a = NULL */ \
  X(EnsureList) X(EnsureHash)   /* make the list or hash of a local that has none yet */ \
  /* instance variables: imm is the slot in the instance */ \
  X(GetVar1) X(GetVar3) X(GetVar9) X(GetVarList) X(GetVarHash) \
  X(SetVar1) X(SetVar3) X(SetVar9) X(SetVarRef) \
  /* arrays */ \
  X(ArraySlot)    /* a = base + index b * size; ext words: count, base; c = size */ \
  X(ArrayGet)     /* a = slot [b] of frame (c bit 7) or instance; low bits of c: slots */ \
  X(ArraySet)     /* slot [b] = a */ \
  X(ArraySetRef) \
  X(ArrayGetList) X(ArrayGetHash) \
  /* int */ \
  X(AddInt) X(SubInt) X(MulInt) X(DivInt) X(ModInt) X(PowInt) X(NegInt) X(AbsInt) X(AddIntImm) \
  X(MulIntImm) X(DivIntImm) X(ModIntImm)  /* a = b op c, c a number that is neither 0 nor -1 */ \
  X(LtInt) X(LeInt) X(EqInt) X(NeInt) X(NotInt) \
  /* double */ \
  X(AddDouble) X(SubDouble) X(MulDouble) X(DivDouble) \
  X(AddConstant) X(MulConstant) X(DivConstant)  /* a = b op numbers[c], double */ \
  X(ConstantSub) X(ConstantDiv)   /* a = numbers[c] op b */ \
  X(IntMulConstant)               /* double a = int b * numbers[c] */ \
  X(MulAdd) X(MulSub) X(SubMul)   /* a = b * c + d, b * c - d, d - b * c; ext.a: d */ \
  X(MulConstantAdd) X(MulConstantSub) X(SubMulConstant) /* the same with numbers[c] */ \
  X(AddAddConstant) X(SubAddConstant) /* a = b + c + numbers[ext.a], b - c + numbers[ext.a] */ \
  X(ModDouble) X(PowDouble) X(NegDouble) X(AbsDouble) \
  X(LtDouble) X(LeDouble) X(EqDouble) X(NeDouble) \
  X(IntToDouble) X(DoubleToInt) \
  /* vector */ \
  X(AddVector) X(SubVector) X(NegVector) X(ScaleVector) X(DivVector) X(EqVector) X(NeVector) X(Length) X(Dot) X(Cross) \
  X(MulAddVector) X(MulSubVector) X(SubMulVector) /* a = b * double c + d, b * c - d, d - b * c; ext.a: d */ \
  X(EqObject) X(NeObject) \
  /* dynamic values */ \
  X(BoxInt) X(BoxDouble) X(BoxVector) X(BoxMatrix) \
  X(BoxRef)       /* c = tag */ \
  X(ToInt) X(ToDouble) X(ToVector) X(ToMatrix) /* a = converted b (kResult: the result register); c: text number of what is assigned */ \
  X(ToRef)        /* ext.a = StaticType */ \
  X(ToAny)        /* a = result register */ \
  X(ResultInt) X(ResultDouble) X(ResultVector) X(ResultMatrix) X(ResultRef) /* a = result register, type known */ \
  X(CheckClass)   /* object a is null or an instance of class imm; ext.imm: text number */ \
  X(Truth)        /* int a = truth of any b */ \
  X(Binary)       /* any a = b op c; ext.a: ast::BinaryOp; ext.b: kAbsentIsZero or 0 */ \
  X(AddAny) X(SubAny) X(MulAny)   /* any a = any b op any c (kResult: the result register) */ \
  X(AddDoubleAny) X(SubDoubleAny) X(AddAnyDouble) X(SubAnyDouble) /* double a = b op c, c op b; double b, any c or kResult */ \
  X(AddVectorAny) X(SubVectorAny) X(AddAnyVector) X(SubAnyVector) /* the same with vectors a and b */ \
  X(Negate) X(Magnitude) X(RandomInt) X(RandomDouble) X(RandomVector) X(RandomAny) \
  /* jumps: imm is relative to the next instruction */ \
  X(Jump) X(Loop) \
  X(JumpIfInt) X(JumpIfNotInt) X(JumpIfDouble) X(JumpIfNotDouble) X(JumpIfObject) X(JumpIfNotObject) \
  X(JumpIfAny) X(JumpIfNotAny) \
  X(JumpUnlessLtInt) X(JumpUnlessLeInt) X(JumpUnlessEqInt) X(JumpUnlessNeInt)  /* a, b; c: signed distance */ \
  X(JumpUnlessLtDouble) X(JumpUnlessLeDouble) X(JumpUnlessEqDouble) X(JumpUnlessNeDouble) \
  /* a jump back counts as a loop iteration */ \
  X(JumpIfLtInt) X(JumpIfLeInt) X(JumpIfEqInt) X(JumpIfNeInt) \
  X(JumpIfLtDouble) X(JumpIfLeDouble) X(JumpIfEqDouble) X(JumpIfNeDouble) \
  X(JumpIfLtSmall) X(JumpIfLeSmall) X(JumpIfGtSmall) X(JumpIfGeSmall) X(JumpIfEqSmall) X(JumpIfNeSmall) /* int a, number b */ \
  X(StepJumpIfLt) X(StepJumpIfLe) X(StepJumpIfLtImm) /* a += ext.a, then the test against b or ext.imm */ \
  /* containers */ \
  X(NewList)      /* a = list; imm: capacity */ \
  X(Append)       /* list a gets any b */ \
  X(Push) X(Prepend)            /* list a gets any b */ \
  X(PushInt) X(PushDouble) X(PushRef) /* list a gets b; c: tag of a reference */ \
  X(Pop) X(Unprepend)           /* any a from list b */ \
  X(Insert)       /* list a, any value b, any index c */ \
  X(Remove)       /* any a = removed from any b at any c */ \
  X(CopyList)     /* list a = copy of list b */ \
  X(Sort)         /* list a by method symbol imm */ \
  X(Index)        /* any a = any b {any c} */ \
  X(IndexGuarded) /* the same; an error is reported and gives NULL */ \
  X(IndexList)    /* any a = list b {int c} */ \
  X(SetIndex)     /* any a {any b} = any c; ext.imm: jump if a was a container, else a is the changed value */ \
  X(SetIndexList) /* list a {int b} = any c */ \
  X(Member)       /* any a = any b ::name; ext.imm: member site */ \
  X(SetMember)    /* any a ::name = any b; ext words: member site, jump */ \
  X(Foreach)      /* any c = next of list a by counter b, and jump by ext.imm; no jump when done */ \
  X(ForeachObject)/* object c likewise, falls back to conversion; ext words: jump, text number */ \
  /* objects and calls */ \
  X(New)          /* object a of class imm */ \
  X(NewCount)     /* any a = any b new class ext.imm */ \
  X(NewNamed)     /* a class that is not known: error when it runs; imm: string */ \
  X(All)          /* list a of live instances of class imm */ \
  X(Call)         /* object a, site imm */ \
  X(CallSelf) X(CallSuper)      /* site imm */ \
  X(ResolveCall)  /* a: receiver, b: counter slot; ext.imm: site; goes on with the first argument */ \
  X(NextArgument) /* a: counter slot; imm: site */ \
  X(Broadcast)    /* any a; object b; c: list slot, counter slot c+... ext words: counter slot, jump when empty */ \
  X(BroadcastNext)/* object b from list c; ext words: counter slot, jump back */ \
  X(Function)     /* native function imm, arguments from slot a */ \
  X(Foreign)      /* foreign function imm, likewise */ \
  X(Interpolate)  /* string a from b.. (any), c values; ext.imm: literal texts */ \
  X(Print)        /* any a; b: 1 space after, 2 newline after */ \
  X(Free) X(Die) \
  X(ReturnInt) X(ReturnDouble) X(ReturnVector) X(ReturnMatrix) X(ReturnRef) /* b: tag */ X(ReturnAny) X(ReturnNull) \
  X(ReturnResult) /* the result register as the last call left it */ \
  X(FailIfStrict) /* the same, in strict mode only */ \
  X(Fail)         /* a run-time error; imm: text number; a: RunErrorKind */
// clang-format on

enum class Op : std::uint16_t {
#define X(name) name,
  BREVE_OPCODES(X)
#undef X
};

inline constexpr std::uint16_t kResult = 0xffff;    // operand b of To...: the result register
inline constexpr std::uint16_t kFrameArray = 0x80;  // flag in c of ArrayGet and ArraySet
inline constexpr std::uint32_t kMaxSlots = 0xfff0;

struct Instruction {
  Op op{};
  std::uint16_t a = 0, b = 0, c = 0;

  std::int32_t imm() const {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(b) | static_cast<std::uint32_t>(c) << 16);
  }
  void set_imm(std::int32_t v) {
    b = static_cast<std::uint16_t>(static_cast<std::uint32_t>(v) & 0xffff);
    c = static_cast<std::uint16_t>(static_cast<std::uint32_t>(v) >> 16);
  }
};
static_assert(sizeof(Instruction) == 8);

constexpr std::int32_t kAbsentIsZero = 1;  // of Binary: a missing value of b is not a mistake

/// One body of code.
struct Function {
  std::vector<Instruction> code;
  std::vector<Span> spans;  // one for each instruction
  std::vector<double> numbers;
  std::uint32_t frame_slots = 0;
  std::uint32_t parameter_slots = 0;  // the first ones: written by the caller
  std::uint32_t zeroed_slots = 0;     // up to here set to zero at entry: locals, all that the collector looks at
  std::vector<std::uint16_t> reference_slots;
  std::vector<std::uint16_t> any_slots;  // first slot of each dynamic value
};

/// A place in a program from which a method is called. Resolution per receiver class is cached in the world.
struct CallSite {
  struct Argument {
    Symbol keyword;
    StaticType type;
    std::uint16_t slot;
    std::int32_t block = -1;  // where its code starts, if the order of evaluation depends on the receiver
    Span span;
  };
  Symbol selector = kNoSymbol;
  std::vector<Argument> arguments;
  const ClassInfo* super_of = nullptr;  // CallSuper: the class whose parent is asked
  std::int32_t call = -1;               // where the call stands, for NextArgument
  Span span;
  const ClassInfo* in_class = nullptr;
};

struct MemberSite {
  Symbol name = kNoSymbol;
  std::uint32_t string = 0;  // the same as a string constant, for hashes
  std::int32_t axis = -1;    // 0..2 for x, y, z
};

/// Everything that the functions of a program refer to by number.
struct CodeTables {
  std::vector<std::string> strings;  // string constants
  std::vector<std::string> texts;    // what conversions name in errors
  std::vector<CallSite> sites;
  std::vector<MemberSite> members;
  std::vector<std::vector<std::string>> interpolations;
};

}  // namespace breve::steve

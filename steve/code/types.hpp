// What instructions and signatures say about values: their types, the tags of dynamic values, the kinds of errors.
#pragma once

#include <cstdint>

#include "steve/syntax/ast.hpp"

namespace breve::steve {

/// What a dynamic value is.
enum class Tag : std::uint8_t { Null, Int, Double, Vector, Matrix, String, Object, List, Hash, Pointer, Data };

/// A type as the compiler knows it. Any: a dynamic value with its tag.
enum class StaticType : std::uint8_t {
  Null,
  Int,
  Double,
  Vector,
  Matrix,
  String,
  Object,
  List,
  Hash,
  Pointer,
  Data,
  Any
};

int slot_count(StaticType type);
inline StaticType static_type(ast::TypeKind kind) {
  return static_cast<StaticType>(static_cast<int>(kind) + 1);  // KEEP IN STEP: ast::TypeKind, StaticType
}
static_assert(static_cast<int>(ast::TypeKind::Int) + 1 == static_cast<int>(StaticType::Int));
static_assert(static_cast<int>(ast::TypeKind::Data) + 1 == static_cast<int>(StaticType::Data));
static_assert(static_cast<int>(Tag::Data) == static_cast<int>(StaticType::Data));

/// The kinds of run-time errors.
enum class RunErrorKind : std::uint8_t {
  User,
  Internal,
  Type,
  Array,
  Conversion,
  FreedObject,
  NullObject,
  Math,
  World,
  Bounds,
  UnknownClass,
  UnknownMethod,
  UnknownKeyword,
  MissingKeyword,
  Depth,
  Budget,
  Interrupted,
};

}  // namespace breve::steve

// Operations on values whose types are known only at run time: conversion, truth, operators, indexing, text.
// Every function throws RunError.
#pragma once

#include <bit>
#include <cmath>
#include <string>

#include "steve/code/numbers.hpp"
#include "steve/machine/heap.hpp"
#include "steve/syntax/ast.hpp"

namespace breve::steve {

// Conversion on assignment. `what` names the place for the error: "variable 'n'", "keyword 'to'".
// The NULL value is not converted: the caller stores the type's zero value and warns.
std::int32_t to_int(const Value& v, std::string_view what = {});
double to_double(const Value& v, std::string_view what = {});
Vector3 to_vector(const Value& v, std::string_view what = {});
Matrix3 to_matrix(const Value& v, std::string_view what = {});
StringCell* to_string(Heap& heap, const Value& v, std::string_view what = {});
Instance* to_object(const Value& v, std::string_view what = {});  // null for 0; no class check
ListCell* to_list(const Value& v, std::string_view what = {});
HashCell* to_hash(const Value& v, std::string_view what = {});
PointerCell* to_pointer(const Value& v, std::string_view what = {});
DataCell* to_data(const Value& v, std::string_view what = {});

// Integer arithmetic that wraps.
inline std::int32_t wrap_add(std::int32_t a, std::int32_t b) {
  return std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
inline std::int32_t wrap_sub(std::int32_t a, std::int32_t b) {
  return std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
inline std::int32_t wrap_mul(std::int32_t a, std::int32_t b) {
  return std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b));
}
inline std::int32_t wrap_negate(std::int32_t a) { return wrap_sub(0, a); }
std::int32_t divide(std::int32_t a, std::int32_t b);     // RunError{Math} for 0 and for INT_MIN / -1
std::int32_t remainder(std::int32_t a, std::int32_t b);  // sign of a; RunError{Math} for 0
inline std::int32_t power(std::int32_t a, std::int32_t b) {
  return truncate_to_int(std::pow(static_cast<double>(a), static_cast<double>(b)));
}
double divide(double a, double b);     // RunError{Math} for 0.0
double remainder(double a, double b);  // sign of a; RunError{Math} for 0.0
/// RunError{Math} if |det m| < 1e-21.
Matrix3 inverse(const Matrix3& m);
[[noreturn]] void fail_division_by_zero();
[[noreturn]] void fail_type(const std::string& message);

inline double length(const Vector3& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

bool truth(const Value& v);  // 5.3

/// Binary operators but && and ||. Never changes its operands.
Value binary(Heap& heap, ast::BinaryOp op, const Value& a, const Value& b);
bool equal(const Value& a, const Value& b);  // `==` as lists compare their elements: what cannot be compared differs
Value negate(const Value& v);
Value magnitude(const Value& v);  // |e|
/// Same type and value, as hash keys compare.
bool same_key(const Value& a, const Value& b);
std::uint32_t key_hash(const Value& v);  // never 0xffffffff; needs no address

/// base{index} for list, hash, vector, matrix, string (objects are the interpreter's business). A missing hash key is
/// NULL.
Value index(Heap& heap, const Value& base, const Value& key);
/// list{i} = v, hash{k} = v.
void set_index(Heap& heap, const Value& base, const Value& key, const Value& value);
/// A vector, matrix or string with one element replaced (6.6, 8.4): the caller stores the result where it came from.
Value with_index(Heap& heap, const Value& base, const Value& key, const Value& value);

/// base::name for hashes and, with the names x, y, z, vectors (the interpreter handles objects).
Value member(Heap& heap, const Value& base, StringCell* name);
/// hash::name = v.
void set_member(Heap& heap, const Value& base, StringCell* name, const Value& value);
/// A vector with component x, y or z replaced.
Value with_member(const Value& base, StringCell* name, const Value& value);

// The list operations of 8.1 with their conversions and errors. A null list is an empty one.
/// @return  false if the index is beyond the end: nothing is inserted, the caller warns
bool insert_at(Heap& heap, ListCell& list, const Value& index, const Value& value);
/// remove list{i}, remove hash{k}: the element, or NULL with `found` false (for a list: the caller warns).
Value remove_at(Heap& heap, const Value& base, const Value& index, bool& found);
/// A position of list{i} that exists. RunError{Bounds} otherwise.
inline std::uint32_t list_position(const ListCell& list, std::int32_t i);
[[noreturn]] void fail_list_bounds(std::int64_t i, std::size_t size);
inline std::uint32_t list_position(const ListCell& list, std::int32_t i) {
  if (static_cast<std::uint32_t>(i) >= list.size) fail_list_bounds(i, list.size);
  return static_cast<std::uint32_t>(i);
}

/// "an int", "a vector", "no value (NULL)": for messages.
std::string a_type(Tag tag);

/// The text of a value as `print` shows it. No recursion limit is reached by deep lists: nesting beyond 1,000 is
/// shown as "{ ... }".
/// @param describe  asked for the text behind an object's address (its get-description); may be empty
/// @param heap      needed if `describe` may run script: keeps nested lists alive across it
using Describe = std::function<std::string(Instance&)>;
void append_text(std::string& out, const Value& v, const Describe& describe = {}, Heap* heap = nullptr);
std::string text(const Value& v, const Describe& describe = {}, Heap* heap = nullptr);
StringCell* number_to_string(Heap& heap, std::int32_t i);
StringCell* number_to_string(Heap& heap, double d);

}  // namespace breve::steve

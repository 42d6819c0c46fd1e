// The meaning of values where types are not known before: conversion, truth, operators, indexing, text.
// Language document, sections 5, 6.4, 6.6, 8.4 and 9, with the fixes of section 14. Every function throws RunError.
#pragma once

#include <string>

#include "steve/machine/heap.hpp"
#include "steve/syntax/ast.hpp"

namespace breve::steve {

// Conversion on assignment (5.2). `what` names the place for the error: "variable 'n'", "keyword 'to'".
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

bool truth(const Value& v);  // 5.3

/// Binary operators but && and || (5.4 to 5.6). Never changes its operands.
Value binary(Heap& heap, ast::BinaryOp op, const Value& a, const Value& b);
bool equal(const Value& a, const Value& b);  // `==` as lists compare their elements
Value negate(const Value& v);
Value magnitude(const Value& v);  // |e|
/// Same type and value, as hash keys compare (8.2).
bool same_key(const Value& a, const Value& b);
std::uint32_t key_hash(const Value& v);

/// base{index} for list, hash, vector, matrix, string (objects are the interpreter's business). A missing hash key is NULL.
Value index(Heap& heap, const Value& base, const Value& key);
/// list{i} = v, hash{k} = v.
void set_index(Heap& heap, const Value& base, const Value& key, const Value& value);
/// A vector, matrix or string with one element replaced (6.6, 8.4): the caller stores the result where it came from.
Value with_index(Heap& heap, const Value& base, const Value& key, const Value& value);

/// The text of a value as `print` shows it (9). No recursion limit is reached by deep lists: nesting beyond 1,000 is
/// shown as "{ ... }".
/// @param describe  asked for the text behind an object's address (its get-description); may be empty
using Describe = std::function<std::string(Instance&)>;
void append_text(std::string& out, const Value& v, const Describe& describe = {});
std::string text(const Value& v, const Describe& describe = {});

}  // namespace breve::steve

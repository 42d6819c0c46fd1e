// Pieces of code as text: ( 1 2.5 TRUE [1 0 0] INTEGER.+ x ( ... ) ).
#pragma once

#include <string>
#include <string_view>

#include "runtime/base/poll.hpp"
#include "runtime/learn/push/code.hpp"

namespace breve::push {

/// Read one expression; several stand in a list of their own, and none is the empty list.
/// @throws Error{Argument} that names the character: a parenthesis too many or too few, a number out of range
Code parse(std::string_view text, std::pmr::memory_resource* memory, const Poll& poll = {});
/// Read expressions into a builder.
void parse_into(std::string_view text, Builder& builder, const Poll& poll = {});
/// Can this text stand for a name: one word that is neither a number, a truth value nor an instruction?
bool is_name(std::string_view text);

/// What parse() reads back as the same code: floats have a point or an exponent, and all digits that they need.
void print(const Code& code, std::pmr::string& out);
void print(const Node& atom, std::pmr::string& out);

}  // namespace breve::push

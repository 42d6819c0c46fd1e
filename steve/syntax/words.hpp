// The reserved words: they mean the same everywhere and cannot name anything.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace breve::steve {

enum class Word : std::uint8_t {
  None,
  Controller,
  Aka,
  Version,
  Define,
  Int,
  Double,
  Float,
  Vector,
  Matrix,
  Object,
  Pointer,
  List,
  String,
  Data,
  Hash,
  Ints,
  Doubles,
  Floats,
  Vectors,
  Matrices,
  Objects,
  Pointers,
  Lists,
  Strings,
  Hashes,
  Return,
  Foreach,
  For,
  While,
  If,
  Else,
  New,
  Free,
  Die,
  Print,
  Printf,
  Random,
  All,
  Super,
  Self,
  Push,
  Pop,
  Prepend,
  Unprepend,
  Insert,
  Remove,
  Sort,
  Copylist,
  Use,
  Include,
  Path,
  Plugin,
  NibFile,
};

/// The reserved word that `text` spells, or None.
Word word_of(std::string_view text);

/// What to write in place of a type of other languages, such as `integer`; "" if it is not known as one.
std::string_view foreign_type(std::string_view word);
/// `length`, `size` and similar words: what other languages call the size of a list.
bool names_a_size(std::string_view word);
/// `add`, `append` and similar words: what other languages call adding to a list.
bool names_a_push(std::string_view word);
/// `println`, `echo` and similar words.
bool names_a_print(std::string_view word);
/// A word that is reserved in small letters, such as `Print`: that spelling; else "".
std::string reserved_in_small(std::string_view word);

}  // namespace breve::steve

// The reserved words: they mean the same everywhere and cannot name anything.
#pragma once

#include <cstdint>
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

}  // namespace breve::steve

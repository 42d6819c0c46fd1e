// What the fuzzers do with their bytes. Each function returns if the library behaved, and aborts with a word about what
// is wrong if it did not; libFuzzer calls them (fuzzer.cpp), and so does the replay that every build runs.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "choices.hpp"

namespace breve::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// Any bytes as the text of a program and of its modules, which are parted by bytes 0x1e.
void fuzz_compile(Bytes bytes);

/// Bytes as the choices of a host that calls any function of breve.h, also from callbacks. See call_target.cpp.
void fuzz_call(Bytes bytes);

/// Bytes as a choice of a world and of changes to an image of it. See image_target.cpp.
void fuzz_image(Bytes bytes);

/// Bytes as a choice of an archive, a request, an upload, a configuration of Push or a sound, and of changes to it. See
/// feed_target.cpp.
void fuzz_feed(Bytes bytes);

/// Bytes as the choices of a generator of programs that call any selector of the class library. See select_target.cpp.
void fuzz_select(Bytes bytes);
/// The same, each world for 50 iterations and after each restored into another.
void fuzz_restore(Bytes bytes);
/// How many programs the two have run.
std::size_t selected_programs();
/// The program that fuzz_select makes of them.
std::string select_program_of(Bytes bytes);

/// Bytes as the choices of a generator of valid programs, which are compiled and run. See run_target.cpp.
void fuzz_run(Bytes bytes);
/// The text of a program that fuzz_run has run, with a first line that says how: it stays what it was where the
/// generator changes.
void fuzz_text(Bytes bytes);
/// The same as such a text.
std::string kept_program_of(Bytes bytes);
/// Pass over the choices that fuzz_run makes before the generator's.
void skip_plan(Choices& choices);

}  // namespace breve::fuzz

// The settings of a Push interpreter: limits, ranges of random constants, which instructions random code has.
#pragma once

#include <cstdint>
#include <functional>
#include <memory_resource>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/poll.hpp"

namespace breve::push {

/// Constants that random code may hold, besides instructions: made anew each time.
enum class Constant : std::uint8_t { Integer, Float, Boolean, Vector, Name };
inline constexpr std::uint8_t kConstants = 5;
std::string_view name_of(Constant constant);  // "INTEGER.ERC"

struct Settings {
  explicit Settings(std::pmr::memory_resource* memory);

  std::int32_t evaluation_limit = 200;  // EVALPUSH-LIMIT: steps of a run, from 0
  std::int32_t list_limit = 200;        // MAX-POINTS-IN-PROGRAM: of what instructions and operators make, from 1
  std::int32_t random_points = 25;      // MAX-POINTS-IN-RANDOM-EXPRESSIONS, from 1
  std::int32_t min_integer = -10, max_integer = 10;
  double min_float = -1, max_float = 1;    // and of each component of a vector
  double new_name_probability = 0.001;     // NEW-ERC-NAME-PROBABILITY: that a random name is a new one
  bool push_code = true;                   // TOP-LEVEL-PUSH-CODE: a program that is run is also on the CODE stack
  bool pop_code = false;                   // TOP-LEVEL-POP-CODE: the CODE stack is popped when it ends
  std::pmr::vector<std::uint16_t> active;  // numbers of instructions, ascending: what random code is made of
  std::pmr::vector<Constant> constants;    // ascending: likewise

  /// Read a configuration: a setting, `instruction NAME` or `type NAME` a line; `#` begins a comment. If it names
  /// instructions or types, these are the active ones, else all stay as they are.
  /// @param unknown  gets a line for each of the first names that are not known; such lines are left out
  /// @param is_word  whether a name stands for a callback or a macro: those are always active
  /// @throws Error{Argument} that names the line, and nothing is changed
  void read(std::string_view text, std::pmr::string& unknown, const Poll& poll = {},
            const std::function<bool(std::string_view)>& is_word = {});
  void print(std::pmr::string& out) const;

  void save(ByteWriter& out) const;
  void load(ByteReader& in);  // Error{Image}
  void hash(Hasher& hasher) const;

 private:
  void activate_all();
};

}  // namespace breve::push

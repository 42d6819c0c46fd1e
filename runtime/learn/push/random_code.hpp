// Code by chance: random programs, and the operators that make children of programs.
//
// Sizes are drawn as in Spector and Robinson, "Genetic Programming and Autoconstructive Evolution with the Push
// Programming Language", Genetic Programming and Evolvable Machines 3 (2002): a size first, then its parts.
#pragma once

#include "runtime/base/random.hpp"
#include "runtime/learn/push/interpreter.hpp"

namespace breve::push {

std::int32_t random_integer_of(const Settings& settings, Random& random);
double random_float_of(const Settings& settings, Random& random);
Vector3 random_vector_of(const Settings& settings, Random& random);
/// A name that nothing is defined as yet, most likely.
Code new_name(Random& random, std::pmr::memory_resource* memory);

/// Draws code of what is active in `from`: instructions, constants, callbacks, macros.
class CodeSource {
 public:
  CodeSource(Interpreter& from, Random& random);
  /// A random program of 1 to `most` points (at least 1). `most` is cut to what the list limit allows.
  Code random_code(std::uint32_t most);
  /// Of exactly so many points, at least 1.
  Code of_size(std::uint32_t points);

 private:
  void add_atom(Builder& builder);
  void add_constant(Builder& builder, Constant constant);
  void decompose(std::uint32_t number);

  Interpreter& from_;
  Random& random_;
  std::pmr::vector<std::string_view> words_;  // callbacks and macros; texts belong to `from`
  std::pmr::vector<std::uint32_t> parts_;     // sizes that are still to be made
};

/// A random point of the code: with probability `leaf_bias` an atom if there is one, else a list if there is one.
std::uint32_t random_point(const Code& code, double leaf_bias, Random& random);
/// A random point but the whole; nothing if there is no other.
std::optional<std::uint32_t> random_inner_point(const Code& code, Random& random);
/// A random list but the whole; nothing if there is no other.
std::optional<std::uint32_t> random_inner_list(const Code& code, Random& random);

struct Mutation {
  double leaf_bias = 0.9;   // see random_point
  double size_scale = 0.3;  // deviation of the new size, as a part of the old one
};
/// With a random subtree replaced by random code of about its size; the code itself if that would exceed the limit.
Code mutated(const Code& code, const Mutation& how, Interpreter& from, Random& random);
/// `first` with a random subtree replaced by one of `second`; `first` itself if that would exceed `limit` points.
Code crossed(const Code& first, const Code& second, std::uint32_t limit, Random& random,
             std::pmr::memory_resource* memory);

}  // namespace breve::push

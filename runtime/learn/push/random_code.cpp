// Code by chance.
#include "runtime/learn/push/random_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/learn/push/edit.hpp"

namespace breve::push {

std::int32_t random_integer_of(const Settings& settings, Random& random) {
  const auto width = static_cast<std::uint64_t>(std::int64_t{settings.max_integer} - settings.min_integer);
  return static_cast<std::int32_t>(settings.min_integer + static_cast<std::int64_t>(random.below(width + 1)));
}

double random_float_of(const Settings& settings, Random& random) {
  return settings.min_float + random.uniform() * (settings.max_float - settings.min_float);
}

Vector3 random_vector_of(const Settings& settings, Random& random) {
  Vector3 value;
  for (int i = 0; i < 3; ++i) value[i] = random_float_of(settings, random);
  return value;
}

Code new_name(Random& random, std::pmr::memory_resource* memory) {
  constexpr std::uint64_t kNames = 1'000'000'000;
  return name(fmt::format("N{}", random.below(kNames)), memory);
}

CodeSource::CodeSource(Interpreter& from, Random& random)
    : from_(from), random_(random), words_(from.memory()), parts_(from.memory()) {
  for (const auto& [text, word] : from.words())
    if (word.kind != Word::Kind::Defined) words_.push_back(text);
}

Code CodeSource::random_code(std::uint32_t most) {
  const auto limit = static_cast<std::uint32_t>(from_.settings.list_limit);
  return of_size(1 + static_cast<std::uint32_t>(random_.below(std::clamp<std::uint32_t>(most, 1, limit))));
}

Code CodeSource::of_size(std::uint32_t points) {
  Builder builder(from_.memory());
  parts_.assign(1, points);
  while (!parts_.empty()) {
    const std::uint32_t size = parts_.back();
    parts_.pop_back();
    if (size == 1) {
      add_atom(builder);
    } else {
      Node list;
      list.points = size;
      builder.atom(list);
      decompose(size - 1);
    }
  }
  return builder.finish();
}

/// Puts sizes whose sum is `number` on the stack, in random order.
void CodeSource::decompose(std::uint32_t number) {
  const std::size_t from = parts_.size();
  while (number > 0) {
    const std::uint32_t part = number == 1 ? 1 : 1 + static_cast<std::uint32_t>(random_.below(number - 1));
    parts_.push_back(part);
    number -= part;
  }
  for (std::size_t i = parts_.size() - 1; i > from; --i)
    std::swap(parts_[i], parts_[from + static_cast<std::size_t>(random_.below(i - from + 1))]);
}

void CodeSource::add_atom(Builder& builder) {
  const auto& active = from_.settings.active;
  const auto& constants = from_.settings.constants;
  const std::size_t all = active.size() + constants.size() + words_.size();
  if (all == 0) return builder.atom(Node{});
  auto chosen = static_cast<std::size_t>(random_.below(all));
  if (chosen < active.size()) return builder.atom(Node::of_instruction(active[chosen]));
  chosen -= active.size();
  if (chosen < constants.size()) return add_constant(builder, constants[chosen]);
  builder.name(words_[chosen - constants.size()]);
}

void CodeSource::add_constant(Builder& builder, Constant constant) {
  const Settings& settings = from_.settings;
  switch (constant) {
    case Constant::Integer: return builder.atom(Node::of_integer(random_integer_of(settings, random_)));
    case Constant::Float: return builder.atom(Node::of_float(random_float_of(settings, random_)));
    case Constant::Boolean: return builder.atom(Node::of_boolean(random_.below(2) != 0));
    case Constant::Vector: return builder.atom(Node::of_vector(random_vector_of(settings, random_)));
    case Constant::Name: break;
  }
  std::optional<Code> bound;
  if (random_.uniform() >= settings.new_name_probability) bound = from_.random_bound_name(random_);
  builder.copy(bound ? *bound : new_name(random_, from_.memory()));
}

std::uint32_t random_point(const Code& code, double leaf_bias, Random& random) {
  std::uint32_t lists = 0;
  for (std::uint32_t i = 0; i < code.points(); ++i) lists += code.nodes()[i].is_list() ? 1 : 0;
  const std::uint32_t atoms = code.points() - lists;
  const bool wants_atom = random.uniform() < leaf_bias;
  const bool atom = lists == 0 || (atoms > 0 && wants_atom);
  auto chosen = random.below(atom ? atoms : lists);
  std::uint32_t i = 0;
  for (;; ++i)
    if (code.nodes()[i].is_list() != atom && chosen-- == 0) return i;
}

std::optional<std::uint32_t> random_inner_point(const Code& code, Random& random) {
  if (code.points() < 2) return {};
  return 1 + static_cast<std::uint32_t>(random.below(code.points() - 1));
}

std::optional<std::uint32_t> random_inner_list(const Code& code, Random& random) {
  std::uint32_t lists = 0;
  for (std::uint32_t i = 1; i < code.points(); ++i) lists += code.nodes()[i].is_list() ? 1 : 0;
  if (lists == 0) return {};
  auto chosen = random.below(lists);
  for (std::uint32_t i = 1;; ++i)
    if (code.nodes()[i].is_list() && chosen-- == 0) return i;
}

Code mutated(const Code& code, const Mutation& how, Interpreter& from, Random& random) {
  const std::uint32_t point = random_point(code, how.leaf_bias, random);
  const double old_size = code.nodes()[point].points;
  const double drawn = std::round(old_size * (1 + how.size_scale * random.gauss()));
  const auto size = static_cast<std::uint32_t>(std::clamp(drawn, 1.0, static_cast<double>(from.settings.list_limit)));
  const Code made = CodeSource(from, random).of_size(size);
  const std::uint64_t points = code.points() - std::uint64_t{code.nodes()[point].points} + size;
  return from.fits(points) ? replace(code, point, made, from.memory()) : code;
}

Code crossed(const Code& first, const Code& second, std::uint32_t limit, Random& random,
             std::pmr::memory_resource* memory) {
  const auto at = static_cast<std::uint32_t>(random.below(first.points()));
  const Code given = second.part(static_cast<std::uint32_t>(random.below(second.points())));
  const std::uint64_t points = std::uint64_t{first.points()} - first.nodes()[at].points + given.points();
  return points <= limit ? replace(first, at, given, memory) : first;
}

}  // namespace breve::push

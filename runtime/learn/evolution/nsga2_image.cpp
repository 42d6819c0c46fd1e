// NSGA-II in images and hashes. An image may come from anywhere: sizes and ranges are checked.
#include <cmath>

#include "runtime/learn/evolution/nsga2.hpp"
#include "runtime/learn/network/numbers_image.hpp"

namespace breve::learn {

void Nsga2::save(ByteWriter& out) const {
  out.put(dimension_);
  out.put(objectives_);
  out.put(population_);
  for (const Operator* each : {&crossover_, &mutation_}) {
    out.put(each->probability);
    out.put(each->index);
  }
  out.put(asked_);
  out.put(generation_);
  for (const Numbers* numbers : {&lowest_, &highest_, &candidates_, &survivors_, &values_}) put_numbers(out, *numbers);
}

void Nsga2::load(ByteReader& in) {
  const auto dimension = in.get<std::int32_t>(), objectives = in.get<std::int32_t>();
  const auto population = in.get<std::int32_t>();
  if (dimension < 0 || dimension > kMaxDimension || objectives < 0 || objectives > kMaxObjectives || population < 0 ||
      population > kMaxPopulation || (dimension > 0 && (objectives < 1 || population < 4)))
    ByteReader::fail();
  for (Operator* each : {&crossover_, &mutation_}) {
    each->probability = in.get<double>();
    each->index = in.get<double>();
    if (!(each->probability >= 0 && each->probability <= 1 && each->index >= 0 && each->index <= kMaxIndex))
      ByteReader::fail();
  }
  asked_ = in.get_bool();
  generation_ = in.get<std::uint64_t>();
  if (dimension == 0 && asked_) ByteReader::fail();
  load_numbers(in, static_cast<std::size_t>(dimension), static_cast<std::size_t>(objectives),
               static_cast<std::size_t>(population));
  dimension_ = dimension;
  objectives_ = objectives;
  population_ = population;
}

void Nsga2::load_numbers(ByteReader& in, std::size_t n, std::size_t m, std::size_t size) {
  for (Numbers* numbers : {&lowest_, &highest_, &candidates_, &survivors_, &values_}) {
    get_numbers(in, *numbers);
    if (!all_finite(*numbers)) ByteReader::fail();
  }
  const bool told = survivors_.size() != 0;
  if (lowest_.size() != n || highest_.size() != n || candidates_.size() != n * size ||
      (told && survivors_.size() != n * size) || values_.size() != (told ? m * size : 0))
    ByteReader::fail();
  for (std::size_t i = 0; i < n; ++i)
    if (!(lowest_[i] < highest_[i]) || !std::isfinite(highest_[i] - lowest_[i])) ByteReader::fail();
  for (std::size_t i = 0; i < survivors_.size(); ++i)
    if (survivors_[i] < lowest_[i % n] || survivors_[i] > highest_[i % n]) ByteReader::fail();
  for (const double value : values_)
    if (value != comparable(value)) ByteReader::fail();
}

void Nsga2::hash(Hasher& hasher) const {
  for (const std::uint64_t number :
       {static_cast<std::uint64_t>(dimension_), static_cast<std::uint64_t>(objectives_),
        static_cast<std::uint64_t>(population_), static_cast<std::uint64_t>(asked_), generation_})
    hasher.add(number);
  for (const Operator* each : {&crossover_, &mutation_}) {
    hasher.add(each->probability);
    hasher.add(each->index);
  }
  for (const Numbers* numbers : {&lowest_, &highest_, &candidates_, &survivors_, &values_})
    hash_numbers(hasher, *numbers);
}

}  // namespace breve::learn

// CMA-ES in images and hashes. An image may come from anywhere: sizes and ranges are checked, and axes that no search
// has lead to candidates that are far, but to nothing worse.
#include <cmath>

#include "runtime/learn/evolution/cma_es.hpp"
#include "runtime/learn/network/numbers_image.hpp"

namespace breve::learn {

void CmaEs::save(ByteWriter& out) const {
  out.put(dimension_);
  out.put(population_);
  out.put(step_);
  out.put(asked_);
  out.put(generation_);
  out.put(decomposed_);
  out.put(best_value_);
  for (const Numbers* numbers : {&mean_, &step_path_, &path_, &covariance_, &axes_, &lengths_, &candidates_, &best_})
    put_numbers(out, *numbers);
}

void CmaEs::load(ByteReader& in) {
  const auto dimension = in.get<std::int32_t>(), population = in.get<std::int32_t>();
  if (dimension < 0 || dimension > kMaxDimension || population < 0 || population > kMaxPopulation ||
      (dimension > 0 && population < 4))
    ByteReader::fail();
  step_ = in.get<double>();
  if (!std::isfinite(step_) || step_ <= 0) ByteReader::fail();
  asked_ = in.get_bool();
  generation_ = in.get<std::uint64_t>();
  decomposed_ = in.get<std::uint64_t>();
  best_value_ = in.get<double>();
  const auto n = static_cast<std::size_t>(dimension);
  const auto get = [&](Numbers& numbers, std::size_t size) {
    get_numbers(in, numbers);
    if (numbers.size() != size) ByteReader::fail();
  };
  for (Numbers* vector : {&mean_, &step_path_, &path_}) get(*vector, n);
  for (Numbers* matrix : {&covariance_, &axes_}) get(*matrix, n * n);
  get(lengths_, n);
  for (const double length : lengths_)
    if (!(length > 0)) ByteReader::fail();
  get(candidates_, n * static_cast<std::size_t>(population));
  get_numbers(in, best_);
  if (best_.size() != 0 && best_.size() != n) ByteReader::fail();
  if (decomposed_ > generation_ || (dimension == 0 && asked_)) ByteReader::fail();
  dimension_ = dimension;
  population_ = population;
}

void CmaEs::hash(Hasher& hasher) const {
  for (const std::uint64_t number : {static_cast<std::uint64_t>(dimension_), static_cast<std::uint64_t>(population_),
                                     static_cast<std::uint64_t>(asked_), generation_, decomposed_})
    hasher.add(number);
  hasher.add(step_);
  hasher.add(best_value_);
  for (const Numbers* numbers : {&mean_, &step_path_, &path_, &covariance_, &axes_, &lengths_, &candidates_, &best_})
    hash_numbers(hasher, *numbers);
}

}  // namespace breve::learn

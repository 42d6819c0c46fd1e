// xoshiro256** and the distributions on top of it; and, for replaying old seeds, a coarse 15-bit uniform.
#include "runtime/base/random.hpp"

#include <cmath>

namespace breve {

namespace {

constexpr std::uint64_t rotate_left(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }

/// Steele, Lea and Flood 2014: turns any seed, zero included, into well-mixed words.
std::uint64_t splitmix64(std::uint64_t& x) {
  std::uint64_t z = (x += 0x9e3779b97f4a7c15ULL);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

constexpr std::uint64_t kFineRange = std::uint64_t{1} << 53;  // what a double holds exactly
constexpr std::uint64_t kCoarseTop = 32767;                   // the 15 bits of the original's floats
constexpr std::int32_t kGammaByProduct = 12;                  // up to here a sum of exponentials is the fastest way

}  // namespace

void Random::seed_with(std::uint64_t seed) {
  seed_ = seed;
  std::uint64_t x = seed;
  for (auto& word : state_) word = splitmix64(x);
  has_spare_ = false;
  spare_ = 0;
}

std::uint64_t Random::next() {
  const std::uint64_t result = rotate_left(state_[1] * 5, 7) * 9;
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = rotate_left(state_[3], 45);
  return result;
}

std::uint64_t Random::below(std::uint64_t bound) {
  // The lowest 2^64 mod bound words are refused, so that every residue has the same number of words.
  const std::uint64_t refuse = (0 - bound) % bound;
  std::uint64_t word = next();
  while (word < refuse) word = next();
  return word % bound;
}

double Random::uniform() {
  if (coarse_) return static_cast<double>(below(kCoarseTop + 1)) / static_cast<double>(kCoarseTop);
  // 2^53 + 1 equally likely multiples of 2^-53: both ends are among them.
  return static_cast<double>(below(kFineRange + 1)) / static_cast<double>(kFineRange);
}

std::int32_t Random::below_or_equal(std::int32_t n) {
  if (n < 0) return 0;
  return static_cast<std::int32_t>(below(static_cast<std::uint64_t>(n) + 1));
}

double Random::gauss() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double x = 0, y = 0, square = 0;
  do {
    x = 2 * open_uniform() - 1;
    y = 2 * open_uniform() - 1;
    square = x * x + y * y;
  } while (square >= 1 || square == 0);
  const double factor = std::sqrt(-2 * std::log(square) / square);
  spare_ = y * factor;
  has_spare_ = true;
  return x * factor;
}

double Random::exponential() { return -std::log(open_uniform()); }

double Random::gamma(std::int32_t order) {
  if (order < 1) throw Error(ErrorCode::Argument, "the order of a gamma distribution must be at least 1");
  if (order <= kGammaByProduct) {
    double product = 1;
    for (std::int32_t i = 0; i < order; ++i) product *= open_uniform();
    return -std::log(product);
  }
  // Marsaglia and Tsang 2000: a squeezed cube of a normal; accepts more than 98 % of its tries.
  const double d = order - 1.0 / 3.0;
  const double c = 1 / std::sqrt(9 * d);
  for (;;) {
    const double x = gauss();
    const double root = 1 + c * x;
    if (root <= 0) continue;
    const double v = root * root * root;
    if (std::log(open_uniform()) < 0.5 * x * x + d - d * v + d * std::log(v)) return d * v;
  }
}

double Random::open_uniform() { return (static_cast<double>(next() >> 11) + 0.5) / static_cast<double>(kFineRange); }

void Random::save(ByteWriter& out) const {
  for (const auto word : state_) out.put(word);
  out.put(seed_);
  out.put(spare_);
  out.put(has_spare_);
  out.put(coarse_);
}

void Random::load(ByteReader& in) {
  Random fresh(0);
  std::uint64_t any = 0;
  for (auto& word : fresh.state_) any |= (word = in.get<std::uint64_t>());
  if (any == 0) ByteReader::fail();  // the one state that xoshiro never leaves
  fresh.seed_ = in.get<std::uint64_t>();
  fresh.spare_ = in.get<double>();
  fresh.has_spare_ = in.get_bool();
  fresh.coarse_ = in.get_bool();
  *this = fresh;
}

void Random::hash(Hasher& hasher) const {
  for (const auto word : state_) hasher.add(word);
  hasher.add(has_spare_ ? spare_ : 0.0);
  hasher.add(static_cast<std::uint64_t>(has_spare_) | static_cast<std::uint64_t>(coarse_) << 1);
}

}  // namespace breve

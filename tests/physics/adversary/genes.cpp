// Drawing and changing creatures.
#include "genes.hpp"

#include <algorithm>
#include <cmath>

namespace adversary {

std::uint64_t Random::next() {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double Random::unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }

namespace {

double draw(const Range& range, Random& random) {
  if (random.chance(range.chance)) return range.plain;
  switch (range.draw) {
    case Draw::Whole: return range.low + random.below(static_cast<int>(range.high - range.low) + 1);
    case Draw::Logarithmic: return range.low * std::pow(range.high / range.low, random.unit());
    case Draw::Linear: break;
  }
  return random.between(range.low, range.high);
}

/// Near the old value; what is off comes on at any value.
double move(const Range& range, double old, Random& random) {
  if (range.draw == Draw::Whole || old == range.plain || random.chance(0.3)) return draw(range, random);
  const double by = random.between(-1, 1) * std::pow(10, -3 * random.unit());
  const double now = range.draw == Draw::Logarithmic ? old * std::pow(range.high / range.low, 0.3 * by)
                                                     : old + 0.3 * (range.high - range.low) * by;
  return std::clamp(now, range.low, range.high);
}

LinkGenes draw_link(Random& random) {
  LinkGenes link{};
  for (int gene = 0; gene < kLinkGenes; ++gene)
    link[static_cast<std::size_t>(gene)] = draw(range_of(static_cast<LinkGene>(gene)), random);
  return link;
}

}  // namespace

Case draw_case(Family family, Random& random) {
  Case made;
  made.family = family;
  for (int gene = 0; gene < kWorldGenes; ++gene)
    made.world[static_cast<std::size_t>(gene)] = draw(range_of(static_cast<WorldGene>(gene)), random);
  // Small creatures are as likely as all large ones together: they run fast and are easy to understand.
  if (random.chance(0.5)) made.world[kLinks] = 2 + random.below(3);
  for (int i = 0; i < static_cast<int>(made[kLinks]); ++i) made.links.push_back(draw_link(random));
  if (family == Family::Overlap) made.world[kSelfCollisions] = 1;
  return made;
}

Case without_link(const Case& one, int link) {
  Case made = one;
  const auto at = static_cast<std::size_t>(link);
  const double parent = link > 0 ? static_cast<int>(one.links[at][kParent]) % link : 0;
  made.links.erase(made.links.begin() + link);
  for (int i = link; i < made.count(); ++i) {
    double& held = made.links[static_cast<std::size_t>(i)][kParent];
    const int old = static_cast<int>(held) % (i + 1);
    held = old == link ? parent : old > link ? old - 1 : old;
  }
  made.world[kLinks] = made.count();
  return made;
}

Case mutate(const Case& one, Random& random) {
  Case made = one;
  if (made.count() < 12 && random.chance(0.05)) made.links.push_back(draw_link(random));
  if (made.count() > 2 && random.chance(0.1)) made = without_link(made, random.below(made.count()));
  made.world[kLinks] = made.count();
  const int changes = 1 + random.below(6);
  for (int i = 0; i < changes; ++i) {
    if (random.chance(0.25)) {
      const auto gene = static_cast<WorldGene>(1 + random.below(kWorldGenes - 1));
      made.world[gene] = move(range_of(gene), made.world[gene], random);
    } else {
      LinkGenes& link = made.links[static_cast<std::size_t>(random.below(made.count()))];
      // The last genes are those of motors.
      const auto gene = static_cast<LinkGene>(random.below(has_motors(made.family) ? kLinkGenes : kSpeed));
      link[gene] = move(range_of(gene), link[gene], random);
    }
  }
  if (made.family == Family::Overlap) made.world[kSelfCollisions] = 1;
  return made;
}

}  // namespace adversary

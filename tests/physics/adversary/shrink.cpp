// Makes a finding small enough to be understood: fewer links, plain genes, round numbers, less time.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "search.hpp"

namespace adversary {

namespace {

class Shrinker {
 public:
  Shrinker(Case one, const Setting& setting, Measure measure)
      : best_(std::move(one)), setting_(setting), measure_(measure) {
    const double now = value(best_);
    needed_ =
        std::max(1.5 * bound_of(measure, setting.rung), std::min(0.1 * now, 10 * bound_of(measure, setting.rung)));
  }

  void run() {
    for (bool better = true; better;) {
      better = false;
      for (int i = best_.count() - 1; i >= 0 && best_.count() > 1; --i) better |= take(without_link(best_, i));
      better |= plain_genes();
    }
    round_genes();
    while (setting_.seconds > 0.05) {
      setting_.seconds *= 0.5;
      if (value(best_) >= needed_) continue;
      setting_.seconds *= 2;
      break;
    }
  }

  const Case& best() const { return best_; }
  double seconds() const { return setting_.seconds; }

 private:
  double value(const Case& one) const {
    const Verdict verdict = run_case(one, setting_);
    return verdict.refused.empty() ? verdict.found[static_cast<std::size_t>(measure_)] : 0;
  }

  bool take(const Case& one) {
    if (value(one) < needed_) return false;
    best_ = one;
    return true;
  }

  bool plain_genes() {
    bool better = false;
    for (int gene = 1; gene < kWorldGenes; ++gene)
      better |= set_world(gene, range_of(static_cast<WorldGene>(gene)).plain);
    for (std::size_t link = 0; link < best_.links.size(); ++link)
      for (int gene = 0; gene < kLinkGenes; ++gene)
        better |= set_link(link, gene, range_of(static_cast<LinkGene>(gene)).plain);
    return better;
  }

  void round_genes() {
    const auto rounded = [](double value, int digits) {
      char text[32];
      std::snprintf(text, sizeof text, "%.*g", digits, value);
      return std::strtod(text, nullptr);
    };
    for (int gene = 1; gene < kWorldGenes; ++gene)
      for (int digits = 1; digits <= 3; ++digits)
        if (set_world(gene, rounded(best_.world[static_cast<std::size_t>(gene)], digits))) break;
    for (std::size_t link = 0; link < best_.links.size(); ++link)
      for (int gene = 0; gene < kLinkGenes; ++gene)
        for (int digits = 1; digits <= 3; ++digits)
          if (set_link(link, gene, rounded(best_.links[link][static_cast<std::size_t>(gene)], digits))) break;
  }

  bool set_world(int gene, double now) {
    Case one = best_;
    double& value = one.world[static_cast<std::size_t>(gene)];
    if (value == now) return false;
    value = now;
    return take(one);
  }

  bool set_link(std::size_t link, int gene, double now) {
    Case one = best_;
    double& value = one.links[link][static_cast<std::size_t>(gene)];
    if (value == now) return false;
    value = now;
    return take(one);
  }

  Case best_;
  Setting setting_;
  Measure measure_;
  double needed_ = 0;
};

}  // namespace

Case shrink(const Case& one, const Setting& setting, Measure measure, double& seconds) {
  Shrinker shrinker(one, setting, measure);
  shrinker.run();
  seconds = shrinker.seconds();
  return shrinker.best();
}

}  // namespace adversary

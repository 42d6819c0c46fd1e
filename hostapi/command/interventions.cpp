// The tally of interventions of the guard, from the events that breve.h returns for each iteration.
#include "interventions.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace breve::command {

namespace {

std::string who(const breve_world* world, breve_object body) {
  const char* name = breve_object_class(world, body);
  return name ? name : "a freed object";
}

}  // namespace

void Interventions::take(const breve_world* world, Output* output) {
  std::size_t count = 0;
  if (breve_world_interventions(world, nullptr, 0, &count) != BREVE_OK || count == 0) return;
  std::vector<breve_intervention> all(count);
  if (breve_world_interventions(world, all.data(), count, &count) != BREVE_OK) return;
  for (const breve_intervention& one : all) {
    const What what{one.action, one.reason, who(world, one.body)};
    Seen& seen = seen_[what];
    if (seen.times++ == 0) seen.first = one.time;
    if (!(std::abs(one.value) <= std::abs(seen.worst))) seen.worst = one.value;  // also if it is NaN
    ++count_;
    if (output)
      output->complain(fmt::format("breve: guard: {:.6g} s: {}, {}: {} ({:.3g})\n", one.time, what.who, what.action,
                                   what.reason, one.value));
  }
}

std::uint64_t Interventions::count(const std::string& action) const {
  std::uint64_t sum = 0;
  for (const auto& [what, seen] : seen_)
    if (what.action == action) sum += seen.times;
  return sum;
}

std::string Interventions::summary() const {
  if (count_ == 0) return {};
  std::string text = fmt::format("breve: the guard acted {} time{}\n", count_, count_ == 1 ? "" : "s");
  for (const auto& [what, seen] : seen_)
    text += fmt::format("  {} times: {}, {}: {} (first at {:.6g} s, largest value {:.3g})\n", seen.times, what.who,
                        what.action, what.reason, seen.first, seen.worst);
  return text;
}

}  // namespace breve::command

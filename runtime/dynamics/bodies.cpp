// Entries of bodies: made when dynamics first has to do with one.
#include <fmt/format.h>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

Dynamics::Core::Core(std::pmr::memory_resource* where, Bodies& of)
    : MechanicsCore(where, of),
      joints(where),
      springs(where),
      entry_of(where),
      entries(where),
      free_entries(where),
      trees(where),
      tree_order(where),
      clusters(where),
      near(where),
      slot_of(where),
      shared(where),
      islands(where),
      calling(where),
      island_free(where),
      island_clusters(where),
      island_pairs(where),
      aside(where),
      set_of(where),
      island_of(where),
      booked(where),
      unsettled(where),
      scratch(where),
      changed(where),
      changes(where) {}

BodyEntry* Dynamics::Core::find(BodyIndex body) {
  return body < entry_of.size() && entry_of[body] != kNone ? &entries[entry_of[body]] : nullptr;
}

const BodyEntry* Dynamics::Core::find(BodyIndex body) const { return const_cast<Core*>(this)->find(body); }

BodyEntry& Dynamics::Core::entry(BodyIndex body) {
  if (!bodies->used(body)) throw Error(ErrorCode::Argument, "there is no such body");
  if (BodyEntry* known = find(body)) return *known;
  if (body >= entry_of.size()) entry_of.resize(bodies->index_end(), kNone);
  if (free_entries.capacity() <= entries.size()) free_entries.reserve(2 * entries.size() + 16);  // forget() takes none
  std::uint32_t index;
  if (free_entries.empty()) {
    index = static_cast<std::uint32_t>(entries.size());
    entries.emplace_back(memory);
  } else {
    index = free_entries.back();
    free_entries.pop_back();
  }
  entries[index].body = body;
  entry_of[body] = index;
  return entries[index];
}

}  // namespace breve

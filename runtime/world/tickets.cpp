// Tickets run along with generations until a restore sets these back.
#include "runtime/world/tickets.hpp"

#include <algorithm>

namespace breve {

void Tickets::make_room(std::size_t slots) {
  if (slots_.size() < slots) slots_.resize(slots);
}

void Tickets::issue(ObjectId id) {
  Slot& slot = slots_[id.index];
  if (slot.last != kLost) ++slot.last;  // a slot that is new to this world may have been used up before a restore
  if (id.generation + slot.offset == slot.last) return;
  slot.offset = slot.last - id.generation;
  slot.since = id.generation;
}

std::uint32_t Tickets::of(ObjectId id) const {
  if (id.index >= slots_.size() || id.generation < slots_[id.index].since) return kLost;
  return id.generation + slots_[id.index].offset;
}

void Tickets::keep(const Tickets& abandoned) {
  make_room(abandoned.slots_.size());
  for (std::size_t i = 0; i < abandoned.slots_.size(); ++i)
    slots_[i].last = std::max(slots_[i].last, abandoned.slots_[i].last);
}

void Tickets::save(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(slots_.size()));
  for (const Slot& slot : slots_) {
    out.put(slot.offset);
    out.put(slot.since);
    out.put(slot.last);
  }
}

void Tickets::load(ByteReader& in) {
  slots_.resize(in.get_count(3 * sizeof(std::uint32_t)));
  for (Slot& slot : slots_) {
    slot.offset = in.get<std::uint32_t>();
    slot.since = in.get<std::uint32_t>();
    slot.last = in.get<std::uint32_t>();
  }
}

}  // namespace breve

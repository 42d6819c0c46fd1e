// Circular lists of agents by cell, and the array of free cells in which a cell is found by its own index.
#include "runtime/patches/occupants.hpp"

namespace breve {

void Occupants::make(const Grid& grid) {
  if (made()) return;
  const std::size_t cells = grid.cells();
  free_.resize(cells);
  slot_of_free_.resize(cells);
  counts_.resize(cells);
  for (std::size_t i = 0; i < cells; ++i) free_[i] = slot_of_free_[i] = static_cast<CellIndex>(i);
  first_.resize(cells, kNoSlot);  // last: now they are made
}

void Occupants::link(Slot slot, CellIndex cell) {
  Agent& agent = agents_[slot];
  agent.cell = cell;
  const Slot first = first_[cell];
  if (first == kNoSlot) {
    agent.before = agent.after = slot;
    first_[cell] = slot;
    // No longer free: the last free cell takes its place in the array.
    const CellIndex hole = slot_of_free_[cell];
    free_[hole] = free_.back();
    slot_of_free_[free_[hole]] = hole;
    free_.pop_back();
  } else {
    const Slot last = agents_[first].before;
    agent.before = last;
    agent.after = first;
    agents_[last].after = slot;
    agents_[first].before = slot;
  }
  ++counts_[cell];
}

void Occupants::unlink(Slot slot) {
  const Agent& agent = agents_[slot];
  const CellIndex cell = agent.cell;
  if (agent.after == slot) {
    first_[cell] = kNoSlot;
    slot_of_free_[cell] = static_cast<CellIndex>(free_.size());
    free_.push_back(cell);  // never allocates: once it held all cells
  } else {
    if (first_[cell] == slot) first_[cell] = agent.after;
    agents_[agent.before].after = agent.after;
    agents_[agent.after].before = agent.before;
  }
  --counts_[cell];
}

Occupants::Slot Occupants::enter(ObjectId id, CellIndex cell) {
  Slot slot;
  if (unused_.empty()) {
    // Room for all to leave, so that leaving never allocates.
    if (unused_.capacity() <= agents_.size()) unused_.reserve(2 * agents_.size() + 16);
    agents_.emplace_back();
    slot = static_cast<Slot>(agents_.size() - 1);
  } else {
    slot = unused_.back();
    unused_.pop_back();
  }
  agents_[slot].id = id;
  link(slot, cell);
  return slot;
}

void Occupants::leave(Slot slot) {
  unlink(slot);
  agents_[slot] = Agent();
  unused_.push_back(slot);
}

void Occupants::move(Slot slot, CellIndex to) {
  unlink(slot);
  link(slot, to);
}

CellIndex Occupants::random_free(Random& random) const {
  return free_.empty() ? kNoCell : free_[random.below(free_.size())];
}

void Occupants::save(ByteWriter& out) const {
  out.put(capacity_);
  out.put(made());
  if (!made()) return;
  out.put(static_cast<std::uint64_t>(agents_.size()));
  for (const Agent& agent : agents_) {
    out.put(agent.id);
    out.put(agent.cell);
    out.put(agent.before);
    out.put(agent.after);
  }
  for (const Slot first : first_) out.put(first);
  out.put(static_cast<std::uint64_t>(unused_.size()));
  for (const Slot slot : unused_) out.put(slot);
  // Their order decides which cell a random number means.
  out.put(static_cast<std::uint64_t>(free_.size()));
  for (const CellIndex cell : free_) out.put(cell);
}

void Occupants::load(ByteReader& in, const Grid& grid) {
  capacity_ = in.get<std::uint32_t>();
  if (!in.get_bool()) return;
  const std::size_t cells = grid.cells();
  agents_.resize(in.get_count(5 * sizeof(std::uint32_t)));
  if (cells > in.left() / sizeof(Slot)) ByteReader::fail();
  make(grid);
  for (Agent& agent : agents_) {
    agent.id = in.get_object();
    agent.cell = in.get<CellIndex>();
    agent.before = in.get<Slot>();
    agent.after = in.get<Slot>();
    if (!agent.id) continue;
    if (agent.cell >= cells || agent.before >= agents_.size() || agent.after >= agents_.size()) ByteReader::fail();
    ++counts_[agent.cell];
  }
  // Circular lists that close, and no agent in two: what follows a link comes back by the other one, in the same cell.
  for (std::size_t i = 0; i < agents_.size(); ++i) {
    const Agent& agent = agents_[i];
    if (!agent.id) continue;
    const Agent& next = agents_[agent.after];
    if (!next.id || next.cell != agent.cell || next.before != i) ByteReader::fail();
  }
  std::size_t occupied = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    first_[cell] = in.get<Slot>();
    if ((first_[cell] == kNoSlot) != (counts_[cell] == 0)) ByteReader::fail();
    if (first_[cell] == kNoSlot) continue;
    ++occupied;
    if (first_[cell] >= agents_.size() || !agents_[first_[cell]].id || agents_[first_[cell]].cell != cell)
      ByteReader::fail();
    std::uint32_t length = 1;
    for (Slot p = agents_[first_[cell]].after; p != first_[cell] && length <= counts_[cell]; p = agents_[p].after)
      ++length;
    if (length != counts_[cell]) ByteReader::fail();
  }
  unused_.reserve(agents_.size() + 16);
  unused_.resize(in.get_count(sizeof(Slot)));
  std::pmr::vector<std::uint8_t> met(agents_.size(), in.memory());
  for (Slot& slot : unused_) {
    slot = in.get<Slot>();
    if (slot >= agents_.size() || agents_[slot].id || met[slot] != 0) ByteReader::fail();
    met[slot] = 1;
  }
  std::size_t present = 0;
  for (const Agent& agent : agents_) present += agent.id ? 1U : 0U;
  if (present + unused_.size() != agents_.size()) ByteReader::fail();
  const std::size_t free_count = in.get_count(sizeof(CellIndex));
  if (free_count + occupied != cells) ByteReader::fail();
  free_.resize(free_count);
  met.assign(cells, 0);
  for (std::size_t i = 0; i < free_count; ++i) {
    const auto cell = in.get<CellIndex>();
    if (cell >= cells || first_[cell] != kNoSlot || met[cell] != 0) ByteReader::fail();
    met[cell] = 1;
    free_[i] = cell;
    slot_of_free_[cell] = static_cast<CellIndex>(i);
  }
}

void Occupants::hash(Hasher& hasher) const {
  hasher.add(static_cast<std::uint64_t>(capacity_));
  for (const Agent& agent : agents_) {
    hasher.add(std::uint64_t{agent.id.index} << 32 | agent.id.generation);
    hasher.add(std::uint64_t{agent.cell} << 32 | agent.after);
  }
  for (const Slot first : first_) hasher.add(static_cast<std::uint64_t>(first));
  for (const CellIndex cell : free_) hasher.add(static_cast<std::uint64_t>(cell));
}

}  // namespace breve

// Circular lists of agents by cell, and the array of free cells in which a cell is found by its own index.
#include "runtime/patches/occupants.hpp"

namespace breve {

void Occupants::make(const Grid& grid) {
  if (made()) return;
  const std::size_t cells = grid.cells();
  free_.resize(cells);
  place_of_free_.resize(cells);
  counts_.resize(cells);
  for (std::size_t i = 0; i < cells; ++i) free_[i] = place_of_free_[i] = static_cast<CellIndex>(i);
  first_.resize(cells, kNoPlace);  // last: now they are made
}

void Occupants::link(Place place, CellIndex cell) {
  Agent& agent = agents_[place];
  agent.cell = cell;
  const Place first = first_[cell];
  if (first == kNoPlace) {
    agent.before = agent.after = place;
    first_[cell] = place;
    // No longer free: the last free cell takes its place in the array.
    const CellIndex hole = place_of_free_[cell];
    free_[hole] = free_.back();
    place_of_free_[free_[hole]] = hole;
    free_.pop_back();
  } else {
    const Place last = agents_[first].before;
    agent.before = last;
    agent.after = first;
    agents_[last].after = place;
    agents_[first].before = place;
  }
  ++counts_[cell];
}

void Occupants::unlink(Place place) {
  const Agent& agent = agents_[place];
  const CellIndex cell = agent.cell;
  if (agent.after == place) {
    first_[cell] = kNoPlace;
    place_of_free_[cell] = static_cast<CellIndex>(free_.size());
    free_.push_back(cell);  // never allocates: once it held all cells
  } else {
    if (first_[cell] == place) first_[cell] = agent.after;
    agents_[agent.before].after = agent.after;
    agents_[agent.after].before = agent.before;
  }
  --counts_[cell];
}

Occupants::Place Occupants::enter(ObjectId id, CellIndex cell) {
  Place place;
  if (unused_.empty()) {
    // Room for all to leave, so that leaving never allocates.
    if (unused_.capacity() <= agents_.size()) unused_.reserve(2 * agents_.size() + 16);
    agents_.emplace_back();
    place = static_cast<Place>(agents_.size() - 1);
  } else {
    place = unused_.back();
    unused_.pop_back();
  }
  agents_[place].id = id;
  link(place, cell);
  return place;
}

void Occupants::leave(Place place) {
  unlink(place);
  agents_[place] = Agent();
  unused_.push_back(place);
}

void Occupants::move(Place place, CellIndex to) {
  unlink(place);
  link(place, to);
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
  for (const Place first : first_) out.put(first);
  out.put(static_cast<std::uint64_t>(unused_.size()));
  for (const Place place : unused_) out.put(place);
  // Their order decides which cell a random number means.
  out.put(static_cast<std::uint64_t>(free_.size()));
  for (const CellIndex cell : free_) out.put(cell);
}

void Occupants::load(ByteReader& in, const Grid& grid) {
  capacity_ = in.get<std::uint32_t>();
  if (!in.get_bool()) return;
  const std::size_t cells = grid.cells();
  agents_.resize(in.get_count(5 * sizeof(std::uint32_t)));
  if (cells > in.left() / sizeof(Place)) ByteReader::fail();
  make(grid);
  for (Agent& agent : agents_) {
    agent.id = in.get_object();
    agent.cell = in.get<CellIndex>();
    agent.before = in.get<Place>();
    agent.after = in.get<Place>();
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
    first_[cell] = in.get<Place>();
    if ((first_[cell] == kNoPlace) != (counts_[cell] == 0)) ByteReader::fail();
    if (first_[cell] == kNoPlace) continue;
    ++occupied;
    if (first_[cell] >= agents_.size() || !agents_[first_[cell]].id || agents_[first_[cell]].cell != cell)
      ByteReader::fail();
    std::uint32_t length = 1;
    for (Place p = agents_[first_[cell]].after; p != first_[cell] && length <= counts_[cell]; p = agents_[p].after)
      ++length;
    if (length != counts_[cell]) ByteReader::fail();
  }
  unused_.reserve(agents_.size() + 16);
  unused_.resize(in.get_count(sizeof(Place)));
  std::pmr::vector<std::uint8_t> met(agents_.size(), in.memory());
  for (Place& place : unused_) {
    place = in.get<Place>();
    if (place >= agents_.size() || agents_[place].id || met[place] != 0) ByteReader::fail();
    met[place] = 1;
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
    if (cell >= cells || first_[cell] != kNoPlace || met[cell] != 0) ByteReader::fail();
    met[cell] = 1;
    free_[i] = cell;
    place_of_free_[cell] = static_cast<CellIndex>(i);
  }
}

void Occupants::hash(Hasher& hasher) const {
  hasher.add(static_cast<std::uint64_t>(capacity_));
  for (const Agent& agent : agents_) {
    hasher.add(std::uint64_t{agent.id.index} << 32 | agent.id.generation);
    hasher.add(std::uint64_t{agent.cell} << 32 | agent.after);
  }
  for (const Place first : first_) hasher.add(static_cast<std::uint64_t>(first));
  for (const CellIndex cell : free_) hasher.add(static_cast<std::uint64_t>(cell));
}

}  // namespace breve

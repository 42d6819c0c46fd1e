// The table of instances. A released slot is reused with the next generation, so an old id stays stale.
#include "runtime/world/objects.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

void load_ids(ByteReader& in, std::pmr::vector<ObjectId>& ids) {
  ids.resize(in.get_count(2 * sizeof(std::uint32_t)));
  for (ObjectId& id : ids) id = in.get_object();
}

}  // namespace

ObjectTable::ObjectTable(std::pmr::memory_resource* memory)
    : slots_(memory),
      handles_(memory),
      free_(memory),
      order_{std::pmr::vector<ObjectId>(memory)},
      iterating_{std::pmr::vector<ObjectId>(memory)},
      post_iterating_{std::pmr::vector<ObjectId>(memory)},
      joining_(memory),
      tickets_(memory) {}

ObjectId ObjectTable::create(ClassId cls, std::uint64_t user, bool iterates, bool post_iterates) {
  // Everything that can run out of memory comes first: a failed creation leaves no trace.
  order_.ids.push_back({});
  try {
    joining_.push_back({});
    if (free_.empty()) {
      // Room for all to be released, so that release() never allocates.
      if (free_.capacity() <= slots_.size()) free_.reserve(2 * slots_.size() + 16);
      tickets_.make_room(slots_.size() + 1);
      handles_.resize(slots_.size() + 1);
      slots_.emplace_back();
      free_.push_back(static_cast<std::uint32_t>(slots_.size() - 1));
    }
  } catch (...) {
    order_.ids.pop_back();
    if (joining_.size() > 0 && !joining_.back()) joining_.pop_back();
    throw;
  }
  const std::uint32_t index = free_.back();
  free_.pop_back();
  Slot& slot = slots_[index];
  const std::uint32_t generation = slot.generation + 1;
  slot = Slot{};
  slot.generation = generation;
  slot.cls = cls;
  slot.user = user;
  slot.serial = ++serials_;
  slot.live = true;
  slot.iterates = iterates;
  slot.post_iterates = post_iterates;
  ++live_;
  const ObjectId id{index, generation};
  tickets_.issue(id);
  handles_[index] = handle_of(index);
  order_.ids.back() = id;
  joining_.back() = id;
  return id;
}

void ObjectTable::release(ObjectId id) {
  Slot& slot = at(id);
  slot.live = false;
  handles_[id.index] = {};
  const std::unique_ptr<Resource> last_act = std::move(slot.resource);
  // A slot whose generations or tickets are used up is never reused: a stale id must not come alive again.
  if (reusable(id.index)) free_.push_back(id.index);
  --live_;
  ++released_;
}

ObjectHandle ObjectTable::handle_of(std::uint32_t index) const {
  const Slot& slot = slots_[index];
  const std::uint32_t ticket = slot.live ? tickets_.of({index, slot.generation}) : 0;
  return ticket == 0 || ticket == Tickets::kLost ? ObjectHandle()
                                                 : ObjectHandle{ticket, slot.body, slot.user, slot.cls};
}

bool ObjectTable::reusable(std::uint32_t index) const {
  return slots_[index].generation != std::numeric_limits<std::uint32_t>::max() && !tickets_.spent(index);
}

void ObjectTable::keep_tickets(const ObjectTable& abandoned) {
  tickets_.keep(abandoned.tickets_);
  std::erase_if(free_, [this](std::uint32_t index) { return !reusable(index); });
}

ObjectTable::Slot& ObjectTable::at(ObjectId id) {
  if (!alive(id)) throw Error(ErrorCode::Stale, id ? "the object has been freed" : "the object is null");
  return slots_[id.index];
}

const ObjectTable::Slot& ObjectTable::at(ObjectId id) const { return const_cast<ObjectTable*>(this)->at(id); }

std::size_t ObjectTable::bytes() const {
  return slots_.capacity() * sizeof(Slot) + handles_.capacity() * sizeof(ObjectHandle) + tickets_.bytes() +
         (order_.ids.capacity() + iterating_.ids.capacity() + post_iterating_.ids.capacity() + joining_.capacity()) *
             sizeof(ObjectId);
}

void ObjectTable::join() {
  tidy();
  // Room first: nothing may fail half-way.
  const auto make_room = [this](std::pmr::vector<ObjectId>& list, bool Slot::*joins) {
    const auto more = std::count_if(joining_.begin(), joining_.end(),
                                    [&](ObjectId id) { return alive(id) && slots_[id.index].*joins; });
    const std::size_t needed = list.size() + static_cast<std::size_t>(more);
    if (needed > list.capacity()) list.reserve(std::max(needed, 2 * list.capacity()));
  };
  make_room(iterating_.ids, &Slot::iterates);
  make_room(post_iterating_.ids, &Slot::post_iterates);
  for (const ObjectId id : joining_) {
    if (!alive(id)) continue;
    if (slots_[id.index].iterates) iterating_.ids.push_back(id);
    if (slots_[id.index].post_iterates) post_iterating_.ids.push_back(id);
  }
  joining_.clear();
  joined_ = serials_;
}

// A pass over all ids is paid for by an eighth of them, and cut into slices: with a million objects it takes 10 ms.
void ObjectTable::tidy() {
  constexpr std::size_t kShare = 8, kSlice = 16'384;
  gaps_ += released_;
  if (tidied_ == kLists && gaps_ * kShare > order_.ids.size()) tidied_ = gaps_ = 0;
  std::size_t most = kSlice + kShare * (released_ + joining_.size());
  released_ = 0;
  for (SparseIds* const lists[kLists] = {&order_, &iterating_, &post_iterating_}; tidied_ < kLists; ++tidied_)
    if (!close_gaps(*lists[tidied_], most)) return;
}

// True if the pass has reached the end of the list.
bool ObjectTable::close_gaps(SparseIds& list, std::size_t& most) const {
  const std::size_t end = std::min(list.ids.size(), list.next + most);
  most -= end - list.next;
  for (; list.next < end; ++list.next) {
    const ObjectId id = std::exchange(list.ids[list.next], ObjectId{});
    if (alive(id)) list.ids[list.kept++] = id;
  }
  if (list.next < list.ids.size()) return false;
  list.ids.resize(list.kept);
  list.kept = list.next = 0;
  return true;
}

// Without the gaps, so that an image does not tell how far a pass has come.
void ObjectTable::save_ids(ByteWriter& out, const std::pmr::vector<ObjectId>& ids) const {
  const auto lives = [this](ObjectId id) { return alive(id); };
  out.put(static_cast<std::uint64_t>(std::count_if(ids.begin(), ids.end(), lives)));
  for (const ObjectId id : ids)
    if (lives(id)) out.put(id);
}

void ObjectTable::save(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(slots_.size()));
  for (const Slot& slot : slots_) {
    out.put(slot.generation);
    out.put(slot.live);
    if (!slot.live) continue;
    out.put(slot.cls);
    out.put(slot.serial);
    out.put(slot.body);
    out.put(slot.iterates);
    out.put(slot.post_iterates);
    out.put(slot.resource ? slot.resource->kind() : std::string_view());
    if (slot.resource) slot.resource->save(out);
  }
  out.put(static_cast<std::uint64_t>(free_.size()));
  for (const auto index : free_) out.put(index);
  save_ids(out, order_.ids);
  save_ids(out, iterating_.ids);
  save_ids(out, post_iterating_.ids);
  save_ids(out, joining_);
  out.put(serials_);
  out.put(joined_);
  tickets_.save(out);
}

void ObjectTable::load_slot(ByteReader& in, Slot& slot, FindLoader find_loader, const void* context) {
  slot.generation = in.get<std::uint32_t>();
  slot.live = in.get_bool();
  if (!slot.live) return;
  slot.cls = in.get<ClassId>();
  slot.serial = in.get<std::uint64_t>();
  slot.body = in.get<BodyIndex>();
  slot.iterates = in.get_bool();
  slot.post_iterates = in.get_bool();
  const std::string kind = in.get_string();
  if (!kind.empty()) {
    const ResourceLoader loader = find_loader(context, kind);
    if (!loader) throw Error(ErrorCode::Image, "the image holds a '" + kind + "', which this program does not know");
    slot.resource = loader(in);
  }
  ++live_;
}

void ObjectTable::load(ByteReader& in, FindLoader find_loader, const void* context) {
  slots_.resize(in.get_count(sizeof(std::uint32_t) + 1));
  for (Slot& slot : slots_) load_slot(in, slot, find_loader, context);
  free_.resize(in.get_count(sizeof(std::uint32_t)));
  for (auto& index : free_) {
    index = in.get<std::uint32_t>();
    if (index >= slots_.size() || slots_[index].live) ByteReader::fail();
  }
  load_ids(in, order_.ids);
  load_ids(in, iterating_.ids);
  load_ids(in, post_iterating_.ids);
  load_ids(in, joining_);
  serials_ = in.get<std::uint64_t>();
  joined_ = in.get<std::uint64_t>();
  tickets_.load(in);
  tickets_.make_room(slots_.size());  // a forged image may have too few
  check_loaded(in.memory());
  handles_.resize(slots_.size());
  for (std::uint32_t index = 0; index < handles_.size(); ++index) handles_[index] = handle_of(index);
  free_.reserve(slots_.size());  // release() never allocates
}

/// An image may have a right checksum and be forged: nobody is in a list twice, is left out, has no ticket, or is
/// free and alive.
void ObjectTable::check_loaded(std::pmr::memory_resource* memory) const {
  enum : std::uint8_t { Ordered = 1, Iterating = 2, PostIterating = 4, Joining = 8, Free = 16 };
  std::pmr::vector<std::uint8_t> met(slots_.size(), memory);
  const auto meet = [&met](std::uint32_t index, std::uint8_t list) {
    if ((met[index] & list) != 0) ByteReader::fail();
    met[index] |= list;
  };
  std::uint64_t last = 0;
  for (const ObjectId id : order_.ids) {
    if (!alive(id) || !id || at(id).serial <= last || at(id).serial > serials_) ByteReader::fail();
    last = at(id).serial;
    meet(id.index, Ordered);
  }
  if (order_.ids.size() != live_) ByteReader::fail();
  for (const ObjectId id : joining_) {
    if (!alive(id)) ByteReader::fail();
    meet(id.index, Joining | Iterating | PostIterating);
  }
  for (const ObjectId id : iterating_.ids) {
    if (!alive(id) || !at(id).iterates) ByteReader::fail();
    meet(id.index, Iterating);
  }
  for (const ObjectId id : post_iterating_.ids) {
    if (!alive(id) || !at(id).post_iterates) ByteReader::fail();
    meet(id.index, PostIterating);
  }
  for (const std::uint32_t index : free_) {
    if (!reusable(index)) ByteReader::fail();
    meet(index, Free);
  }
  // Hosts can name whoever lives, or lived last, in each slot.
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const std::uint32_t generation = slots_[index].generation;
    const std::uint32_t ticket = tickets_.of({index, generation});
    if (ticket == 0 || tickets_.generation(index, ticket) != generation) ByteReader::fail();
  }
}

void ObjectTable::hash(Hasher& hasher) const {
  hasher.add(static_cast<std::uint64_t>(live_));
  hasher.add(serials_);
  for (const ObjectId id : order_.ids) {
    if (!alive(id)) continue;
    const Slot& slot = slots_[id.index];
    hasher.add(std::uint64_t{id.index} << 32 | id.generation);
    hasher.add(std::uint64_t{slot.cls} << 2 | std::uint64_t{slot.iterates} << 1 | std::uint64_t{slot.post_iterates});
    hasher.add(slot.serial);
    if (slot.resource) {
      hasher.add(slot.resource->kind());
      slot.resource->hash(hasher);
    }
  }
  for (const ObjectId id : joining_)
    if (alive(id)) hasher.add(std::uint64_t{id.index});
}

}  // namespace breve

// What happens to objects and collision handlers when the script side numbers its classes anew: the program was
// replaced while the world runs. Everything that can fail comes first; then everything is changed at once.
#include <utility>

#include "runtime/base/error.hpp"
#include "runtime/world/parts.hpp"

namespace breve {

namespace {

bool keeps_numbers(std::span<const ClassChange> classes) {
  for (std::size_t i = 0; i < classes.size(); ++i)
    if (classes[i].to != i && classes[i].to != kNoClass) return false;
  return true;
}

}  // namespace

ObjectTable::Reclassed ObjectTable::prepare_reclass(std::span<const ClassChange> classes) const {
  Reclassed lists{std::pmr::vector<ObjectId>(joining_.get_allocator()),
                  std::pmr::vector<ObjectId>(joining_.get_allocator()), false};
  for (const ObjectId id : order_.ids) {
    if (!alive(id)) continue;
    const Slot& slot = slots_[id.index];
    if (slot.cls >= classes.size() || classes[slot.cls].to == kNoClass)
      throw Error(ErrorCode::Argument, "the class of a live object was removed");
    const ClassChange& change = classes[slot.cls];
    lists.changed = lists.changed || change.iterates != slot.iterates || change.post_iterates != slot.post_iterates;
    if (!joined(slot)) continue;
    if (change.iterates) lists.iterating.push_back(id);
    if (change.post_iterates) lists.post_iterating.push_back(id);
  }
  return lists;
}

void ObjectTable::reclass(std::span<const ClassChange> classes, Reclassed& lists) noexcept {
  for (Slot& slot : slots_) {
    if (!slot.live) continue;
    const ClassChange& change = classes[slot.cls];
    slot.cls = change.to;
    slot.iterates = change.iterates;
    slot.post_iterates = change.post_iterates;
  }
  for (ObjectHandle& handle : handles_)
    if (handle.ticket != 0) handle.cls = classes[handle.cls].to;
  if (!lists.changed) return;
  iterating_ = {std::move(lists.iterating)};
  post_iterating_ = {std::move(lists.post_iterating)};
}

CollisionHandlers CollisionHandlers::reclassed(std::span<const ClassChange> classes) const {
  CollisionHandlers fresh(pairs_.get_allocator().resource());
  const auto now = [&](ClassId cls) { return cls < classes.size() ? classes[cls].to : kNoClass; };
  for (const auto& [pair, entry] : pairs_) {
    const ClassId owner = now(pair.first), other = now(pair.second);
    if (owner == kNoClass || other == kNoClass) continue;
    if (entry.method != kNoName) fresh.handle(owner, other, entry.method);
    if (entry.ignored) fresh.ignore(owner, other);
  }
  fresh.revision_ = revision_ + 1;  // pairs that were looked at are looked at again
  return fresh;
}

void CollisionHandlers::swap(CollisionHandlers& other) noexcept {
  pairs_.swap(other.pairs_);
  taking_part_.swap(other.taking_part_);
  std::swap(handlers_, other.handlers_);
  std::swap(revision_, other.revision_);
}

void World::reclass(std::span<const ClassChange> classes) {
  if (stepping_ || advancing_) throw Error(ErrorCode::Busy, "classes cannot change inside a step");
  auto lists = parts_->objects.prepare_reclass(classes);
  bool dropped = false;
  for (const ClassChange& change : classes) dropped = dropped || change.to == kNoClass;
  if (keeps_numbers(classes) && !dropped) {
    parts_->objects.reclass(classes, lists);
    return;
  }
  auto handlers = parts_->handlers.reclassed(classes);
  std::pmr::set<ClassId> watched(memory_);
  if (events_) watched = events_->reclassed(classes);
  parts_->objects.reclass(classes, lists);
  parts_->handlers.swap(handlers);
  if (!events_) return;
  events_->take_classes(watched);
  events_->clear();  // what is listed names classes by their old numbers
}

}  // namespace breve

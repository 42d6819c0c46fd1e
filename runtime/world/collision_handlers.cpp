// The table of collision handlers, an ordered map from (owner's class, other's class).
#include "runtime/world/collision_handlers.hpp"

namespace breve {

void CollisionHandlers::handle(ClassId owner, ClassId other, NameId method) {
  Entry& entry = pairs_[{owner, other}];
  if (entry.method != kNoName) return;
  mark(owner);
  mark(other);
  entry.method = method;
  ++handlers_;
  ++revision_;
}

void CollisionHandlers::ignore(ClassId owner, ClassId other) {
  Entry& entry = pairs_[{owner, other}];
  if (!entry.ignored) ++revision_;
  entry.ignored = true;
}

NameId CollisionHandlers::method(ClassId owner, ClassId other) const {
  const auto entry = pairs_.find({owner, other});
  return entry == pairs_.end() ? kNoName : entry->second.method;
}

bool CollisionHandlers::ignored(ClassId a, ClassId b) const {
  for (const auto& pair : {std::pair{a, b}, std::pair{b, a}}) {
    const auto entry = pairs_.find(pair);
    if (entry != pairs_.end() && entry->second.ignored) return true;
  }
  return false;
}

void CollisionHandlers::mark(ClassId cls) {
  // Class numbers are small and dense; one that is not names no class of any program.
  constexpr ClassId kMostClasses = 1U << 24;
  if (cls >= kMostClasses) throw Error(ErrorCode::Argument, "a collision handler names a class that does not exist");
  if (cls >= taking_part_.size()) taking_part_.resize(cls + 1, 0);
  taking_part_[cls] = 1;
}

void CollisionHandlers::save(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(pairs_.size()));
  for (const auto& [classes, entry] : pairs_) {
    out.put(classes.first);
    out.put(classes.second);
    out.put(entry.method);
    out.put(entry.ignored);
  }
}

void CollisionHandlers::load(ByteReader& in, std::size_t names) {
  const std::size_t count = in.get_count(3 * sizeof(std::uint32_t) + 1);
  for (std::size_t i = 0; i < count; ++i) {
    const auto owner = in.get<ClassId>();
    const auto other = in.get<ClassId>();
    const auto method = in.get<NameId>();
    if (method != kNoName && method >= names) ByteReader::fail();
    if (method != kNoName) handle(owner, other, method);
    if (in.get_bool()) ignore(owner, other);
  }
}

void CollisionHandlers::hash(Hasher& hasher, const NameTable& names) const {
  for (const auto& [classes, entry] : pairs_) {
    hasher.add(std::uint64_t{classes.first} << 32 | classes.second);
    hasher.add(entry.method == kNoName ? std::string_view() : names.text(entry.method));
    hasher.add(static_cast<std::uint64_t>(entry.ignored));
  }
}

}  // namespace breve

// The record of one moment: kept in arrays by order of creation, so that indices of the search are places in them.
#include "runtime/world/neighbor_record.hpp"

#include <cmath>

namespace breve {

void NeighborRecord::clear(std::size_t slots) {
  points_.clear();
  ids_.clear();
  gone_.clear();
  any_gone_ = false;
  slot_.resize(slots);
}

void NeighborRecord::add(ObjectId id, std::uint64_t user, const Vector3& center, double radius) {
  slot_[id.index] = static_cast<std::uint32_t>(ids_.size());
  points_.add(center, radius, user);
  ids_.push_back(id);
  gone_.push_back(0);
}

std::uint32_t NeighborRecord::find(ObjectId id) const {
  if (id.index >= slot_.size()) return kNowhere;
  const std::uint32_t slot = slot_[id.index];
  return slot < ids_.size() && ids_[slot] == id ? slot : kNowhere;
}

void NeighborRecord::forget(ObjectId id) {
  const std::uint32_t slot = find(id);
  if (slot == kNowhere) return;
  gone_[slot] = 1;
  any_gone_ = true;
}

void NeighborRecord::set_user(ObjectId id, std::uint64_t user) {
  const std::uint32_t slot = find(id);
  if (slot != kNowhere) points_.set_label(slot, user);
}

const std::pmr::vector<ObjectId>& NeighborRecord::neighbors(ObjectId id) {
  result_.clear();
  const std::uint32_t slot = find(id);
  if (slot == kNowhere) return result_;
  for (const std::uint32_t other : points_.query(slot).points) {
    if (gone_[other] == 0) result_.push_back(ids_[other]);
  }
  return result_;
}

std::span<const std::uint64_t> NeighborRecord::users(ObjectId id) {
  const std::uint32_t slot = find(id);
  if (slot == kNowhere) return {};
  const Neighbors::Found found = points_.query(slot);
  if (!any_gone_) return found.labels;
  user_result_.clear();
  for (std::size_t i = 0; i < found.points.size(); ++i) {
    if (gone_[found.points[i]] == 0) user_result_.push_back(found.labels[i]);
  }
  return user_result_;
}

void NeighborRecord::save(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(ids_.size()));
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    out.put(ids_[i]);
    out.put(points_.radii()[i]);
    out.put(points_.points()[i]);
  }
}

void NeighborRecord::load(ByteReader& in, const ObjectTable& objects) {
  const std::size_t count = in.get_count(2 * sizeof(std::uint32_t) + 4 * sizeof(double));
  clear(objects.slot_count());
  for (std::size_t i = 0; i < count; ++i) {
    const ObjectId id = in.get_object();
    const auto radius = in.get<double>();
    const Vector3 center = in.get_vector();
    if (id.index >= slot_.size() || !center.allFinite() || !std::isfinite(radius)) ByteReader::fail();
    const bool alive = objects.alive(id);
    add(id, alive ? objects.at(id).user : 0, center, radius);
    if (!alive) forget(id);
  }
}

void NeighborRecord::hash(Hasher& hasher) const {
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    hasher.add(std::uint64_t{ids_[i].index} << 32 | ids_[i].generation);
    hasher.add(points_.radii()[i]);
    hasher.add(points_.points()[i]);
  }
}

std::size_t NeighborRecord::bytes() const {
  return points_.bytes() + (ids_.capacity() + result_.capacity()) * sizeof(ObjectId) +
         user_result_.capacity() * sizeof(std::uint64_t) + gone_.capacity() + slot_.capacity() * sizeof(std::uint32_t);
}

}  // namespace breve

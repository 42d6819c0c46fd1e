// The instances of a world: ids with generations, creation order, and who iterates.
#pragma once

#include <cstdint>
#include <memory>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/kinematics/bodies.hpp"
#include "runtime/world/behaviour.hpp"
#include "runtime/world/resource.hpp"

namespace breve {

class ObjectTable {
 public:
  struct Slot {
    std::uint32_t generation = 0;  // of the instance that lives here, or lived here last
    ClassId cls = kNoClass;
    std::uint64_t user = 0;
    std::uint64_t serial = 0;  // 1, 2, ... in order of creation
    BodyIndex body = kNoBody;
    std::uint32_t events = 0;  // scheduled calls that wait for it
    bool live = false, iterates = false, post_iterates = false;
    std::unique_ptr<Resource> resource;
  };
  /// Finds the loader of a resource kind; null if there is none.
  using FindLoader = ResourceLoader (*)(const void* context, std::string_view kind);

  explicit ObjectTable(std::pmr::memory_resource* memory);

  ObjectId create(ClassId cls, std::uint64_t user, bool iterates, bool post_iterates);
  void release(ObjectId id);  // a live one
  bool alive(ObjectId id) const {
    return id.index < slots_.size() && slots_[id.index].live && slots_[id.index].generation == id.generation;
  }
  Slot& at(ObjectId id);  // Error{Stale} if not alive
  const Slot& at(ObjectId id) const;
  std::size_t count() const { return live_; }
  std::size_t slot_count() const { return slots_.size(); }
  std::size_t bytes() const;

  /// What was created since the last call joins the lists; what was released leaves them sooner or later.
  void join();
  // In order of creation; may name what was released meanwhile. Iterating lists change in join() only.
  const std::pmr::vector<ObjectId>& order() const { return order_; }
  const std::pmr::vector<ObjectId>& iterating() const { return iterating_; }
  const std::pmr::vector<ObjectId>& post_iterating() const { return post_iterating_; }

  /// The lists that follow from new classes (reclass.cpp). Error{Argument} if a live object's class is gone.
  struct Reclassed {
    std::pmr::vector<ObjectId> iterating, post_iterating;
    bool changed;
  };
  Reclassed prepare_reclass(std::span<const ClassChange> classes) const;
  void reclass(std::span<const ClassChange> classes, Reclassed& lists) noexcept;

  void save(ByteWriter& out) const;
  void load(ByteReader& in, FindLoader find_loader, const void* context);  // into a fresh table
  void hash(Hasher& hasher) const;

 private:
  void drop_dead(std::pmr::vector<ObjectId>& list) const;
  void load_slot(ByteReader& in, Slot& slot, FindLoader find_loader, const void* context);

  std::pmr::vector<Slot> slots_;
  std::pmr::vector<std::uint32_t> free_;  // last freed, first reused
  std::pmr::vector<ObjectId> order_, iterating_, post_iterating_, joining_;
  std::uint64_t serials_ = 0;
  std::size_t live_ = 0;
  std::size_t released_since_join_ = 0;
};

}  // namespace breve

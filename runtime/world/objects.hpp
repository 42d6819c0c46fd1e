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
#include "runtime/world/object_handle.hpp"
#include "runtime/world/resource.hpp"
#include "runtime/world/tickets.hpp"

namespace breve {

class ObjectTable {
 public:
  struct Slot {
    std::uint32_t generation = 0;  // of the instance that lives here, or lived here last
    ClassId cls = kNoClass;
    std::uint64_t user = 0;    // the script side's own, an address perhaps: in no image; see set_user
    std::uint64_t serial = 0;  // 1, 2, ... in order of creation
    BodyIndex body = kNoBody;  // see set_body
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

  /// Objects created since the last call join the lists; what was released leaves them a slice at a time.
  void join();
  // In order of creation; may name what was released meanwhile. Iterating lists change in join() only.
  const std::pmr::vector<ObjectId>& order() const { return order_.ids; }
  const std::pmr::vector<ObjectId>& iterating() const { return iterating_.ids; }
  const std::pmr::vector<ObjectId>& post_iterating() const { return post_iterating_.ids; }

  /// The lists that follow from new classes (reclass.cpp). Error{Argument} if a live object's class is gone.
  struct Reclassed {
    std::pmr::vector<ObjectId> iterating, post_iterating;
    bool changed;
  };
  Reclassed prepare_reclass(std::span<const ClassChange> classes) const;
  void reclass(std::span<const ClassChange> classes, Reclassed& lists) noexcept;

  /// What hosts know an instance by, also one that is gone. See Tickets.
  std::uint32_t ticket(ObjectId id) const { return tickets_.of(id); }
  /// The live instance of a ticket, or null.
  ObjectId holder(std::uint32_t index, std::uint32_t ticket) const {
    const bool held = index < handles_.size() && ticket != 0 && handles_[index].ticket == ticket;
    return held ? ObjectId{index, slots_[index].generation} : ObjectId{};
  }
  /// What a host reads of many objects, by index. It repeats what the slots have, in a third of their bytes.
  std::span<const ObjectHandle> handles() const { return handles_; }
  void set_user(ObjectId id, std::uint64_t user) { handles_[id.index].user = at(id).user = user; }
  void set_body(ObjectId id, BodyIndex body) { handles_[id.index].body = at(id).body = body; }
  /// This table takes the place of `abandoned` in the same world.
  void keep_tickets(const ObjectTable& abandoned);

  std::uint64_t last_serial() const { return serials_; }  // of the object created last

  void save(ByteWriter& out) const;
  void load(ByteReader& in, FindLoader find_loader, const void* context);  // into a fresh table
  void hash(Hasher& hasher) const;

 private:
  static constexpr std::size_t kLists = 3;

  /// A list of ids in which a pass closes the gaps: before `kept` it has been, from there to `next` is nobody.
  struct SparseIds {
    std::pmr::vector<ObjectId> ids;
    std::size_t kept = 0, next = 0;
  };
  void tidy();
  bool close_gaps(SparseIds& list, std::size_t& most) const;
  bool reusable(std::uint32_t index) const;
  bool joined(const Slot& slot) const { return slot.serial <= joined_; }
  void save_ids(ByteWriter& out, const std::pmr::vector<ObjectId>& ids) const;
  void load_slot(ByteReader& in, Slot& slot, FindLoader find_loader, const void* context);
  void check_loaded(std::pmr::memory_resource* memory) const;

  ObjectHandle handle_of(std::uint32_t index) const;

  std::pmr::vector<Slot> slots_;
  std::pmr::vector<ObjectHandle> handles_;  // KEEP IN STEP: cls, user and body of the slots
  std::pmr::vector<std::uint32_t> free_;    // last freed, first reused
  SparseIds order_, iterating_, post_iterating_;
  std::pmr::vector<ObjectId> joining_;
  Tickets tickets_;
  std::uint64_t serials_ = 0, joined_ = 0;  // of the last created, of the last that has joined the lists
  std::size_t live_ = 0;
  std::size_t gaps_ = 0, released_ = 0;  // released since the last pass began, since the last join
  std::size_t tidied_ = kLists;          // lists that the pass is done with
};

}  // namespace breve

// The events of an iteration, as lists for the host: contacts of objects that are watched, births and deaths,
// announcements, bodies that fell asleep or woke. Only the events that a host asked for are gathered. They are not part
// of images: a host that only observes a world leaves no trace in it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory_resource>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"
#include "runtime/base/memory.hpp"
#include "runtime/mechanics/ledger.hpp"
#include "runtime/world/behaviour.hpp"

namespace breve {

/// Two bodies touch at the end of the iteration, or an impact was between them in it.
struct ContactEvent {
  enum class Phase : std::uint8_t { Begin, Persist, End } phase = Phase::Begin;
  ObjectId a, b;  // a was created earlier; of an end perhaps gone
  std::uint32_t ticket_a = 0, ticket_b = 0;
  Vector3 point = Vector3::Zero();
  Vector3 normal = Vector3::Zero();   // unit, from b toward a; so the next: as they were last
  double distance = 0;                // m; < 0: they overlap
  Vector3 impulse = Vector3::Zero();  // on a, of the impacts of this iteration, N*s
};

struct LifeEvent {
  ObjectId object;
  std::uint32_t ticket = 0;
  ClassId cls = kNoClass;
  bool born = false;
};

struct SleepEvent {
  ObjectId object;
  std::uint32_t ticket = 0;
  bool asleep = false;
};

struct AnnouncementEvent {
  ObjectId announcer;
  std::uint32_t ticket = 0;
  double time = 0;  // s
  std::pmr::string message;
};

/// Gets events during the iteration. It may change the world as a script may in its `iterate`.
class EventListener {
 public:
  virtual ~EventListener() = default;
  virtual void contact(const ContactEvent& event) = 0;
  virtual void life(const LifeEvent& event) = 0;
  virtual void announcement(const AnnouncementEvent& event) = 0;
  virtual void sleep(const SleepEvent& event) = 0;
  virtual void intervention(const Intervention& event) = 0;
};

class Events : public InMemory {
 public:
  explicit Events(std::pmr::memory_resource* memory);

  enum Kind : std::uint32_t { kContacts = 1, kLives = 2, kAnnouncements = 4, kSleep = 8, kAll = 15 };
  /// Gathers these kinds, and those that the listener wants.
  void want(std::uint32_t kinds);
  /// Tells the listener of these kinds from now on, and of the guard's interventions. Not owned; null: nobody.
  /// @param interventions  how many there were in this iteration so far
  void listen(EventListener* listener, std::uint32_t kinds, std::size_t interventions);
  bool wants(Kind kind) const { return ((wanted_ | heard_) & kind) != 0; }
  bool wants_any() const { return (wanted_ | heard_) != 0; }
  bool listened() const { return listener_ != nullptr; }
  std::uint32_t wanted() const { return wanted_; }
  /// Reports the contacts of this object, or of the objects of exactly this class, or stops that.
  void watch(ObjectId object, bool on);
  void watch(ClassId cls, bool on);
  bool watched(ObjectId object, ClassId cls) const;
  bool any_watched() const { return !objects_.empty() || !classes_.empty(); }
  bool any_class_watched() const { return !classes_.empty(); }
  const std::pmr::set<std::pair<std::uint32_t, std::uint32_t>>& watched_objects() const { return objects_; }
  /// The watched classes under other numbers; to be given to take_classes().
  std::pmr::set<ClassId> reclassed(std::span<const ClassChange> classes) const;
  void take_classes(std::pmr::set<ClassId>& classes) noexcept { classes_.swap(classes); }

  void begin();  // a new iteration: all lists are empty, but for events that callbacks of the last one caused
  void clear();
  bool untold(std::size_t interventions) const;
  /// Tells the listener of what it was not told yet. Events that this causes are left for the next call.
  /// @param interventions  gives the guard's list, which a callback may move
  void tell(const std::function<std::span<const Intervention>()>& interventions);
  void forget(ObjectId object) { objects_.erase({object.index, object.generation}); }

  // The events so far, in order: contacts by the creation of both objects, the others as they happened.
  std::pmr::vector<ContactEvent> contacts;
  std::pmr::vector<LifeEvent> lives;
  std::pmr::vector<SleepEvent> sleeps;
  std::pmr::vector<AnnouncementEvent> announcements;

  /// Who touched at the end of the last iteration, by the places of both in the order of creation.
  using Pair = std::pair<std::uint64_t, std::uint64_t>;
  std::pmr::map<Pair, ContactEvent> touching;
  std::pmr::map<std::uint64_t, ObjectId> asleep;  // by place in the order of creation

  std::size_t bytes() const;

 private:
  /// How many of each list the listener has been told.
  struct Told {
    std::size_t contacts = 0, lives = 0, sleeps = 0, announcements = 0, interventions = 0;
  };
  void drop_unwanted();

  std::uint32_t wanted_ = 0, heard_ = 0;
  EventListener* listener_ = nullptr;
  Told told_;
  std::pmr::set<std::pair<std::uint32_t, std::uint32_t>> objects_;  // index and generation
  std::pmr::set<ClassId> classes_;
};

}  // namespace breve

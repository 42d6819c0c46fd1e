// What a world is made of, beside bodies, clock and generator. World orders them; they do not know each other's world.
#pragma once

#include <deque>
#include <map>
#include <memory_resource>
#include <string>
#include <vector>

#include "runtime/contact/collision_stage.hpp"
#include "runtime/world/collision_handlers.hpp"
#include "runtime/world/name_table.hpp"
#include "runtime/world/neighbor_record.hpp"
#include "runtime/world/notifications.hpp"
#include "runtime/world/objects.hpp"
#include "runtime/world/pair_rules.hpp"
#include "runtime/world/schedule.hpp"
#include "runtime/world/world.hpp"

namespace breve {

struct World::Parts final : CollisionClient, MechanicsClient, InMemory {
  Parts(World& world, std::pmr::memory_resource* memory);

  /// These parts now belong to `owner`, whose bodies they use.
  void rebind(World& owner) {
    world = &owner;
    collisions.rebind(*owner.bodies_);
    dynamics->rebind(*owner.bodies_);
  }

  // --- the stages of a sub-step: a list, rebuilt only when the scene calls for other effects -------------------------
  struct Stage {
    EffectId effect;
    void (*run)(Parts& parts, double h);
    std::size_t (*items)(const Parts& parts);
  };
  /// Which effects the bodies and handlers call for now, one bit for each EffectId.
  std::uint32_t signature() const;
  void rebuild_stages(std::uint32_t signature);
  ObjectId who_asked(EffectId effect) const;
  void count_dynamics();
  void bring_inside();
  // targets.cpp
  void aim_at_targets();
  void reach_targets();
  void save_targets(ByteWriter& out) const;
  void load_targets(ByteReader& in);
  void hash_targets(Hasher& hasher) const;
  // pushes.cpp
  class PushScope;
  void save_pushes(ByteWriter& out) const;
  void load_pushes(ByteReader& in);
  void hash_pushes(Hasher& hasher) const;

  // step.cpp
  bool bring_assembly(BodyIndex body);
  // judge.cpp
  bool denied(ObjectId a, ObjectId b) const;
  bool meets(BodyIndex a, BodyIndex b) const;
  bool passes(BodyIndex a, BodyIndex b) const;
  void ask(ObjectId one, ObjectId other);
  void let_pass(BodyIndex gate, BodyIndex other);
  void judge_pairs(double h);
  // events.cpp
  bool touches_now(BodyIndex a, BodyIndex b, bool before, Contact& contact) const;
  void find_contacts(BodyIndex body, std::pmr::map<Events::Pair, ContactEvent>& now);
  void add_impulses(std::pmr::map<Events::Pair, ContactEvent>& now);
  void gather_contacts();
  void gather_sleep();

  // --- CollisionClient ----------------------------------------------------------------------------------------------
  bool takes_part(BodyIndex body) const override;
  bool reported(BodyIndex a, BodyIndex b) const override;
  std::uint64_t serial(BodyIndex body) const override;
  void touched(BodyIndex a, BodyIndex b, const Contact& contact, double moment) override;
  void charge(std::uint64_t units) const {
    if (world->behaviour_) world->behaviour_->charge(units);
  }
  void work(std::uint64_t units) override { charge(units); }
  void expect(std::uint64_t units) override {
    if (world->behaviour_) world->behaviour_->expect(units);
  }

  // --- MechanicsClient -----------------------------------------------------------------------------------------------
  bool handled(BodyIndex a, BodyIndex b) const override;
  bool ignored(BodyIndex a, BodyIndex b) const override;
  bool locates() const override { return at_impact; }
  bool any_handled() const override { return handlers.any_handler(); }
  std::uint64_t rules() const override { return handlers.revision() + world->bodies_->revision(); }
  void impact(BodyIndex a, BodyIndex b, const Contact& contact, double moment) override {
    touched(a, b, contact, moment);
  }
  Vector3 stage_force(BodyIndex body, double time, std::uint64_t draw) override;
  Workers* workers() const override { return world->workers_; }

  World* world;
  ObjectTable objects;
  NameTable names;
  Schedule schedule;
  Notifications notifications;
  CollisionHandlers handlers;
  PairRules pairs;
  PairJudge* judge = nullptr;  // not state: the host's
  CollisionStage collisions;
  std::unique_ptr<Mechanics> dynamics;  // Dynamics, or Planar in a flat world; never null
  std::pmr::vector<Stage> stages;
  std::uint32_t stage_signature = 0;
  Effects effects;
  bool exact_schedule = false;
  bool at_impact = true;
  ObjectId first_handler;  // who registered the first collision handler
  double substep_start = 0;
  double share = 1;  // of the work that is left to physics, of this sub-step

  struct Target {
    ObjectId object;
    Vector3 location = Vector3::Zero();
    Quaternion orientation = Quaternion::Identity();
  };
  std::pmr::vector<Target> targets;  // of bodies that go there in the next iteration
  // By body: which of the targets may be its own. It is if the object is the body's; other entries are left behind.
  std::pmr::vector<std::uint32_t> target_places;
  Target* target_of(BodyIndex body);  // null: it has none
  void make_room_for_target(BodyIndex body);
  void add_target(BodyIndex body, const Target& target);  // of a body that has none
  struct Push {
    ObjectId object;
    Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
  };
  std::pmr::vector<Push> pushes;          // beside the forces that are set, in the next iteration
  std::pmr::map<BodyIndex, Target> left;  // where bodies were that scripts have put elsewhere since the last one
  std::uint64_t advanced = 0;             // the last serial of an object that was there in it

  Extent space;
  Queries queries;
  std::uint64_t moved = 0;  // grows whenever a stage of the step may have moved bodies
  NeighborRecord near;      // the last update of neighbours
  std::pmr::deque<InputEvent> input;
  std::pmr::map<std::pmr::string, ResourceLoader, std::less<>> loaders;  // not state: the program's own
};

}  // namespace breve

// A script side made of C++ functions, which writes down every call it gets.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/world/world.hpp"

namespace breve::testing {

/// "what 7 more": how a call is written down.
inline std::string line(std::string_view what, ObjectId agent, std::string_view more = {}) {
  std::string text(what);
  text.append(1, ' ').append(std::to_string(agent.index));
  if (!more.empty()) text.append(1, ' ').append(more);
  return text;
}

class FakeBehaviour : public Behaviour {
 public:
  std::vector<std::string> calls;  // "iterate 0", "scheduled 2 beat", ...
  bool recording = true;
  std::function<void(ObjectId)> on_iterate, on_post_iterate;
  std::function<void(ObjectId, std::string_view)> on_scheduled;
  std::function<bool(ObjectId, ObjectId, const Vector3&, const Vector3&)> on_collided;
  std::function<void(ObjectId, std::string_view)> on_notified;
  std::function<void(const InputEvent&)> on_input;
  std::function<Vector3(ObjectId, double)> on_force;
  std::uint64_t state = 0;  // saved, loaded and hashed

  void iterate(ObjectId agent) override {
    note("iterate", agent);
    if (on_iterate) on_iterate(agent);
  }
  void post_iterate(ObjectId agent) override {
    note("post", agent);
    if (on_post_iterate) on_post_iterate(agent);
  }
  void scheduled(ObjectId agent, std::string_view method) override {
    note("scheduled", agent, method);
    if (on_scheduled) on_scheduled(agent, method);
  }
  bool collided(ObjectId agent, ObjectId other, std::string_view method, const Vector3& point,
                const Vector3& normal) override {
    note("collided", agent, std::to_string(other.index).append(1, ' ').append(method));
    return on_collided ? on_collided(agent, other, point, normal) : false;
  }
  void notified(ObjectId observer, std::string_view method, ObjectId, std::string_view message) override {
    note("notified", observer, std::string(method).append(1, ' ').append(message));
    if (on_notified) on_notified(observer, method);
  }
  void input(const InputEvent& event) override {
    note("input", event.object, event.key);
    if (on_input) on_input(event);
  }
  Vector3 stage_force(ObjectId agent, double time, std::uint64_t) override {
    return on_force ? on_force(agent, time) : Vector3(Vector3::Zero());
  }
  void charge(std::uint64_t) override {}
  void expect(std::uint64_t) override {}
  void end_of_iteration() override {
    if (recording) calls.emplace_back("end");
  }
  void save(ByteWriter& out) const override { out.put(state); }
  void load(ByteReader& in) override { state = in.get<std::uint64_t>(); }
  void hash(Hasher& hasher) const override { hasher.add(state); }

 private:
  void note(std::string_view what, ObjectId agent, std::string_view more = {}) {
    if (recording) calls.push_back(line(what, agent, more));
  }
};

/// A world with its script side; object 0, the controller, advances the bodies.
struct Scene {
  MemoryMeter memory;
  FakeBehaviour script;
  Workers workers;
  World world;
  ObjectId controller;

  explicit Scene(std::uint64_t seed = 1) : world(&memory, seed) {
    world.set_behaviour(&script);
    world.share_workers(&workers);
    controller = world.create(0, 0, true, false);
    script.on_iterate = [this](ObjectId id) {
      if (id == controller) world.advance_bodies();
    };
  }
  ObjectId body(ClassId cls, const Vector3& at, BodyKind kind = BodyKind::Mobile,
                std::shared_ptr<Shape> shape = nullptr) {
    const ObjectId id = world.create(cls, 0, false, false);
    world.embody(id, kind);
    if (shape) world.bodies().set_collision_shape(world.body(id), shape);
    world.bodies().set_location(world.body(id), at);
    return id;
  }
  const Vector3& at(ObjectId id) { return world.bodies().location(world.body(id)); }
  const Vector3& velocity(ObjectId id) { return world.bodies().velocity(world.body(id)); }
  void set_velocity(ObjectId id, const Vector3& v) { world.bodies().set_velocity(world.body(id), v); }
};

}  // namespace breve::testing

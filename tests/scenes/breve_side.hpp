// A scene as a world of breve, made and stepped through breve.h.
#pragma once

#include <vector>

#include "tests/reference/world.hpp"
#include "tests/scenes/scene.hpp"

namespace breve::scenes {

class BreveSide : public Side {
 public:
  BreveSide(const Scene& scene, breve_rung rung, double step);
  void appear(int body) override;
  Vector3 at(int body) const override { return world_.at(bodies_[static_cast<std::size_t>(body)]); }
  double angle(int joint) const override;
  void set_force(int body, const Vector3& force) override;
  void set_velocity(int body, const Vector3& velocity) override;
  void set_motor(int joint, double speed) override;
  void step() override { world_.step(); }

  reference::World& world() { return world_; }
  breve_object body(int number) const { return bodies_[static_cast<std::size_t>(number)]; }
  breve_object joint(int number) const { return joints_[static_cast<std::size_t>(number)]; }

 private:
  void add_shape(const Shape& shape);
  void add_joint(const Joint& joint);
  void add_spring(const Spring& spring);

  const Scene& scene_;
  reference::World world_;
  std::vector<breve_object> shapes_, bodies_, joints_;
};

}  // namespace breve::scenes

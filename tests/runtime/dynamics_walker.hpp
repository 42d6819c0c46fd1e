// The nine-link walker of the sample, in C++: a box body and four limbs of two sections, hinges driven by sines.
#pragma once

#include <array>
#include <numbers>

#include "dynamics_scene.hpp"
#include "runtime/base/random.hpp"

namespace breve::testing {

/// One walker in a world.
struct WalkerBody {
  ObjectId trunk;
  std::vector<ObjectId> links;
  std::vector<JointIndex> hinges;

  WalkerBody(Physics& in, const Vector3& at) {
    trunk = in.rigid(Shape::box(Vector3(2, 0.5, 1)), at);
    links.push_back(trunk);
    for (const double x : {-0.8, 0.8})
      for (const double z : {-0.65, 0.65}) {
        const ObjectId thigh = hang(in, trunk, Vector3(x, -0.2, z), Vector3(0, 0.3, 0), Vector3(0.25, 0.7, 0.25));
        hang(in, thigh, Vector3(0, -0.35, 0), Vector3(0, 0.35, 0), Vector3(0.2, 0.7, 0.2));
      }
    for (const ObjectId link : links) {
      Material& material = in.world.bodies().material(in.index(link));
      material.static_friction = 1;
      material.dynamic_friction = 0.8;
      material.normal_restitution = 0;
    }
  }
  ObjectId hang(Physics& in, ObjectId parent, const Vector3& on_parent, const Vector3& on_child, const Vector3& size) {
    const ObjectId id = in.rigid(Shape::box(size), Vector3::Zero());
    JointDescription is;
    is.parent = in.index(parent);
    is.child = in.index(id);
    is.parent_point = on_parent;
    is.child_point = on_child;
    is.normal = Vector3::UnitZ();
    hinges.push_back(in.mechanics().link(is, id));
    JointDrive drive = in.mechanics().drive(hinges.back());
    drive.strength_limit = 6;
    drive.damping = 0.05;
    in.mechanics().set_drive(hinges.back(), drive);
    links.push_back(id);
    return id;
  }
  /// The motor of one hinge aims at a sine of time.
  void aim(Physics& in, std::size_t hinge, double wavelength, double phase, double amplitude) const {
    const double goal = amplitude * std::sin(2 * std::numbers::pi * (in.world.time() / wavelength + phase));
    JointDrive drive = in.mechanics().drive(hinges[hinge]);
    drive.motor_speed[0] = 8 * (goal - in.mechanics().position(hinges[hinge])[0]);
    in.mechanics().set_drive(hinges[hinge], drive);
  }
};

struct WalkersGround : Physics {
  WalkersGround(Rung rung, double step) : Physics(step) {
    mechanics().set_accuracy(rung);
    floor = body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(1000, 5, 1000)));
  }
  ObjectId floor;
};

struct Walker : WalkersGround, WalkerBody {
  explicit Walker(Rung rung, double step = 1.0 / 60)
      : WalkersGround(rung, step), WalkerBody(static_cast<Physics&>(*this), Vector3(0, 1.7, 0)) {}
  void step() {
    for (std::size_t i = 0; i < hinges.size(); ++i)
      aim(*this, i, 0.9, 0.13 * static_cast<double>(i * i % 7), 0.3 + 0.1 * static_cast<double>(i % 4));
    world.step();
  }
};

/// Walkers with genes as the sample draws them, in rows 6 m apart: far enough that they do not meet.
struct Crowd : WalkersGround {
  explicit Crowd(int count, Rung rung, double step = 1.0 / 60) : WalkersGround(rung, step) {
    Random random(5);
    for (int i = 0; i < count; ++i) {
      walkers.emplace_back(*this, Vector3(6.0 * (i % 15), 1.7, 6.0 * (i / 15)));
      Genes& one = genes.emplace_back();
      one.wavelength = 0.5 + 1.5 * random.uniform();
      for (double& phase : one.phases) phase = random.uniform();
      for (double& amplitude : one.amplitudes) amplitude = random.uniform();
    }
  }
  void step() {
    for (std::size_t w = 0; w < walkers.size(); ++w)
      for (std::size_t i = 0; i < walkers[w].hinges.size(); ++i)
        walkers[w].aim(*this, i, genes[w].wavelength, genes[w].phases[i], genes[w].amplitudes[i]);
    world.step();
  }

  struct Genes {
    double wavelength = 1;
    std::array<double, 8> phases{}, amplitudes{};
  };
  std::vector<WalkerBody> walkers;
  std::vector<Genes> genes;
};

}  // namespace breve::testing

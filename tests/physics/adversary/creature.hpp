// A creature in a world of its own, built through breve.hpp as a host would.
#pragma once

#include <Eigen/Geometry>
#include <breve/breve.hpp>
#include <vector>

#include "genes.hpp"

namespace adversary {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Quaternion = Eigen::Quaterniond;

/// What the searcher knows of a link: it made it.
struct Body {
  breve_object object{};
  double mass = 0;
  Vector3 inertia = Vector3::Zero();  // about the centre, own axes
  Vector3 half = Vector3::Zero();     // half edges of the box that holds its shape
};

/// And of a joint.
struct Joint {
  breve_object object{};
  breve_joint_kind kind = BREVE_JOINT_FIXED;
  int parent = -1, child = -1;  // bodies; -1: the world
  Vector3 on_parent = Vector3::Zero(), on_child = Vector3::Zero();
  Vector3 axis = Vector3::UnitX(), other = Vector3::UnitY();  // in the parent's frame, at zero
  Quaternion zero = Quaternion::Identity();                   // of the child relative to the parent
  breve_drive drive{};
  int axes = 0;
  double speed = 0, torque = 0, frequency = 0, phase = 0;  // how it is driven

  double beat(double time, int k) const;  // -1 to 1
};

/// A Spring between two bodies, centre to centre.
struct Spring {
  int a = -1, b = -1;
  double strength = 0, length = 0;
};

struct Pose {
  Vector3 at = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
};

class Creature {
 public:
  /// @throws breve::Failure  if the library refuses it
  Creature(const Case& is, breve_rung rung, double step);

  breve::World& world() { return world_; }
  const breve::World& world() const { return world_; }
  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Joint>& joints() const { return joints_; }  // of the tree, in order
  const Spring& spring() const { return spring_; }
  Vector3 gravity() const { return gravity_; }

  Pose pose(int body) const;  // -1: the world's
  /// Sets motors and forces for the iteration that begins now.
  void drive();
  bool driven() const { return driven_; }

 private:
  void add_link(const LinkGenes& genes, const Case& is);
  void join(const LinkGenes& genes, const Case& is, int link);
  void set_drive(const LinkGenes& genes, const Case& is, Joint& joint);
  void close_loop(const Case& is);
  void add_spring(const Case& is);
  void place(const Case& is);
  void set_off(const Case& is);
  bool entangled() const;  // do links overlap that no joint connects directly?
  double lowest() const;

  breve::Runtime runtime_;
  breve::Program program_;
  breve::World world_;
  std::vector<Body> bodies_;
  std::vector<Joint> joints_;
  Spring spring_;
  Vector3 gravity_ = Vector3::Zero();
  int loop_a_ = -1, loop_b_ = -1;
  bool driven_ = false;
};

}  // namespace adversary

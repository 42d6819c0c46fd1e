// What positions that are put right by hand do to velocities.
#pragma once

#include "runtime/planar/response.hpp"

namespace breve {

/// Velocities of bodies that are moved by hand, where joints close loops. Bodies that go back all together do not go on
/// where they came from: links in one line may all move across it, as far as velocities tell, and are brought back in
/// each sub-step since they do not reach so far. Their speed would grow meanwhile.
class MovedBack {
 public:
  /// @param move  of its centre, Box2D's length units, and its rotation, rad
  void add(const FlatBody& flat, const Vector3& move) {
    const Vector3 momentum = weight_of(flat).cwiseProduct(move);
    along_ += momentum.dot(velocity_of(flat));
    square_ += momentum.dot(move);
    looped_ = looped_ || flat.looped;
  }
  /// After all were added: takes from a body's velocity what goes the other way.
  void stop(const FlatBody& flat, const Vector3& move) const {
    if (!looped_ || !(along_ < 0 && square_ > 0)) return;
    const Vector3 v = velocity_of(flat) - along_ / square_ * move;
    flat.b2->SetLinearVelocity(b2Vec2(static_cast<float>(v[0]), static_cast<float>(v[1])));
    flat.b2->SetAngularVelocity(static_cast<float>(v[2]));
  }

 private:
  static Vector3 weight_of(const FlatBody& flat) {
    return {double{flat.b2->GetMass()}, double{flat.b2->GetMass()}, Response::inertia(flat)};
  }
  static Vector3 velocity_of(const FlatBody& flat) {
    const b2Vec2 v = flat.b2->GetLinearVelocity();
    return {double{v.x}, double{v.y}, double{flat.b2->GetAngularVelocity()}};
  }

  double along_ = 0, square_ = 0;
  bool looped_ = false;
};

}  // namespace breve

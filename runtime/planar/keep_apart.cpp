// Overlaps of an island: what closing joints has moved into something else is moved out of it, together with all that
// it touches. Joints have no rows here either, as what they connect moves as a whole.
#include <algorithm>

#include "runtime/planar/island.hpp"
#include "runtime/planar/moved_back.hpp"

namespace breve {

/// What each contact is to gain at least, as the bias of its rows.
void Planar::Core::Island::aim_apart(std::span<const Apart> before) {
  constexpr double kRests = -double{b2_linearSlop};  // an overlap that Box2D leaves
  std::size_t next = 0;
  for (b2Contact* contact : contacts_) {
    b2WorldManifold where;
    contact->GetWorldManifold(&where);
    const auto found = std::lower_bound(before.begin(), before.end(), Apart{contact, {}}, Apart::sooner);
    const bool known = found != before.end() && found->contact == contact;
    for (int k = 0; k < contact->GetManifold()->pointCount; ++k) {
      contact::Row& row = rows_[next++];
      const double now = double{where.separations[k]};
      row.bias = std::min(known ? double{found->separations[k]} : now, kRests) - now;
      row.static_friction = row.dynamic_friction = 0;
    }
  }
}

void Planar::Core::Island::keep_apart(std::span<const Apart> before) {
  constexpr double kExact = 1e-2 * double{b2_linearSlop};
  if (!make_parts()) return;
  make_contact_rows();
  aim_apart(before);
  for (const contact::Mover& mover : movers_) std::fill_n(mover.v, mover.size, 0.0);
  solve(kExact);
  MovedBack back;
  for (FlatBody* flat : bodies_) back.add(*flat, move_of(*flat));
  for (FlatBody* flat : bodies_) {
    const Vector3 moved = move_of(*flat);
    b2Body& b = *flat->b2;
    const b2Vec2 move(static_cast<float>(moved[0]), static_cast<float>(moved[1]));
    const float angle = b.GetAngle() + static_cast<float>(moved[2]);
    if (move == b2Vec2(0, 0) && angle == b.GetAngle()) continue;
    b.SetTransform(b.GetWorldCenter() + move - b2Mul(b2Rot(angle), b.GetLocalCenter()), angle);
    back.stop(*flat, moved);
  }
}

/// How a body moves by the velocities of its part: along x and y, and about z.
Vector3 Planar::Core::Island::move_of(const FlatBody& flat) {
  const Part& part = part_of(flat);
  if (!part.response) return {part.v[0], part.v[1], part.v[5]};
  const auto at = static_cast<std::size_t>(part.response->index_of(flat));
  return {part.v[at], part.v[at + 1], part.v[at + 2]};
}

}  // namespace breve

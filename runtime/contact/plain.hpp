// Contacts between free bodies as the sweeps of a pile read them: in world axes, and both bodies at once, each in its
// own lane of a vector of two. An impulse that sticks then needs no turning to and fro.
#pragma once

#include <cstddef>

#include "runtime/contact/lanes.hpp"

namespace breve::contact {

struct Workspace;

/// Lanes hold numbers of its two bodies; those of the second have the opposite sign where it feels the opposite
/// impulse.
struct PlainPoint {
  Lanes arm[3];            // m
  Lanes mass;              // inverse
  Lanes angular[9];        // change of spin by an impulse, row by row
  double normal[3];        // from b toward a
  double inverse[6];       // of the response, made regular and with softness: xx, xy, xz, yy, yz, zz
  double coupling[3];      // what an impulse does to the normal velocity
  double impulse[3];       // on a
  double step[3], way[3];  // as Point has them
  double pressed;          // normal part of the impulse
  double bias, softness, friction;
  double give;     // response along the normal, with softness
  double largest;  // response along any of the contact's axes, at most
  int a, b;        // packed movers; 0 is the world
};

/// All rows are contacts between free bodies, or such and the world.
bool is_plain(const Workspace& work);

/// As sweep.hpp has them.
struct Moved {
  double largest = 0;  // change of a row's velocity that its own impulse made, m/s, at least
  double energy = 0;   // J: of all changes, as if each were alone
};

/// One sweep over them in the order of points, or in the opposite one.
Moved sweep_plain(Workspace& work, bool backward);
/// Impulses go on the way they went, by that share of it.
void go_on_plain(Workspace& work, double share);

/// For an island whose points' sides are all free bodies or the world: impulses, frictions and biases are read from the
/// points before the sweeps, and impulses given back after them. The rest is made when it is first asked for.
void enter_plain(Workspace& work);
void leave_plain(Workspace& work);

}  // namespace breve::contact

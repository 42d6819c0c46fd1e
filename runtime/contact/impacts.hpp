// Several impacts at one moment: pair by pair in a defined order, and what is left over all at once.
#pragma once

#include <span>

#include "runtime/contact/law.hpp"
#include "runtime/contact/solver.hpp"

namespace breve::contact {

struct ImpactSettings {
  int most = 64;                       // impacts pair by pair before what is left over is stopped without rebound
  double tolerance = 1e-10;            // m/s; slower approaches do not count
  SolveSettings rest{50, true, 1e-9};  // how that is solved
};

struct ImpactReport {
  int impacts = 0;
  bool settled = false;  // nothing was left over for the solve without rebound
};

/// Let everything that approaches collide. Again and again the pair (Row::pair) with the fastest approach collides, the
/// earlier one of equals: by the law of Chatterjee and Ruina if it touches in one point; if in several, all its points
/// at once, so that a box that lands flat stays flat: Newton's restitution with Coulomb friction in each, shortened
/// toward the impulses without rebound until no energy is gained. When no approach is left that would bounce, or after
/// `most` impacts, one solve without rebound stops the others and satisfies the scalar rows. The kinetic energy does
/// not grow. Rows' biases are not read; impulses are results only.
/// @param laws  one for each row
ImpactReport resolve_impacts(std::span<const Mover> movers, std::span<Row> rows, std::span<const Law> laws,
                             std::span<ScalarRow> scalars, const ImpactSettings& settings, Workspace& workspace);

}  // namespace breve::contact

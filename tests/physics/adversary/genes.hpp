// What a creature and its world are made of, as numbers: so that a search can draw, change, write and shrink them
// without knowing what they mean.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace adversary {

/// Numbers of a link and of the joint that holds it.
enum LinkGene {
  kParent,  // number of an earlier link; of the first one nothing
  kJoint,   // breve_joint_kind
  kShape,   // 0 sphere, 1 box, 2 octahedron
  kSizeX,
  kSizeY,
  kSizeZ,  // m, edges of the box that holds the shape
  kMass,   // kg
  kAtX,
  kAtY,
  kAtZ,  // the joint's point on the parent, in halves of its edges
  kOnX,
  kOnY,
  kOnZ,  // and on the link
  kAxisX,
  kAxisY,
  kAxisZ,  // the joint's axis in the parent's frame, of any length
  kRotationX,
  kRotationY,
  kRotationZ,  // rotation vector of the link relative to its parent at zero, rad
  kRateX,
  kRateY,
  kRateZ,    // rates of the joint at the start, rad/s or m/s
  kReach,    // limits at -reach and +reach, rad or m; 0: none
  kRebound,  // restitution of the limits
  kStiffness,
  kRest,
  kDamping,  // spring and damper in the joint
  kSpeed,
  kStrength,  // motor: wanted rate, and strength per kg of the link; strength 0: none
  kTorque,    // force along the axes that the host sets, per kg of the link
  kFrequency,
  kPhase,  // of speed and torque, Hz and rad; 0 Hz: constant
  kLinkGenes
};

/// Numbers of the whole creature and its world.
enum WorldGene {
  kLinks,
  kSelfCollisions,
  kLoop,
  kLoopA,
  kLoopB,  // a joint that closes a loop: 0 none, 1 ball, 2 revolute
  kLoopX,
  kLoopY,
  kLoopZ,  // its point on link A, in halves of its edges
  kSpring,
  kSpringA,
  kSpringB,
  kSpringLength,  // a Spring between two links: N/m (0: none), m
  kFriction,
  kRestitution,
  kThreshold,  // of all surfaces
  kVelocityX,
  kVelocityY,
  kVelocityZ,  // m/s, of the first link at the start
  kSpinX,
  kSpinY,
  kSpinZ,  // rad/s
  kTiltX,
  kTiltY,
  kTiltZ,   // rotation vector of the first link at the start
  kHeight,  // m, of the lowest point above the floor
  kWorldGenes
};

/// How a gene is drawn.
enum class Draw : std::uint8_t { Linear, Logarithmic, Whole };

struct Range {
  const char* name;
  double low, high;
  Draw draw;
  double plain;   // what the gene is where it does not matter: what shrinking tries
  double chance;  // of being plain when a creature is drawn
};
const Range& range_of(LinkGene gene);
const Range& range_of(WorldGene gene);

/// What the creature does and where.
enum class Family : std::uint8_t {
  Drift,    // no gravity, no motors: limits, springs, collisions among its links
  Swim,     // no gravity, with motors and forces in its joints
  Fall,     // free flight under gravity
  Hang,     // its first link is joined to the world
  Drop,     // on a floor, without motors
  Walk,     // on a floor, with motors
  Overlap,  // colliding with itself from the start, no gravity
};
inline constexpr int kFamilies = 7;
const char* name_of(Family family);
bool family_named(const std::string& name, Family& family);
inline bool has_floor(Family f) { return f == Family::Drop || f == Family::Walk; }
inline bool has_gravity(Family f) { return f == Family::Fall || f == Family::Hang || has_floor(f); }
inline bool has_motors(Family f) { return f != Family::Drift && f != Family::Drop && f != Family::Overlap; }

using LinkGenes = std::array<double, kLinkGenes>;

struct Case {
  Family family = Family::Drift;
  std::array<double, kWorldGenes> world{};
  std::vector<LinkGenes> links;

  double operator[](WorldGene gene) const { return world[gene]; }
  bool on(WorldGene gene) const { return world[gene] >= 0.5; }
  int count() const { return static_cast<int>(links.size()); }
};

/// A generator of its own: the same numbers with every standard library. Source: Vigna 2015, splitmix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next();
  double unit();  // 0 <= x < 1
  double between(double low, double high) { return low + (high - low) * unit(); }
  int below(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }
  bool chance(double of) { return unit() < of; }

 private:
  std::uint64_t state_;
};

Case draw_case(Family family, Random& random);
/// A child of `one`: some genes drawn anew or moved a little, sometimes a link more or less.
Case mutate(const Case& one, Random& random);
/// Takes a link away; its children are held by its parent.
Case without_link(const Case& one, int link);

/// As text that `read_case` understands: one line for each link and for the world, plain genes left out.
std::string write_case(const Case& one);
/// @throws std::runtime_error  with the line that is wrong
Case read_case(const std::string& text);

}  // namespace adversary

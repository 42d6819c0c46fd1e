// What the contact solver keeps between calls so that it allocates nothing: rows as its loops read them, packed.
#pragma once

#include <cstddef>
#include <memory_resource>
#include <utility>
#include <vector>

#include "runtime/contact/cone.hpp"
#include "runtime/contact/plain.hpp"

namespace breve::contact {

/// A mover as the sweeps read it. A free body's velocity is kept here while they run, a tree's stays in its place.
struct Packed {
  double v[6];          // free: velocity, spin
  double inverse_mass;  // 0: the world, or a tree
  double inertia[6];    // inverse, world axes: xx, xy, xz, yy, yz, zz
  double* source;       // where v comes from and goes to; null: the world
  int size;
  bool free;

  double* now() { return free ? v : source; }
  const double* now() const { return free ? v : source; }
};

/// A contact as the sweeps read it.
struct Point {
  int a, b;    // packed movers; 0 is the world
  bool plain;  // both sides are free bodies with arms, or the world
  double friction;
  double normal[3], tangent1[3], tangent2[3];
  double arm_a[3], arm_b[3];
  double bias, softness;
  LocalMatrix response;  // softness included
  LocalMatrix inverse;   // of it, made regular
  double impulse[3];
  double step[3], way[3];  // what the last sweep changed, and where it goes on to
};

/// What one number of a mover's v adds to the velocity at a point: along the normal and the first tangent, and along
/// the second tangent and nothing.
struct Column {
  Lanes first, second;
};

/// A contact's matrices, if a side has them, and the velocity it had without any impulse. A point of a tree moves with
/// the joints between it and the root: behind that many numbers, rows of ja and jb are zero.
struct Sides {
  const double *ja, *ra, *jb, *rb;
  int reach_a, reach_b;
  std::size_t columns_a, columns_b;  // of ja and jb, as far as they reach, in Workspace::columns
  double free_velocity[3];
};

/// A scalar row as the sweeps read it.
struct PackedScalar {
  int a, b;  // packed movers; 0 is the world
  const double *ja, *ra, *jb, *rb;
  int first_a, reach_a, first_b, reach_b;  // ja and jb are zero before and behind these
  double bias, softness, lo, hi;
  double response;  // softness included; 0: nothing can move it
  double impulse;
  double free_velocity;
  double step, way;
};

/// What a point whose two coefficients of friction differ was found to do.
enum class Grip : unsigned char {
  Unsettled,  // static; may yet slide
  GoesOn,     // dynamic, since it slid before; may yet come to rest
  Slides,     // dynamic: the static one could not hold it
  Holds       // static for good
};

/// How p depends on the velocity at its contact: dp = -D du.
struct Slope {
  double nn = 0, n1 = 0, n2 = 0;
  double t1n = 0, t2n = 0;  // friction's limit follows the normal impulse
  double t11 = 0, t12 = 0, t21 = 0, t22 = 0;
};

/// A contact's normal, or a scalar row, as sweeps without friction read it.
struct NormalRow {
  double impulse, bias, softness, response, lo, hi;
  double step, way;
};

/// A row of the only mover that rows move.
struct LoneRow {
  const double *j, *r;
  int first, reach;  // j is zero before and behind these
  bool on_a;         // the mover is the first of the row's two
};

struct Workspace {
  explicit Workspace(std::pmr::memory_resource* memory)
      : movers(memory),
        began(memory),
        points(memory),
        plain(memory),
        sides(memory),
        columns(memory),
        scalars(memory),
        grips(memory),
        numbers(memory),
        slopes(memory),
        indices(memory),
        order(memory),
        firsts(memory),
        neighbors(memory),
        saved(memory),
        earlier(memory),
        biases(memory),
        all_points(memory),
        all_sides(memory),
        kept(memory),
        called(memory),
        answers(memory),
        rates(memory),
        normal_answers(memory),
        normal_rates(memory),
        normals(memory),
        lone(memory) {}
  std::pmr::vector<Packed> movers;
  std::pmr::vector<double> began;  // velocities of the trees without any impulse
  std::pmr::vector<Point> points;
  std::pmr::vector<PlainPoint> plain;  // the same for sweeps, where they were asked for
  std::pmr::vector<Sides> sides;
  std::pmr::vector<Column> columns;
  std::pmr::vector<PackedScalar> scalars;
  std::pmr::vector<Grip> grips;
  std::pmr::vector<double> numbers;  // of the direct solver
  std::pmr::vector<Slope> slopes;
  std::pmr::vector<int> indices;
  std::pmr::vector<int> order, firsts;  // of impacts in groups; of an elimination
  std::pmr::vector<std::pair<int, int>> neighbors;
  std::pmr::vector<double> saved, earlier, biases;
  std::pmr::vector<Point> all_points;  // see aside.hpp: all of them; the places among these of those that are left,
  std::pmr::vector<Sides> all_sides;
  std::pmr::vector<std::size_t> kept;
  std::pmr::vector<char> called;  // and which are not set aside again
  bool has_plain = false;
  bool condensed = false;            // see condensed.hpp:
  std::pmr::vector<double> answers;  // W, symmetric, row by row
  std::pmr::vector<double> rates;    // velocities at the rows: three a point, then one a scalar row
  bool by_normals = false;           // see normals.hpp:
  std::pmr::vector<double> normal_answers;
  std::pmr::vector<double> normal_rates;  // their velocities
  std::pmr::vector<NormalRow> normals;
  std::pmr::vector<LoneRow> lone;
};

}  // namespace breve::contact

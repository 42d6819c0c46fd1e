// Velocities that scripts set on bodies that joints connect: an impulse on each body that was set, so that it gets what
// was asked and all the others answer; and velocities that whole assemblies get.
#include <Eigen/QR>
#include <algorithm>

#include "runtime/planar/response.hpp"

namespace breve {

/// Velocities of these bodies are as the arrays have them now, and nobody else answers.
void Planar::Core::give_velocities(std::span<const BodyIndex> some) {
  for (const BodyIndex body : some) {
    FlatBody* flat = find(body);
    if (!flat || flat->fixed) continue;
    const double before = kinetic_of(*flat);
    push_velocity(*flat);
    ledger.script_work += kinetic_of(*flat) - before;
    flat->b2->SetAwake(true);
    note_known(*flat);
  }
}

/// Those of an assembly are brought to the nearest ones, by kinetic energy, that its joints allow.
void Planar::Core::allow_velocities(BodyIndex body) {
  FlatBody* flat = find(body);
  if (!flat || !flat->jointed) return;
  const Response response(*this, nullptr, flat);
  const double before = response.kinetic();
  response.give(response.allowed(response.velocities()));
  ledger.script_work += (response.kinetic() - before) * settings.unit * settings.unit;
  for (FlatBody* one : response.bodies()) take_velocity(*one);
}

/// From Box2D's body to the arrays; what differs from what a script set by rounding stays as it was set.
void Planar::Core::take_velocity(FlatBody& flat) {
  constexpr double kRounding = 1e-6;
  const double spin = flat.b2->GetAngularVelocity();
  const Vector3 arm = bodies->orientation(flat.body) * flat.mass.center_of_mass;
  const Vector3 velocity = from_b2(flat.b2->GetLinearVelocity()) - spin * Vector3(-arm.y(), arm.x(), 0);
  const Vector3 set = bodies->velocity(flat.body);
  const double set_spin = bodies->rotational_velocity(flat.body).z();
  const bool same = (velocity - set).norm() <= kRounding * (set.norm() + std::abs(spin) * arm.norm());
  const bool same_spin = std::abs(spin - set_spin) <= kRounding * std::abs(set_spin);
  bodies->set_motion(flat.body, bodies->location(flat.body), bodies->orientation(flat.body), same ? set : velocity,
                     {0, 0, same_spin ? set_spin : spin});
  note_known(flat);
}

void Planar::Core::strike(std::span<const Strike> some) {
  const Response response(*this, nullptr, find(some.front().body));
  using Vector = Response::Vector;
  const double before = response.kinetic(), u = settings.unit;
  // Bodies that were linked since the last step still have velocities of their own, which their joints do not allow.
  response.give(response.allowed(response.velocities()));
  const Vector had = response.velocities();
  constexpr std::size_t kMostSolved = 8;
  if (some.size() > kMostSolved) {
    // As if all had got these velocities before the joints were closed.
    for (const Strike& one : some) push_velocity(*find(one.body));
    response.give(response.allowed(response.velocities()));
  } else {
    // A number for each component that was set: the velocity of a body's origin, its spin. Impulses act at centres of
    // mass; what was not set is free, and nothing pushes along it.
    struct Axis {
      Eigen::Index at;
      int axis;     // 2: spin
      Vector2 arm;  // from the centre of mass to the origin
      double wanted;
    };
    const auto seen = [](const Axis& axis, const Vector& v) {
      return axis.axis == 2 ? v[axis.at + 2] : v[axis.at + axis.axis] + v[axis.at + 2] * left_of(axis.arm)[axis.axis];
    };
    std::pmr::vector<Axis> axes(memory);
    for (const Strike& one : some) {
      const FlatBody& flat = *find(one.body);
      const Vector3 center = bodies->orientation(one.body) * flat.mass.center_of_mass;
      for (int i = 0; i < 3; ++i)
        if (i < 2 ? one.pushed : one.spun)
          axes.push_back({response.index_of(flat), i, -center.head<2>() / u,
                          i < 2 ? bodies->velocity(one.body)[i] / u : bodies->rotational_velocity(one.body).z()});
    }
    const auto count = static_cast<Eigen::Index>(axes.size());
    Eigen::MatrixXd answers(response.size(), count), moves(count, count);
    Vector wanted(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Axis& axis = axes[static_cast<std::size_t>(i)];
      Vector unit = Vector::Zero(response.size());
      unit[axis.at + axis.axis] = 1;
      answers.col(i) = response.answer(unit);
      for (Eigen::Index k = 0; k < count; ++k) moves(k, i) = seen(axes[static_cast<std::size_t>(k)], answers.col(i));
      wanted[i] = axis.wanted - seen(axis, had);
    }
    // The joints may allow less than was asked: then as near as it can be. They are held to a part in 1e12, so what
    // they forbid gives way a little.
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-8);
    response.give(answers * solver.compute(moves).solve(wanted));
  }
  ledger.script_work += (response.kinetic() - before) * u * u;
  for (FlatBody* one : response.bodies()) {
    one->b2->SetAwake(true);
    take_velocity(*one);
  }
}

/// One strike for each assembly, of all that was set on it.
void Planar::Core::strike_all(std::pmr::vector<Strike>& all) {
  // The order in which a script set them must not matter.
  std::sort(all.begin(), all.end(), [this](const Strike& p, const Strike& q) {
    return std::pair(find(p.body)->assembly, p.body) < std::pair(find(q.body)->assembly, q.body);
  });
  for (auto from = all.begin(); from != all.end();) {
    const std::uint32_t assembly = find(from->body)->assembly;
    const auto to =
        std::find_if(from, all.end(), [&](const Strike& one) { return find(one.body)->assembly != assembly; });
    strike({from, to});
    from = to;
  }
}

}  // namespace breve

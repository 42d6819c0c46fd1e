// The joints of one assembly as a sparse system of equations: which impulses of joints give which velocities.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace breve {

/// J M^-1 J^T of an assembly, factored as L D L^T in blocks of 3 x 3, one row of blocks a joint. Two joints couple
/// where they hold the same body, so a chain costs time in proportion to its joints. Loops only add blocks. The
/// structure is planned once; factoring and solving allocate nothing.
class JointSystem {
 public:
  using Block = Eigen::Matrix3d;
  using Vector = Eigen::Vector3d;
  /// The bodies that a joint connects, by their numbers in the assembly; -1: one that does not move by itself.
  struct Ends {
    int parent, child;
  };
  /// How the rates of a joint follow from the velocities (x, y, angular) of its bodies. A row of zeros is not used.
  struct Rates {
    Block parent, child;
  };

  /// Loops may hold some things twice: a little softness keeps the matrix regular.
  static constexpr double kRegular = 1e-10;

  explicit JointSystem(std::pmr::memory_resource* memory);
  /// @param ends  in the order of elimination: best from the leaves of a tree to its root
  /// Returns false if factoring would cost too much.
  bool plan(std::span<const Ends> ends);
  std::size_t size() const { return ends_.size(); }
  std::size_t blocks() const { return below_.size() + ends_.size(); }
  const Ends& ends(std::size_t joint) const { return ends_[joint]; }
  Rates& rates(std::size_t joint) { return rates_[joint]; }

  /// @param mobility  by body: inverse mass, inverse mass, inverse inertia
  /// @param softness  of each row, relative to its own response
  void factor(std::span<const Vector> mobility, double softness = kRegular);
  /// Impulses, by joint, that change its rates by these.
  void solve(std::span<Vector> rates) const;
  /// The rates of a joint at these velocities of the bodies.
  Vector rate_of(std::size_t joint, std::span<const Vector> velocities) const;
  /// Adds what the impulses of all joints change the velocities of bodies by.
  void spread(std::span<const Vector> impulses, std::span<Vector> velocities) const;

 private:
  /// A block below the diagonal, of two joints.
  struct Place {
    std::uint32_t row, column;
  };
  /// A body that two joints, or one, hold, and the block that it adds to.
  struct Coupling {
    std::uint32_t first, second, block;  // the first is eliminated first
    bool of_child_first, of_child_second;
  };
  /// One product in the elimination of a column.
  struct Update {
    std::uint32_t upper, lower, block;  // the block of the diagonal if upper == lower
  };
  std::uint32_t block_at(std::uint32_t row, std::uint32_t column) const;
  bool plan_blocks();
  void plan_couplings();
  void plan_updates();
  void eliminate();

  std::pmr::vector<Ends> ends_;
  std::pmr::vector<Rates> rates_, spreads_;       // spreads_: M^-1 times the transpose
  std::pmr::vector<Place> places_;                // of below_, column after column
  std::pmr::vector<std::uint32_t> first_;         // block of a column, and one beyond
  std::pmr::vector<std::uint32_t> first_update_;  // of a column, and one beyond
  std::pmr::vector<Coupling> couplings_;
  std::pmr::vector<Update> updates_;
  std::pmr::vector<Block> diagonal_, inverse_, below_, factors_;
};

}  // namespace breve

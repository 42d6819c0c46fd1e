// A sparse factorization in blocks, planned once for each structure (George and Liu 1981, ch. 5).
#include "runtime/planar/joint_system.hpp"

#include <algorithm>

namespace breve {

JointSystem::JointSystem(std::pmr::memory_resource* memory)
    : ends_(memory),
      rates_(memory),
      spreads_(memory),
      places_(memory),
      first_(memory),
      first_update_(memory),
      couplings_(memory),
      updates_(memory),
      diagonal_(memory),
      inverse_(memory),
      below_(memory),
      factors_(memory) {}

bool JointSystem::plan(std::span<const Ends> ends) {
  ends_.assign(ends.begin(), ends.end());
  if (!plan_blocks()) return false;
  plan_couplings();
  plan_updates();
  const std::size_t joints = ends_.size();
  rates_.assign(joints, {Block::Zero(), Block::Zero()});
  spreads_ = rates_;
  diagonal_.assign(joints, Block::Zero());
  inverse_ = diagonal_;
  below_.assign(places_.size(), Block::Zero());
  factors_ = below_;
  return true;
}

/// Which blocks are not zero: of joints that share a body, and those that elimination fills.
bool JointSystem::plan_blocks() {
  constexpr std::size_t kMostPerJoint = 8, kAlways = 64;  // blocks
  const std::size_t joints = ends_.size(), most = kMostPerJoint * joints + kAlways;
  std::pmr::memory_resource* memory = ends_.get_allocator().resource();
  int bodies = 0;
  for (const Ends& ends : ends_) bodies = std::max({bodies, ends.parent + 1, ends.child + 1});
  std::pmr::vector<std::pmr::vector<std::uint32_t>> at(static_cast<std::size_t>(bodies), memory),
      columns(joints, memory);
  for (std::uint32_t i = 0; i < joints; ++i)
    for (const int body : {ends_[i].parent, ends_[i].child})
      if (body >= 0) at[static_cast<std::size_t>(body)].push_back(i);
  std::size_t count = 0;
  for (std::uint32_t k = 0; k < joints; ++k) {
    std::pmr::vector<std::uint32_t>& column = columns[k];
    for (const int body : {ends_[k].parent, ends_[k].child})
      if (body >= 0)
        for (const std::uint32_t other : at[static_cast<std::size_t>(body)])
          if (other > k) column.push_back(other);
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    count += column.size();
    if (count > most) return false;
    // The rest of the column fills that of the next joint in it, and through it those after.
    if (!column.empty()) columns[column[0]].insert(columns[column[0]].end(), column.begin() + 1, column.end());
  }
  places_.clear();
  first_.assign(1, 0);
  for (std::uint32_t k = 0; k < joints; ++k) {
    for (const std::uint32_t row : columns[k]) places_.push_back({row, k});
    first_.push_back(static_cast<std::uint32_t>(places_.size()));
  }
  return true;
}

std::uint32_t JointSystem::block_at(std::uint32_t row, std::uint32_t column) const {
  const auto begin = places_.begin() + first_[column], end = places_.begin() + first_[column + 1];
  const auto found = std::lower_bound(begin, end, row, [](const Place& p, std::uint32_t r) { return p.row < r; });
  return static_cast<std::uint32_t>(found - places_.begin());
}

void JointSystem::plan_couplings() {
  couplings_.clear();
  std::pmr::vector<std::pair<int, std::uint32_t>> sides(ends_.get_allocator());  // a body; twice the joint, + 1: child
  for (std::uint32_t i = 0; i < ends_.size(); ++i) {
    if (ends_[i].parent >= 0) sides.emplace_back(ends_[i].parent, 2 * i);
    if (ends_[i].child >= 0) sides.emplace_back(ends_[i].child, 2 * i + 1);
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t k = i; k < sides.size() && sides[k].first == sides[i].first; ++k) {
      const std::uint32_t first = sides[i].second / 2, second = sides[k].second / 2;
      const std::uint32_t block = first == second ? 0 : block_at(second, first);
      couplings_.push_back({first, second, block, sides[i].second % 2 == 1, sides[k].second % 2 == 1});
    }
}

void JointSystem::plan_updates() {
  updates_.clear();
  first_update_.assign(1, 0);
  for (std::uint32_t k = 0; k < ends_.size(); ++k) {
    for (std::uint32_t a = first_[k]; a < first_[k + 1]; ++a)
      for (std::uint32_t b = a; b < first_[k + 1]; ++b)
        updates_.push_back({a, b, a == b ? 0 : block_at(places_[b].row, places_[a].row)});
    first_update_.push_back(static_cast<std::uint32_t>(updates_.size()));
  }
}

void JointSystem::factor(std::span<const Vector> mobility, double softness) {
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    for (const auto& [body, rates, spread] : {std::tuple{ends_[i].parent, &rates_[i].parent, &spreads_[i].parent},
                                              std::tuple{ends_[i].child, &rates_[i].child, &spreads_[i].child}})
      if (body >= 0) *spread = mobility[static_cast<std::size_t>(body)].asDiagonal() * rates->transpose();
    diagonal_[i].setZero();
  }
  for (Block& block : below_) block.setZero();
  for (const Coupling& one : couplings_) {
    const Block& rates = one.of_child_second ? rates_[one.second].child : rates_[one.second].parent;
    const Block& spread = one.of_child_first ? spreads_[one.first].child : spreads_[one.first].parent;
    (one.first == one.second ? diagonal_[one.first] : below_[one.block]).noalias() += rates * spread;
  }
  for (Block& block : diagonal_)
    for (int i = 0; i < 3; ++i) block(i, i) = block(i, i) > 0 ? block(i, i) * (1 + softness) : 1;
  eliminate();
}

void JointSystem::eliminate() {
  for (std::size_t k = 0; k < ends_.size(); ++k) {
    inverse_[k] = diagonal_[k].inverse();
    for (std::uint32_t b = first_[k]; b < first_[k + 1]; ++b) factors_[b].noalias() = below_[b] * inverse_[k];
    for (std::uint32_t u = first_update_[k]; u < first_update_[k + 1]; ++u) {
      const Update& one = updates_[u];
      Block& changed = one.upper == one.lower ? diagonal_[places_[one.upper].row] : below_[one.block];
      changed.noalias() -= factors_[one.lower] * below_[one.upper].transpose();
    }
  }
}

void JointSystem::solve(std::span<Vector> x) const {
  for (std::size_t b = 0; b < places_.size(); ++b) x[places_[b].row].noalias() -= factors_[b] * x[places_[b].column];
  for (std::size_t k = 0; k < ends_.size(); ++k) x[k] = (inverse_[k] * x[k]).eval();
  for (std::size_t b = places_.size(); b-- > 0;)
    x[places_[b].column].noalias() -= factors_[b].transpose() * x[places_[b].row];
}

JointSystem::Vector JointSystem::rate_of(std::size_t joint, std::span<const Vector> velocities) const {
  const Ends& ends = ends_[joint];
  Vector rate = Vector::Zero();
  if (ends.parent >= 0) rate.noalias() += rates_[joint].parent * velocities[static_cast<std::size_t>(ends.parent)];
  if (ends.child >= 0) rate.noalias() += rates_[joint].child * velocities[static_cast<std::size_t>(ends.child)];
  return rate;
}

void JointSystem::spread(std::span<const Vector> impulses, std::span<Vector> velocities) const {
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const Ends& ends = ends_[i];
    if (ends.parent >= 0)
      velocities[static_cast<std::size_t>(ends.parent)].noalias() += spreads_[i].parent * impulses[i];
    if (ends.child >= 0) velocities[static_cast<std::size_t>(ends.child)].noalias() += spreads_[i].child * impulses[i];
  }
}

}  // namespace breve

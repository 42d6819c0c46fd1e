// The arrays behind Bodies. What every body has is a column; what few have (a rotation, rigid motion, a material, an
// appearance) is a row of its own that the body points to, so that a world of points pays for points.
#pragma once

#include <array>
#include <memory_resource>
#include <utility>
#include <vector>

#include "runtime/kinematics/bodies.hpp"

namespace breve {

using RowIndex = std::uint32_t;
inline constexpr RowIndex kNoRow = 0xffffffffU;

/// Rows that are made on demand and reused; references stay valid while others are made. They lie in chunks of a power
/// of two, so that finding one takes a shift and a mask; those of bodies made one after the other are neighbours.
template <class Row>
class Rows {
 public:
  explicit Rows(std::pmr::memory_resource* memory) : chunks_(memory), free_(memory) {}
  RowIndex make() {
    if (free_.empty()) {
      // Room for all to be dropped, so that drop() never allocates.
      if (free_.capacity() <= size_) free_.reserve(2 * size_ + 16);
      if (size_ == chunks_.size() * kChunk) add_chunk();
      chunks_.back().emplace_back();
      return static_cast<RowIndex>(size_++);
    }
    const RowIndex row = free_.back();
    free_.pop_back();
    (*this)[row] = Row();
    return row;
  }
  void drop(RowIndex& row) {
    if (row != kNoRow) free_.push_back(row);
    row = kNoRow;
  }
  Row& operator[](RowIndex row) { return chunks_[row / kChunk][row % kChunk]; }
  const Row& operator[](RowIndex row) const { return chunks_[row / kChunk][row % kChunk]; }
  std::size_t bytes() const { return size_ * sizeof(Row); }

 private:
  static constexpr std::size_t kChunk = 32;
  void add_chunk() {
    std::pmr::vector<Row> chunk(chunks_.get_allocator().resource());
    chunk.reserve(kChunk);  // and it never grows
    chunks_.push_back(std::move(chunk));
  }

  std::pmr::vector<std::pmr::vector<Row>> chunks_;
  std::pmr::vector<RowIndex> free_;
  std::size_t size_ = 0;
};

/// A set of bodies to loop over: dense, with constant-time insertion and removal.
class ActiveSet {
 public:
  explicit ActiveSet(std::pmr::memory_resource* memory) : members_(memory), slot_(memory) {}
  void set(BodyIndex body, bool active) {
    if (body >= slot_.size()) {
      if (!active) return;
      slot_.resize(body + 1, kNoBody);
    }
    const bool member = slot_[body] != kNoBody;
    if (member == active) return;
    if (active) {
      members_.push_back(body);  // first: it may throw
      slot_[body] = static_cast<BodyIndex>(members_.size() - 1);
      return;
    }
    members_[slot_[body]] = members_.back();
    slot_[members_.back()] = slot_[body];
    members_.pop_back();
    slot_[body] = kNoBody;
  }
  bool has(BodyIndex body) const { return body < slot_.size() && slot_[body] != kNoBody; }
  const std::pmr::vector<BodyIndex>& members() const { return members_; }
  std::size_t bytes() const { return (members_.capacity() + slot_.capacity()) * sizeof(BodyIndex); }

 private:
  std::pmr::vector<BodyIndex> members_;
  std::pmr::vector<BodyIndex> slot_;  // by body; kNoBody: not a member
};

/// Data of a body that was ever rotated or given an angular velocity.
struct RotationRow {
  Quaternion orientation = Quaternion::Identity();
  Vector3 velocity = Vector3::Zero();  // rad/s: own frame if kinematic, world frame if physical
  Vector3 acceleration = Vector3::Zero();
};

/// Data of a body that was ever physics-enabled or pushed.
struct RigidRow {
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();  // N, N*m; world frame
  Vector3 kinematic_velocity = Vector3::Zero();               // what applies again when physics is disabled
  Vector3 kinematic_rotational_velocity = Vector3::Zero();
  MassProperties solid;        // copied from the shape
  std::uint32_t switches = 0;  // of `physics`, since the row was made
  bool physics = false;
  bool touched = false;  // in the list of those that setters changed
};

struct Bodies::Arrays : InMemory {
  explicit Arrays(std::pmr::memory_resource* memory);

  // Columns, by body.
  std::pmr::vector<ObjectId> owner;  // null: the index is free
  std::pmr::vector<BodyKind> kind;
  std::pmr::vector<Vector3> location, velocity, acceleration;
  std::pmr::vector<RowIndex> rotation_row, rigid_row, material_row, appearance_row, filter_row;
  std::pmr::vector<std::shared_ptr<Shape>> collision_shape, display_shape;
  std::pmr::vector<double> neighborhood;
  std::pmr::vector<std::uint8_t> driven;  // was given a velocity while it had no physics

  Rows<RotationRow> rotation_rows;
  Rows<RigidRow> rigid_rows;
  Rows<Material> materials;
  Rows<Appearance> appearances;
  Rows<CollisionFilter> filters;
  std::pmr::vector<BodyIndex> picky;  // sorted

  ActiveSet translating, rotating, rigid;
  std::pmr::vector<BodyIndex> free;  // last removed, first reused
  std::shared_ptr<Shape> default_shape;
  std::size_t used = 0;
  std::uint64_t revision = 0, physics_revision = 0;
  std::pmr::vector<BodyIndex>* log = nullptr;
  std::array<std::pmr::vector<BodyIndex>, kFollowers> put;  // room for all bodies: a body is in each at most once
  std::pmr::vector<std::uint8_t> in_put;                    // by body: bit i for put[i]
  bool queried = false;                                     // Queries follows
  std::pmr::vector<BodyIndex> touched;                      // may name bodies that are gone
  const Shape::ChangeCount shape_changes;                   // never null

  BodyIndex grow();
  bool physics(BodyIndex body) const { return rigid_row[body] != kNoRow && rigid_rows[rigid_row[body]].physics; }
  RotationRow& rotation(BodyIndex body) {
    if (rotation_row[body] == kNoRow) rotation_row[body] = rotation_rows.make();
    return rotation_rows[rotation_row[body]];
  }
  RigidRow& make_rigid(BodyIndex body) {
    if (rigid_row[body] == kNoRow) rigid_row[body] = rigid_rows.make();
    return rigid_rows[rigid_row[body]];
  }
  /// Which stages move this body follows from its state.
  void classify(BodyIndex body);
  void copy_mass(BodyIndex body);
  bool touched_now(BodyIndex body) const {
    return owner[body] && rigid_row[body] != kNoRow && rigid_rows[rigid_row[body]].touched;
  }
  void note(BodyIndex body) {
    if (log) log->push_back(body);
    if (rigid_row[body] == kNoRow || rigid_rows[rigid_row[body]].touched) return;
    touched.push_back(body);
    rigid_rows[rigid_row[body]].touched = true;
  }
  void note_driven(BodyIndex body, const Vector3& value) {
    if (driven[body] != 0 || kind[body] == BodyKind::Stationary || physics(body) || value == Vector3::Zero()) return;
    driven[body] = 1;
    ++revision;
    if (!rigid.members().empty()) ++physics_revision;  // it pushes some of them from now on
  }
  void note_put(BodyIndex body) {
    for (std::size_t i = 0; i < kFollowers; ++i) {
      if (i == static_cast<std::size_t>(Follower::Queries) && !queried) continue;
      if ((in_put[body] >> i & 1U) != 0) continue;
      in_put[body] = static_cast<std::uint8_t>(in_put[body] | 1U << i);
      put[i].push_back(body);  // never allocates: see grow()
    }
  }
  void translate_one(BodyIndex body, double h) {
    location[body] += h * velocity[body];
    velocity[body] += h * acceleration[body];
  }
  void rotate_one(BodyIndex body, double h);
  void move_rigid_one(BodyIndex body, double h, const Vector3& gravity);
};

}  // namespace breve

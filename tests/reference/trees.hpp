// The systems of the mb_ files as worlds: bodies stand at their centres of mass, joints are made through breve.h.
#pragma once

#include <map>

#include "table.hpp"
#include "world.hpp"

namespace breve::reference {

/// A system of revolute, prismatic and fixed joints and free bodies. Universal and ball joints of the files have axes
/// that breve.h does not offer; the tests of the runtime's own interface have those.
class Tree {
 public:
  static bool can_be_built(const std::string& name);
  /// @param with_tau  the forces of mb_state act on the joints
  Tree(const std::string& name, double step, breve_rung rung, bool with_tau);

  World world;
  std::vector<breve_object> bodies, joints;  // joints: null for a free body

  /// Largest difference of q and u of the joints from a row of mb_state's or mb_trajectory's form, and of the place,
  /// attitude and velocities of a free base.
  double error(const Row& row) const;

 private:
  void add(const Row& row, bool with_tau, const Row& state);
  void start(const Row& row, std::size_t i);

  std::vector<Vector3> centres_;    // of mass, in the file's body frames
  std::vector<Vector3> positions_;  // of joints
  std::vector<Quaternion> orientations_;
  std::map<int, Row> springs_;
};

inline Vector3 vector(const Row& row, const std::string& stem) {
  return Vector3(row.number(stem + "x"), row.number(stem + "y"), row.number(stem + "z"));
}

inline std::vector<Row> rows_of(const std::string& file, const std::string& name) {
  std::vector<Row> out;
  for (const Row& row : read(file))
    if (row.text("case") == name) out.push_back(row);
  return out;
}

}  // namespace breve::reference

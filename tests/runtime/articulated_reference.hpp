// Reads the reference files of tests/data/reference and builds models and states from them.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/articulated/loads.hpp"
#include "tests/reference/table.hpp"

namespace breve::articulated::reference {

/// One line of a CSV file, by the names of its columns.
class Row : public breve::reference::Row {
 public:
  using breve::reference::Row::Row;
  Vector3 vector(const std::string& x, const std::string& y, const std::string& z) const {
    return {number(x), number(y), number(z)};
  }
  Vector3 vector(const std::string& stem) const { return vector(stem + "x", stem + "y", stem + "z"); }
};

inline std::vector<Row> read(const std::string& name) { return breve::reference::read<Row>(name); }

inline std::vector<Row> rows_of(const std::vector<Row>& rows, const std::string& name) {
  std::vector<Row> out;
  for (const Row& row : rows)
    if (row.text("case") == name) out.push_back(row);
  return out;
}

inline JointType type_of(const std::string& letter) {
  switch (letter.at(0)) {
    case 'R': return JointType::Revolute;
    case 'P': return JointType::Prismatic;
    case 'U': return JointType::Universal;
    case 'B': return JointType::Ball;
    case 'F': return JointType::Free;
    case 'X': return JointType::Fixed;
    default: throw std::runtime_error("joint type " + letter);
  }
}

/// The numbers of columns stem0, stem1, ... that are not empty.
inline std::vector<double> numbers(const Row& row, const std::string& stem, int most) {
  std::vector<double> out;
  for (int k = 0; k < most; ++k) {
    const std::string column = stem + std::to_string(k);
    if (!row.empty(column)) out.push_back(row.number(column));
  }
  return out;
}

inline void append(Vector& to, const std::vector<double>& numbers) {
  const Eigen::Index old = to.size();
  to.conservativeResize(old + static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) to[old + static_cast<Eigen::Index>(i)] = numbers[i];
}

inline Link link_of(const Row& row) {
  Link link;
  link.name = row.text("body");
  link.parent = row.integer("parent");
  link.type = type_of(row.text("type"));
  link.position = row.vector("p");
  link.rotation = Quaternion(row.number("rw"), row.number("rx"), row.number("ry"), row.number("rz")).normalized();
  if (row.vector("a").norm() > 0) link.axis = row.vector("a").normalized();
  if (row.vector("a2").norm() > 0) link.axis2 = row.vector("a2").normalized();
  link.mass = row.number("mass");
  link.com = row.vector("c");
  const double xy = row.number("Ixy"), xz = row.number("Ixz"), yz = row.number("Iyz");
  link.inertia << row.number("Ixx"), xy, xz, xy, row.number("Iyy"), yz, xz, yz, row.number("Izz");
  return link;
}

/// A system of the mb_ files.
struct Case {
  std::vector<Link> links;
  State state;
  Loads loads;  // with tau as mb_state gives it and the springs of mb_springs
};

inline Case load(const std::string& name) {
  Case out;
  for (const Row& row : rows_of(read("mb_cases"), name)) out.loads.gravity = row.vector("g");
  for (const Row& row : rows_of(read("mb_models"), name)) out.links.push_back(link_of(row));
  for (const Row& row : rows_of(read("mb_state"), name)) {
    append(out.state.q, numbers(row, "q", 7));
    append(out.state.v, numbers(row, "u", 6));
    append(out.loads.tau, numbers(row, "tau", 6));
  }
  for (const Row& row : rows_of(read("mb_springs"), name)) {
    out.loads.drives.resize(out.links.size());
    Drive& drive = out.loads.drives.at(static_cast<std::size_t>(row.integer("body")));
    drive.stiffness = row.number("stiffness");
    drive.damping = row.number("damping");
    if (row.number("rest") != 0) throw std::runtime_error("a spring's rest other than 0 is not read");
  }
  if (out.links.empty()) throw std::runtime_error("no case " + name);
  return out;
}

inline std::vector<std::string> case_names(const std::string& file) {
  std::vector<std::string> names;
  for (const Row& row : read(file))
    if (names.empty() || names.back() != row.text("case")) names.push_back(row.text("case"));
  return names;
}

}  // namespace breve::articulated::reference

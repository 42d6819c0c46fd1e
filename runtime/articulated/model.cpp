// Checks a description link by link and works out what the algorithms need.
#include "runtime/articulated/model.hpp"

#include <fmt/format.h>

#include <cmath>

#include "runtime/base/error.hpp"

namespace breve::articulated {

namespace {

constexpr double kUnitTolerance = 1e-6;  // a script's literals have about seven digits

std::string called(const std::string& name, int index) {
  return name.empty() ? fmt::format("link {}", index) : fmt::format("link '{}'", name);
}

/// Collects what is needed for a message about one link.
class Check {
 public:
  Check(const Link& link, int index) : link_(link), index_(index) {}

  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ErrorCode::Argument, called(link_.name, index_) + ": " + what);
  }
  void need(bool holds, const std::string& what) const {
    if (!holds) refuse(what);
  }
  template <class V>
  void finite(const V& value, const char* property) const {
    need(value.array().isFinite().all(), fmt::format("{} is not finite", property));
  }
  void unit(const Vector3& axis, const char* property) const {
    finite(axis, property);
    need(std::abs(axis.norm() - 1) <= kUnitTolerance,
         fmt::format("{} has length {} (must be 1)", property, axis.norm()));
  }

 private:
  const Link& link_;
  int index_;
};

void check_joint(const Link& link, int index, const Check& check) {
  check.need(link.parent >= -1 && link.parent < index,
             fmt::format("parent is {} (must be -1, the world, or a link before this one)", link.parent));
  const int type = static_cast<int>(link.type);
  check.need(type >= 0 && type <= static_cast<int>(JointType::Fixed),
             fmt::format("joint type {} does not exist", type));
  check.finite(link.position, "joint position");
  check.finite(link.rotation.coeffs(), "joint rotation");
  check.need(std::abs(link.rotation.norm() - 1) <= kUnitTolerance,
             fmt::format("joint rotation has length {} (must be a unit quaternion)", link.rotation.norm()));
  const bool has_axis =
      link.type == JointType::Revolute || link.type == JointType::Prismatic || link.type == JointType::Universal;
  if (has_axis) check.unit(link.axis, "joint axis");
  if (link.type == JointType::Universal) {
    check.unit(link.axis2, "second joint axis");
    check.need(std::abs(link.axis.dot(link.axis2)) <= kUnitTolerance, "the two joint axes are not perpendicular");
  }
  check.need(link.type != JointType::Free || link.parent == -1, "a free joint must have the world as its parent");
}

void check_mass(const Link& link, const Check& check) {
  check.need(std::isfinite(link.mass), "mass is not finite");
  check.need(link.mass > 0, fmt::format("mass is {} (must be > 0)", link.mass));
  check.finite(link.com, "centre of mass");
  check.finite(link.inertia, "inertia");
  const double scale = link.inertia.diagonal().cwiseAbs().maxCoeff();
  check.need((link.inertia - link.inertia.transpose()).cwiseAbs().maxCoeff() <= kUnitTolerance * scale,
             "inertia is not symmetric");
  Symmetric3 inverse;
  check.need(invert(Symmetric3::upper(link.inertia), inverse),
             "inertia is not positive definite (all three principal moments must be > 0)");
}

/// Mass moments of order two about the frame's origin: I - m [c]x[c]x.
Symmetric3 about_origin(const Link& link) {
  const Matrix3 arm = cross_matrix(link.com);
  return Symmetric3::upper(Matrix3(link.inertia - link.mass * arm * arm));
}

}  // namespace

Model::Model(const std::vector<Link>& links) {
  if (links.empty()) throw Error(ErrorCode::Argument, "an articulated body needs at least one link");
  bodies_.reserve(links.size());
  names_.reserve(links.size());
  for (const Link& link : links) add(link);
}

void Model::add(const Link& link) {
  const Check check(link, size());
  check_joint(link, size(), check);
  check_mass(link, check);

  Body body{};
  body.type = link.type;
  body.parent = link.parent;
  body.q = nq_;
  body.v = nv_;
  body.wide = velocity_count(link.type) > 1 ? wide_++ : -1;
  body.mass = link.mass;
  body.position = link.position;
  body.axis = link.axis.normalized();
  body.axis2 = link.axis2.normalized();
  body.rotation = link.rotation.normalized().toRotationMatrix();
  if (link.type == JointType::Revolute || link.type == JointType::Universal) {
    const Matrix3 frame = body.rotation;
    body.rotation = frame * body.axis * body.axis.transpose();
    body.rotation_sin = frame * cross_matrix(body.axis);
    body.rotation_cos = frame - body.rotation;
  } else {
    body.rotation_sin.setZero();
    body.rotation_cos.setZero();
  }
  body.com = link.com;
  body.moment = link.mass * link.com;
  body.inertia = about_origin(link);
  body.inertia_com = Symmetric3::upper(link.inertia);
  check.need(std::isfinite(body.inertia.trace()), "mass times the square of the distance to its centre would overflow");

  nq_ += position_count(link.type);
  nv_ += velocity_count(link.type);
  mass_ += link.mass;
  bodies_.push_back(body);
  names_.push_back(link.name);
}

std::string Model::name(int link) const { return called(names_[static_cast<std::size_t>(link)], link); }

}  // namespace breve::articulated

// Joint, Spring and MultiBody objects: linking and breaking, which MultiBody a body belongs to, what archives need.
#include "steve/library/motors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace breve::steve {

namespace {

struct Kind {
  std::string_view cls;
  JointKind kind;
  bool may_be_linked_again;  // without breaking it first
};
constexpr std::array<Kind, 5> kKinds{{{"RevoluteJoint", JointKind::Revolute, false},
                                      {"PrismaticJoint", JointKind::Prismatic, true},
                                      {"FixedJoint", JointKind::Fixed, true},
                                      {"UniversalJoint", JointKind::Universal, false},
                                      {"BallJoint", JointKind::Ball, false}}};

const Kind& row_of(const Instance& joint) {
  for (const Kind& row : kKinds)
    if (is_library_kind(joint, row.cls)) return row;
  throw Error(ErrorCode::Argument, name_of(joint) +
                                       " cannot be linked: it is not a RevoluteJoint, PrismaticJoint, FixedJoint, "
                                       "UniversalJoint or BallJoint");
}

/// Stops that a joint has from the start: -2 to 2 of a prismatic joint, the middle axis of a ball away from where its
/// angles stop to be angles.
void set_first_limits(Mechanics& dynamics, JointIndex joint, JointKind kind) {
  JointDrive drive = dynamics.drive(joint);
  if (kind == JointKind::Prismatic) {
    drive.low[0] = -kSliderStop;
    drive.high[0] = kSliderStop;
  } else if (kind == JointKind::Ball) {
    drive.low[1] = -kBallMiddle;
    drive.high[1] = kBallMiddle;
  } else {
    return;
  }
  dynamics.set_drive(joint, drive);
}

/// The body at the end of a joint; the world for none.
BodyIndex end_of(Machine& machine, Instance* end, std::string_view what) {
  return end ? body_of(machine, must_live(end, what)) : kNoBody;
}

}  // namespace

void charge_for_break(Machine& machine, JointIndex joint) {
  constexpr std::size_t kOfLink = 64;  // iterations
  const Mechanics& dynamics = machine.world().mechanics();
  machine.charge(kOfLink * dynamics.links_of(dynamics.joint(joint).child).size());
}

bool is_library_kind(const Instance& object, std::string_view library_class) {
  for (const ClassInfo* cls = object.cls; cls; cls = cls->parent)
    if (cls->name == library_class) return true;
  return false;
}

// --- joints ---------------------------------------------------------------------------------------------------------

JointKind joint_kind(const Instance& joint) { return row_of(joint).kind; }

JointIndex joint_of(Machine& machine, const Instance& joint) {
  const JointResource* resource = resource_of<JointResource>(machine, &joint);
  if (!resource || resource->index == kNoJoint) return kNoJoint;
  const Mechanics& dynamics = machine.world().mechanics();
  const bool ours = dynamics.linked(resource->index) && dynamics.joint_owner(resource->index) == joint.id;
  return ours ? resource->index : kNoJoint;
}

void link_joint(Machine& machine, Instance& joint, JointDescription description, Instance* parent, Instance* child) {
  machine.refuse_in_stage("link a joint");
  const Kind& row = row_of(joint);
  if (const JointIndex index = joint_of(machine, joint); index != kNoJoint) {
    if (!row.may_be_linked_again)
      throw Error(ErrorCode::Argument, "link: " + name_of(joint) + " is already linked (call break-joint first)");
    charge_for_break(machine, index);
    break_joint(machine, joint);
  }
  must_live(child, "link: the child");
  description.kind = row.kind;
  description.child = end_of(machine, child, "link: the child");
  description.parent = end_of(machine, parent, "link: the parent");
  JointResource& resource = resource_made<JointResource>(machine, joint);
  Mechanics& dynamics = machine.world().mechanics();
  // The whole assembly is looked through.
  if (description.parent != kNoBody) machine.charge(dynamics.links_of(description.parent).size());
  resource.index = dynamics.link(description, joint.id);
  resource.is = dynamics.joint(resource.index);
  set_first_limits(dynamics, resource.index, row.kind);
  set_library_object(machine, joint, "Joint", "parentObject", parent);
  set_library_object(machine, joint, "Joint", "childObject", child);
}

void break_joint(Machine& machine, Instance& joint) {
  machine.refuse_in_stage("break a joint");
  const JointIndex index = joint_of(machine, joint);
  if (index != kNoJoint) machine.world().mechanics().unlink(index);
  if (JointResource* resource = resource_of<JointResource>(machine, &joint)) resource->index = kNoJoint;
  set_library_object(machine, joint, "Joint", "parentObject", nullptr);
  set_library_object(machine, joint, "Joint", "childObject", nullptr);
}

void prepare_joint(Machine& machine, Instance& joint) {
  JointResource& resource = resource_made<JointResource>(machine, joint);
  const JointIndex index = joint_of(machine, joint);
  resource.was_linked = index != kNoJoint;
  if (!resource.was_linked) return;
  const Mechanics& dynamics = machine.world().mechanics();
  resource.is = dynamics.joint(index);
  resource.drive = dynamics.drive(index);
  resource.position = dynamics.position(index);
  resource.velocity = dynamics.velocity(index);
}

void relink_joint(Machine& machine, Instance& joint) {
  JointResource* resource = resource_of<JointResource>(machine, &joint);
  if (!resource || !resource->was_linked || joint_of(machine, joint) != kNoJoint) return;
  resource->was_linked = false;
  resource->index = kNoJoint;
  const JointResource saved = *resource;
  JointDescription description = saved.is;
  description.keep_rotation = true;  // the bodies stand where they are to stand
  Instance* child = library_object(machine, joint, "Joint", "childObject");
  if (!child) return;  // it was not archived
  link_joint(machine, joint, description, library_object(machine, joint, "Joint", "parentObject"), child);
  Mechanics& dynamics = machine.world().mechanics();
  const JointIndex index = joint_of(machine, joint);
  dynamics.set_drive(index, saved.drive);
  if (dynamics.closes_loop(index)) {
    // A loop that is open stays open: its joint rests where it did, not where its child stands.
    if (dynamics.joint(index).relative_rotation.coeffs() != saved.is.relative_rotation.coeffs()) {
      description = dynamics.joint(index);
      description.relative_rotation = saved.is.relative_rotation;
      description.keep_rotation = false;
      dynamics.relink(index, description);
      resource_made<JointResource>(machine, joint).is = dynamics.joint(index);
    }
    return;
  }
  // Bodies do not know how many revolutions a joint has made.
  dynamics.set_position(index, saved.position);
  dynamics.set_velocity(index, saved.velocity);
}

void drive_joint(Machine& machine, Instance& joint, JointIndex index, const JointDrive& drive) {
  Mechanics& dynamics = machine.world().mechanics();
  dynamics.set_drive(index, drive);
  if (!(drive.strength_limit > 0)) return;
  if (Slot* had = library_slot(machine, joint, "Joint", "hadStrength")) had->i = 1;
  const double most = dynamics.strength_hard_limit(index);
  if (drive.strength_limit <= most) return;
  machine.warn_once("joint:strength-cut", [&] {
    return fmt::format(
        "the strength limit {:g} of {} is clamped to {:g}, 500 times the mass of its child, {:g} kg "
        "(a body weighs 1 kg per cubic length unit unless its shape has another mass)",
        drive.strength_limit, name_of(joint), most, most / 500);
  });
}

void check_motors(Machine& machine) {
  const Mechanics& dynamics = machine.world().mechanics();
  const Bodies& bodies = machine.world().bodies();
  constexpr double kLight = 1e-3;  // kg per N*m or N
  std::size_t left = dynamics.joint_count();
  for (JointIndex i = 0; left > 0; ++i) {
    if (!dynamics.linked(i)) continue;
    --left;
    const JointDrive& drive = dynamics.drive(i);
    if (drive.strength_limit == 0 && drive.motor_speed == JointVector::Zero()) continue;
    Instance* joint = machine.instance(dynamics.joint_owner(i));
    if (!joint) continue;
    if (drive.strength_limit == 0) {
      const Slot* had = library_slot(machine, *joint, "Joint", "hadStrength");
      if (had && had->i == 0)
        machine.warn_once("joint:no-strength", [&] {
          return "the motor of " + name_of(*joint) +
                 " has a target speed, but no strength: it does not move (set one with set-strength-limit)";
        });
      continue;
    }
    for (const BodyIndex body : {dynamics.joint(i).child, dynamics.joint(i).parent}) {
      if (body == kNoBody || !bodies.dynamic(body) || !(bodies.mass(body) < kLight * drive.strength_limit)) continue;
      machine.warn_once("joint:light-body", [&] {
        return fmt::format(
            "a motor of strength {:g} drives a body of {:g} kg, less than a gram per unit of strength "
            "(a body weighs 1 kg per cubic length unit unless its shape has another mass: set-mass, set-density)",
            drive.strength_limit, bodies.mass(body));
      });
    }
  }
}

// --- springs --------------------------------------------------------------------------------------------------------

SpringIndex spring_of(Machine& machine, Instance& spring) {
  const SpringResource* resource = resource_of<SpringResource>(machine, &spring);
  if (!resource || resource->index == kNoSpring) return kNoSpring;
  const Mechanics& dynamics = machine.world().mechanics();
  if (!dynamics.has_spring(resource->index)) return kNoSpring;
  // A body that went took its springs along, and the number may be another's now.
  const SpringDescription& is = dynamics.spring(resource->index);
  const auto still = [&](std::string_view end, BodyIndex body) {
    const Instance* object = library_object(machine, spring, "Spring", end);
    return object && machine.world().has_body(object->id) && machine.world().body(object->id) == body;
  };
  return still("fromObject", is.a) && still("toObject", is.b) ? resource->index : kNoSpring;
}

void connect_spring(Machine& machine, Instance& spring, SpringDescription description, Instance* from, Instance* to) {
  description.a = body_of(machine, must_live(from, "connect: the object it comes from"));
  description.b = body_of(machine, must_live(to, "connect: the object it goes to"));
  if (description.a == description.b) return;
  machine.refuse_in_stage("connect a spring");
  Mechanics& dynamics = machine.world().mechanics();
  const SpringIndex before = spring_of(machine, spring);
  SpringResource& resource = resource_made<SpringResource>(machine, spring);
  resource.index = dynamics.add_spring(description, spring.id);
  if (before != kNoSpring) dynamics.remove_spring(before);
  resource.is = description;
  set_library_object(machine, spring, "Spring", "fromObject", from);
  set_library_object(machine, spring, "Spring", "toObject", to);
}

void change_spring(Machine& machine, Instance& spring, const SpringDescription& description) {
  const SpringIndex index = spring_of(machine, spring);
  if (index != kNoSpring) {
    SpringDescription changed = description;
    changed.a = machine.world().mechanics().spring(index).a;
    changed.b = machine.world().mechanics().spring(index).b;
    machine.world().mechanics().set_spring(index, changed);
  }
  resource_made<SpringResource>(machine, spring).is = description;
}

void relink_spring(Machine& machine, Instance& spring) {
  SpringResource* resource = resource_of<SpringResource>(machine, &spring);
  if (!resource || spring_of(machine, spring) != kNoSpring) return;
  resource->index = kNoSpring;
  Instance* from = library_object(machine, spring, "Spring", "fromObject");
  Instance* to = library_object(machine, spring, "Spring", "toObject");
  if (from && to) connect_spring(machine, spring, resource->is, from, to);
}

// --- assemblies -----------------------------------------------------------------------------------------------------

Instance* root_of(Machine& machine, Instance& multibody) {
  Instance* root = library_object(machine, multibody, "MultiBody", "rootLink");
  return root && machine.world().has_body(root->id) ? root : nullptr;
}

Instance* multibody_of(Machine& machine, BodyIndex body) {
  World& world = machine.world();
  Instance* oldest = nullptr;
  for (const BodyIndex link : world.mechanics().links_of(body)) {
    Instance* object = machine.instance(world.bodies().owner(link));
    Instance* owner = object ? library_object(machine, *object, "Mobile", "rootOf") : nullptr;
    if (!owner || root_of(machine, *owner) != object) continue;
    if (!oldest || owner->serial < oldest->serial) oldest = owner;
  }
  return oldest;
}

void set_root(Machine& machine, Instance& multibody, Instance* root) {
  const BodyIndex body = body_of(machine, must_live(root, "set-root: the link"));
  if (machine.world().bodies().kind(body) == BodyKind::Stationary)
    throw Error(ErrorCode::Argument, "set-root: " + name_of(*root) + " cannot move: the root is a Link or a Mobile");
  if (Instance* before = root_of(machine, multibody)) set_library_object(machine, *before, "Mobile", "rootOf", nullptr);
  set_library_object(machine, multibody, "MultiBody", "rootLink", root);
  set_library_object(machine, *root, "Mobile", "rootOf", &multibody);
}

namespace {

/// The root's body if the MultiBody is the one that its links belong to, else kNoBody.
BodyIndex own_root(Machine& machine, Instance& multibody) {
  Instance* root = root_of(machine, multibody);
  if (!root) return kNoBody;
  const BodyIndex body = body_of(machine, *root);
  return multibody_of(machine, body) == &multibody ? body : kNoBody;
}

constexpr std::size_t kOfPart = 4;  // iterations, to find the object of a link or joint

/// @param of_link  iterations
std::pmr::vector<BodyIndex> charged_links(Machine& machine, BodyIndex body, std::size_t of_link) {
  const Mechanics& dynamics = machine.world().mechanics();
  auto links = dynamics.links_of(body);
  if (links.size() > 1) {
    machine.charge(of_link * links.size());
  } else {
    // Its joints may all lead to bodies that do not move, which were looked at.
    constexpr std::size_t kJointsPerIteration = 4;
    machine.charge(dynamics.joints_of(body).size() / kJointsPerIteration);
  }
  return links;
}

}  // namespace

std::vector<Instance*> links_of(Machine& machine, Instance& multibody) {
  std::vector<Instance*> links;
  const BodyIndex root = own_root(machine, multibody);
  if (root == kNoBody) return links;
  const auto bodies = charged_links(machine, root, kOfPart);
  for (const BodyIndex body : bodies)
    if (Instance* link = machine.instance(machine.world().bodies().owner(body))) links.push_back(link);
  std::sort(links.begin(), links.end(), [](const Instance* a, const Instance* b) { return a->serial < b->serial; });
  return links;
}

std::vector<Instance*> joints_of(Machine& machine, Instance& multibody) {
  std::vector<Instance*> joints;
  const BodyIndex root = own_root(machine, multibody);
  if (root == kNoBody) return joints;
  const Mechanics& dynamics = machine.world().mechanics();
  const auto indices = dynamics.joints_of(root);
  machine.charge(kOfPart * indices.size());
  for (const JointIndex joint : indices)
    if (Instance* owner = machine.instance(dynamics.joint_owner(joint))) joints.push_back(owner);
  std::sort(joints.begin(), joints.end(), [](const Instance* a, const Instance* b) { return a->serial < b->serial; });
  return joints;
}

void charge_for_assembly(Machine& machine, BodyIndex body) {
  constexpr std::size_t kOfLink = 8;  // units of work
  if (machine.world().mechanics().joint_count() != 0) charged_links(machine, body, kOfLink);
}

void follow_moved(Machine& machine, BodyIndex body) {
  charge_for_assembly(machine, body);
  machine.world().mechanics().moved(body);
}

void charge_for_bounds(Machine& machine, BodyIndex body) {
  constexpr std::size_t kCornersPerIteration = 64;
  machine.charge(machine.world().bodies().collision_shape(body)->polyhedron().vertices.size() / kCornersPerIteration);
}

std::pmr::vector<ObjectId> counted_touching(Machine& machine, ObjectId id) {
  charge_for_bounds(machine, machine.world().body(id));
  return machine.world().touching(id);
}

void add_parts(Machine& machine, Instance& object, std::vector<Instance*>& parts) {
  for (const auto& [cls, variable] : {std::pair<std::string_view, std::string_view>{"Joint", "parentObject"},
                                      {"Joint", "childObject"},
                                      {"Spring", "fromObject"},
                                      {"Spring", "toObject"}})
    if (Instance* part = library_object(machine, object, cls, variable)) parts.push_back(part);
  if (!is_library_kind(object, "MultiBody")) return;
  for (Instance* link : links_of(machine, object)) parts.push_back(link);
  for (Instance* joint : joints_of(machine, object)) parts.push_back(joint);
}

}  // namespace breve::steve

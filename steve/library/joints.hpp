// Joint, Spring and MultiBody objects and what stands behind them in the world's dynamics. Shared by the native
// methods, the archives and the C interface.
#pragma once

#include <memory>
#include <numbers>
#include <string_view>
#include <vector>

#include "runtime/mechanics/mechanics.hpp"
#include "runtime/world/resource.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

/// The native data of a Joint object. Mechanics has the truth while the joint is linked; what stands here is for
/// linking it, and for archives.
class JointResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "joint";
  JointIndex index = kNoJoint;  // ours only while dynamics says that this object owns it
  JointDescription is;          // its bodies are not read
  bool scales = false;          // link points follow the scale of the shapes
  // As it was when the object was archived.
  bool was_linked = false;
  JointDrive drive;
  JointVector position = JointVector::Zero(), velocity = JointVector::Zero();

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

/// The native data of a Spring object, in the same way.
class SpringResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "spring";
  SpringIndex index = kNoSpring;
  SpringDescription is;  // its bodies are not read

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

// --- joints ---------------------------------------------------------------------------------------------------------

inline constexpr double kSliderStop = 2;                            // length units, of a PrismaticJoint at first
inline constexpr double kBallMiddle = std::numbers::pi / 2 - 0.35;  // rad, always, of a BallJoint's middle axis

/// Is the class of this object the library's class of that name, or derived from it?
bool is_library_kind(const Instance& object, std::string_view library_class);
/// Error{Argument} if the object is not a RevoluteJoint, PrismaticJoint, FixedJoint, UniversalJoint or BallJoint.
JointKind joint_kind(const Instance& joint);
/// What dynamics has for a Joint object; kNoJoint if it is not linked.
JointIndex joint_of(Machine& machine, const Instance& joint);
/// Link a Joint object.
/// @param description  its kind and bodies are not read
/// @param parent       null: the world
/// @throws Error{Argument} naming what is wrong, also if a joint is linked that may not be linked twice; RunError for a
///         parent or child that is freed, and for no child
void link_joint(Machine& machine, Instance& joint, JointDescription description, Instance* parent, Instance* child);
void break_joint(Machine& machine, Instance& joint);
/// The work of a break by a script: what asks for the assembly next builds it anew. RunError{Budget} if it is used up.
void charge_for_break(Machine& machine, JointIndex joint);
/// Before and after an archive. The second links the joint again where the bodies stand.
void prepare_joint(Machine& machine, Instance& joint);
void relink_joint(Machine& machine, Instance& joint);

// --- springs --------------------------------------------------------------------------------------------------------

/// kNoSpring if it is not connected.
SpringIndex spring_of(Machine& machine, Instance& spring);
/// The same body twice: nothing.
void connect_spring(Machine& machine, Instance& spring, SpringDescription description, Instance* from, Instance* to);
void change_spring(Machine& machine, Instance& spring, const SpringDescription& description);
void relink_spring(Machine& machine, Instance& spring);

// --- assemblies -----------------------------------------------------------------------------------------------------

/// The MultiBody that a body belongs to: of those whose root is connected with it the oldest; null if there is none.
Instance* multibody_of(Machine& machine, BodyIndex body);
/// Its root if that lives and has a body, else null.
Instance* root_of(Machine& machine, Instance& multibody);
/// Adopt a root. RunError if it is null or freed, Error{Argument} if it has no body.
void set_root(Machine& machine, Instance& multibody, Instance* root);
/// Links in the order of creation; none without a root, or if they belong to an older MultiBody.
std::vector<Instance*> links_of(Machine& machine, Instance& multibody);
/// Joint objects between them, in the order of creation.
std::vector<Instance*> joints_of(Machine& machine, Instance& multibody);
/// Counts what goes through the whole assembly of a body: poses or velocities of all links.
void charge_for_assembly(Machine& machine, BodyIndex body);
/// What joints hold to a body that was moved follows at once.
void follow_moved(Machine& machine, BodyIndex body);
/// Charges for the box about a body.
void charge_for_bounds(Machine& machine, BodyIndex body);
/// Objects whose shapes touch this one's, counted.
std::pmr::vector<ObjectId> counted_touching(Machine& machine, ObjectId id);
/// What an archive of an object needs besides: bodies of joints and springs, parts of a MultiBody.
void add_parts(Machine& machine, Instance& object, std::vector<Instance*>& parts);

}  // namespace breve::steve

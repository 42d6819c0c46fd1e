// Bodies in archives. The snapshot form of numbers, in hexadecimal, keeps every bit.
#include "steve/library/archive_body.hpp"

#include <array>
#include <cmath>

#include "steve/library/archive_values.hpp"
#include "steve/library/resources.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

namespace {

constexpr const char* kKinds[] = {"mobile", "stationary", "link"};

/// Every number and flag of a body's material and look that is not a reference.
template <class Material, class Look, class Visit>
void for_each_setting(Material& material, Look& look, Visit visit) {
  visit(material.restitution);
  visit(material.friction);
  visit(material.static_friction);
  visit(material.dynamic_friction);
  visit(material.normal_restitution);
  visit(material.tangential_restitution);
  visit(material.restitution_threshold);
  visit(look.alpha);
  visit(look.texture_scale_x);
  visit(look.texture_scale_y);
  visit(look.bitmap_heading);
  visit(look.visible);
  visit(look.shadows);
  visit(look.as_point);
  visit(look.bounding_box);
  visit(look.axis);
  visit(look.neighbor_lines);
}

[[noreturn]] void refuse_number() {
  throw Error(ErrorCode::File, "the archive is damaged: a number of a body is out of range");
}

/// Numbers that no program can give a body come from a damaged archive.
template <class... Vectors>
void need_finite(const Vectors&... vectors) {
  if (!(vectors.allFinite() && ...)) refuse_number();
}

/// The Shape object in that variable gives the body its geometry.
template <auto Set>
void use_shape(Machine& machine, Instance& object, std::string_view variable) {
  Instance* shape = library_object(machine, object, "Real", variable);
  if (const ShapeResource* geometry = resource_of<ShapeResource>(machine, shape); geometry && geometry->shape)
    (machine.world().bodies().*Set)(body_of(machine, object), geometry->shape);
}

}  // namespace

void write_body(Machine& machine, const Instance& object, pugi::xml_node element) {
  const Bodies& bodies = machine.world().bodies();
  const BodyIndex body = body_of(machine, object);
  const Appearance& look = bodies.appearance(body);
  ByteWriter out;
  out.put(bodies.location(body));
  out.put(bodies.orientation(body));
  for (const Vector3* v :
       {&bodies.velocity(body), &bodies.acceleration(body), &bodies.rotational_velocity(body),
        &bodies.rotational_acceleration(body), &bodies.force(body), &bodies.torque(body), &look.color})
    out.put(*v);
  out.put(bodies.neighborhood_size(body));
  out.put(bodies.physics(body));
  for_each_setting(bodies.material(body), look, [&](const auto& setting) { out.put(setting); });
  out.put(std::string_view(look.label));
  element.append_attribute("kind") = kKinds[static_cast<std::size_t>(bodies.kind(body))];
  const auto bytes = out.take();
  element.text() = to_hex({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, machine.poller()).c_str();
  for (const World::CollisionRule& rule : machine.world().collision_rules(object.cls->id)) {
    machine.poll();
    const std::string& other = machine.program().cls(rule.other).name;
    if (!rule.method.empty()) {
      pugi::xml_node handler = element.append_child("handler");
      handler.append_attribute("type") = other.c_str();
      handler.append_attribute("method") = std::string(rule.method).c_str();
    }
    if (rule.ignored) element.append_child("ignore").append_attribute("type") = other.c_str();
  }
}

std::vector<ArchivedRule> read_rules(Machine& machine, const ClassInfo& owner, pugi::xml_node element) {
  std::vector<ArchivedRule> rules;
  for (const pugi::xml_node rule : element.children()) {
    machine.poll();
    const std::string_view kind = rule.name();
    if (kind != "handler" && kind != "ignore") continue;
    const std::string other = rule.attribute("type").value(), method = rule.attribute("method").value();
    const ClassInfo* const cls = machine.program().find_class(other);
    if (!cls)
      throw Error(ErrorCode::File, "the archive holds a collision rule of " + owner.name + " for class '" + other +
                                       "', which this program does not have");
    if (kind == "handler" && !machine.responds(owner, method))
      throw Error(ErrorCode::File, "the archive holds a collision handler of " + owner.name + ", '" + method +
                                       "', which is not a method of that class in this program");
    rules.push_back({cls, kind == "handler" ? method : std::string()});
  }
  return rules;
}

void set_rules(Machine& machine, const Instance& owner, const std::vector<ArchivedRule>& rules) {
  for (const ArchivedRule& rule : rules) {
    if (rule.method.empty())
      machine.world().ignore_collisions(owner.cls->id, rule.other->id);
    else
      machine.world().handle_collisions(owner.cls->id, rule.other->id, rule.method, owner.id);
  }
}

void read_body(Machine& machine, Instance& object, pugi::xml_node element) {
  const std::string_view kind = element.attribute("kind").value();
  std::size_t number = 0;
  while (number < std::size(kKinds) && kKinds[number] != kind) ++number;
  if (number == std::size(kKinds)) throw Error(ErrorCode::File, "the archive is damaged: unknown kind of body");
  const std::string bytes = from_hex(element.text().get(), machine.poller());
  ByteReader in(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());

  machine.world().embody(object.id, static_cast<BodyKind>(number));
  Bodies& bodies = machine.world().bodies();
  const BodyIndex body = body_of(machine, object);
  use_shape<&Bodies::set_collision_shape>(machine, object, "collisionShape");
  use_shape<&Bodies::set_display_shape>(machine, object, "displayShape");
  Appearance& look = bodies.appearance(body);
  const Vector3 location = in.get_vector();
  const Quaternion orientation = in.get_quaternion();
  std::array<Vector3, 6> motion;
  for (Vector3& v : motion) v = in.get_vector();
  look.color = in.get_vector();
  const auto neighborhood = in.get<double>();
  need_finite(location, orientation.coeffs(), motion[0], motion[1], motion[2], motion[3], motion[4], motion[5],
              look.color);
  constexpr double kRoundOff = 1e-6;
  if (std::abs(orientation.norm() - 1) > kRoundOff || std::isnan(neighborhood)) refuse_number();
  bodies.set_location(body, location);
  bodies.set_orientation(body, orientation);
  bodies.set_neighborhood_size(body, neighborhood);
  // Before the motion: the frame of a rotational velocity depends on it.
  if (in.get_bool()) bodies.set_physics(body, true);
  bodies.set_velocity(body, motion[0]);
  bodies.set_acceleration(body, motion[1]);
  bodies.set_rotational_velocity(body, motion[2]);
  bodies.set_rotational_acceleration(body, motion[3]);
  bodies.set_force(body, motion[4]);
  bodies.set_torque(body, motion[5]);
  for_each_setting(bodies.material(body), look, [&](auto& setting) {
    if constexpr (std::is_same_v<std::remove_reference_t<decltype(setting)>, bool>)
      setting = in.get_bool();
    else {
      setting = in.get<double>();
      if (std::isnan(setting)) refuse_number();
    }
  });
  look.label = in.get_string();
  look.texture = machine.id_of(library_object(machine, object, "Real", "textureImage"));
  look.bitmap = machine.id_of(library_object(machine, object, "Real", "bitmapImage"));
  look.lightmap = machine.id_of(library_object(machine, object, "Real", "lightmapImage"));
}

}  // namespace breve::steve

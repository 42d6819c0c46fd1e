// Bodies in a snapshot and in the world hash. Which stages move a body, and which rows it has, follow from its values.
#include "runtime/base/error.hpp"
#include "runtime/kinematics/arrays.hpp"

namespace breve {

namespace {

void save(ByteWriter& out, const Material& m) {
  for (const double value : {m.restitution, m.friction, m.static_friction, m.dynamic_friction, m.normal_restitution,
                             m.tangential_restitution, m.restitution_threshold}) {
    out.put(value);
  }
}

void load(ByteReader& in, Material& m) {
  for (double* value : {&m.restitution, &m.friction, &m.static_friction, &m.dynamic_friction, &m.normal_restitution,
                        &m.tangential_restitution, &m.restitution_threshold}) {
    *value = in.get<double>();
  }
}

void save(ByteWriter& out, const Appearance& a) {
  out.put(a.color);
  out.put(a.alpha);
  out.put(a.texture);
  out.put(a.bitmap);
  out.put(a.lightmap);
  out.put(a.texture_scale_x);
  out.put(a.texture_scale_y);
  out.put(a.bitmap_heading);
  out.put(std::string_view(a.label));
  for (const bool flag : {a.visible, a.shadows, a.as_point, a.bounding_box, a.axis, a.neighbor_lines}) out.put(flag);
}

void load(ByteReader& in, Appearance& a) {
  a.color = in.get_vector();
  a.alpha = in.get<double>();
  a.texture = in.get_object();
  a.bitmap = in.get_object();
  a.lightmap = in.get_object();
  a.texture_scale_x = in.get<double>();
  a.texture_scale_y = in.get<double>();
  a.bitmap_heading = in.get<double>();
  a.label = in.get_string();
  for (bool* flag : {&a.visible, &a.shadows, &a.as_point, &a.bounding_box, &a.axis, &a.neighbor_lines}) {
    *flag = in.get_bool();
  }
}

void save(ByteWriter& out, const CollisionFilter& filter) {
  out.put(filter.category);
  out.put(filter.mask);
  out.put(filter.sensor);
  out.put(filter.asks);
  out.put(filter.one_way);
}

void load(ByteReader& in, CollisionFilter& filter) {
  filter.category = in.get<std::uint32_t>();
  filter.mask = in.get<std::uint32_t>();
  filter.sensor = in.get_bool();
  filter.asks = in.get_bool();
  filter.one_way = in.get_vector();
  if (!filter.one_way.allFinite()) ByteReader::fail();
}

void save(ByteWriter& out, const RotationRow& row) {
  out.put(row.orientation);
  out.put(row.velocity);
  out.put(row.acceleration);
}

void load(ByteReader& in, RotationRow& row) {
  row.orientation = in.get_quaternion();
  row.velocity = in.get_vector();
  row.acceleration = in.get_vector();
}

void save(ByteWriter& out, const RigidRow& row) {
  for (const Vector3* v : {&row.force, &row.torque, &row.kinematic_velocity, &row.kinematic_rotational_velocity,
                           &row.solid.center_of_mass}) {
    out.put(*v);
  }
  out.put(row.solid.mass);
  out.put(row.solid.inertia);
  out.put(row.physics);
  out.put(row.solid.round);
}

void load(ByteReader& in, RigidRow& row) {
  for (Vector3* v : {&row.force, &row.torque, &row.kinematic_velocity, &row.kinematic_rotational_velocity,
                     &row.solid.center_of_mass}) {
    *v = in.get_vector();
  }
  row.solid.mass = in.get<double>();
  row.solid.inertia = in.get_matrix();
  row.physics = in.get_bool();
  row.solid.round = in.get_bool();
}

template <class Row>
void save_row(ByteWriter& out, const Rows<Row>& rows, RowIndex row) {
  out.put(row != kNoRow);
  if (row != kNoRow) save(out, rows[row]);
}

template <class Row>
void load_row(ByteReader& in, Rows<Row>& rows, RowIndex& row) {
  if (!in.get_bool()) return;
  row = rows.make();
  load(in, rows[row]);
}

}  // namespace

void Bodies::save(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(index_end()));
  if (!arrays_) return;
  const Arrays& a = *arrays_;
  out.put_shared(a.default_shape);
  for (BodyIndex body = 0; body < a.owner.size(); ++body) {
    out.put(a.owner[body]);
    if (!a.owner[body]) continue;
    out.put(a.kind[body]);
    out.put(a.location[body]);
    out.put(a.velocity[body]);
    out.put(a.acceleration[body]);
    out.put(a.neighborhood[body]);
    out.put(a.driven[body] != 0);
    out.put_shared(a.collision_shape[body]);
    out.put_shared(a.display_shape[body]);
    save_row(out, a.rotation_rows, a.rotation_row[body]);
    save_row(out, a.rigid_rows, a.rigid_row[body]);
    save_row(out, a.materials, a.material_row[body]);
    save_row(out, a.appearances, a.appearance_row[body]);
    save_row(out, a.filters, a.filter_row[body]);
  }
  out.put(static_cast<std::uint64_t>(a.free.size()));
  for (const BodyIndex body : a.free) out.put(body);
  // What setters changed and nobody has taken yet.
  std::pmr::vector<std::uint8_t> met(a.owner.size(), a.touched.get_allocator());
  std::pmr::vector<BodyIndex> touched(a.touched.get_allocator());
  for (const BodyIndex body : a.touched) {
    if (!a.touched_now(body) || met[body] != 0) continue;
    met[body] = 1;
    touched.push_back(body);
  }
  out.put(static_cast<std::uint64_t>(touched.size()));
  for (const BodyIndex body : touched) out.put(body);
}

void Bodies::load(ByteReader& in) {
  const std::size_t count = in.get_count(2 * sizeof(std::uint32_t));
  if (count == 0) return;
  Arrays& a = arrays();
  a.default_shape = in.get_shared<Shape>();
  if (!a.default_shape) ByteReader::fail();
  a.default_shape->report_changes_to(a.shape_changes);
  for (std::size_t i = 0; i < count; ++i) {
    const BodyIndex body = a.grow();
    a.owner[body] = in.get_object();
    if (!a.owner[body]) continue;
    ++a.used;
    a.kind[body] = in.get<BodyKind>();
    a.location[body] = in.get_vector();
    a.velocity[body] = in.get_vector();
    a.acceleration[body] = in.get_vector();
    a.neighborhood[body] = in.get<double>();
    a.driven[body] = in.get_bool() ? 1 : 0;
    a.collision_shape[body] = in.get_shared<Shape>();
    a.display_shape[body] = in.get_shared<Shape>();
    if (!a.collision_shape[body] || !a.display_shape[body] || a.kind[body] > BodyKind::Link) ByteReader::fail();
    a.collision_shape[body]->report_changes_to(a.shape_changes);
    load_row(in, a.rotation_rows, a.rotation_row[body]);
    load_row(in, a.rigid_rows, a.rigid_row[body]);
    load_row(in, a.materials, a.material_row[body]);
    load_row(in, a.appearances, a.appearance_row[body]);
    load_row(in, a.filters, a.filter_row[body]);
    if (filter(body).asks || !filter(body).one_way.isZero(0)) a.picky.push_back(body);
    a.classify(body);
  }
  const std::size_t free_count = in.get_count(sizeof(BodyIndex));
  if (free_count + a.used != count) ByteReader::fail();
  std::pmr::vector<std::uint8_t> met(count, in.memory());
  for (std::size_t i = 0; i < free_count; ++i) {
    const auto body = in.get<BodyIndex>();
    if (body >= count || a.owner[body] || met[body] != 0) ByteReader::fail();
    met[body] = 1;
    a.free.push_back(body);
  }
  for (std::size_t left = in.get_count(sizeof(BodyIndex)); left > 0; --left) {
    const auto body = in.get<BodyIndex>();
    if (!used(body) || a.rigid_row[body] == kNoRow || a.touched_now(body)) ByteReader::fail();
    a.note(body);
  }
}

void Bodies::hash(Hasher& hasher, BodyIndex body) const {
  const Arrays& a = *arrays_;
  hasher.add(std::uint64_t{body} << 8 | static_cast<std::uint64_t>(a.kind[body]));
  hasher.add(a.location[body]);
  hasher.add(a.velocity[body]);
  hasher.add(a.acceleration[body]);
  hasher.add(orientation(body));
  hasher.add(rotational_velocity(body));
  hasher.add(rotational_acceleration(body));
  hasher.add(force(body));
  hasher.add(torque(body));
  hasher.add(static_cast<std::uint64_t>(physics(body)) | std::uint64_t{a.driven[body]} << 1);
  if (physics(body)) {
    const RigidRow& row = a.rigid_rows[a.rigid_row[body]];
    hasher.add(row.solid.mass);
    hasher.add(row.solid.inertia);
    hasher.add(row.kinematic_velocity);
    hasher.add(row.kinematic_rotational_velocity);
  }
  hasher.add(a.neighborhood[body]);
  a.collision_shape[body]->hash(hasher);
  if (a.display_shape[body] != a.collision_shape[body]) a.display_shape[body]->hash(hasher);
  if (a.filter_row[body] != kNoRow) {
    const CollisionFilter& f = filter(body);
    hasher.add(std::uint64_t{f.category} << 32 | f.mask);
    hasher.add(f.one_way);
    hasher.add(std::uint64_t{f.sensor} << 1 | std::uint64_t{f.asks});
  }
  if (a.material_row[body] == kNoRow && a.appearance_row[body] == kNoRow) return;
  // What a body looks like, and how it rubs, is part of the world: as the bytes that a snapshot holds.
  ByteWriter look;
  breve::save(look, material(body));
  breve::save(look, appearance(body));
  hasher.add(std::string_view(reinterpret_cast<const char*>(look.bytes().data()), look.bytes().size()));
}

}  // namespace breve

// Dynamics in a snapshot and in the world hash: joints, springs, settings, and the exact states of trees. Which trees
// there are follows from the joints; a tree is built again as it was and then takes up its numbers.
#include <algorithm>
#include <concepts>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/core.hpp"

namespace breve {

namespace {

/// Writes and reads the same list of members, so that the two cannot get out of step.
struct Writer {
  ByteWriter& out;
  template <class T>
  void operator()(const T& value) const {
    out.put(value);
  }
};
struct Reader {
  ByteReader& in;
  void operator()(Vector3& v) const { v = in.get_vector(); }
  void operator()(Quaternion& q) const { q = in.get_quaternion(); }
  void operator()(ObjectId& id) const { id = in.get_object(); }
  void operator()(bool& flag) const { flag = in.get_bool(); }
  template <class T>
  void operator()(T& value) const {
    value = in.get<T>();
  }
};
/// The same list again, for the hash.
struct Adder {
  Hasher& hasher;
  void operator()(const Vector3& v) const { hasher.add(v); }
  void operator()(const Quaternion& q) const { hasher.add(q); }
  void operator()(const ObjectId& id) const { hasher.add(std::uint64_t{id.index} << 32 | id.generation); }
  void operator()(double value) const { hasher.add(value); }
  template <class T>
  void operator()(const T& value) const {
    hasher.add(static_cast<std::uint64_t>(value));
  }
};

template <class F, class A>
void each(const F& f, A& a) requires std::same_as<std::remove_const_t<A>, Accuracy> {
  f(a.rung), f(a.custom), f(a.scheme), f(a.implicit_joints), f(a.implicit_spin), f(a.step), f(a.tolerance);
  f(a.contact_step), f(a.iterations), f(a.direct), f(a.locate_impacts), f(a.impacts), f(a.contact_springs);
  f(a.contact_stiffness), f(a.contact_damping);
}

template <class F, class S>
void each(const F& f, S& s) requires std::same_as<std::remove_const_t<S>, WorldSettings> {
  f(s.gravity), each(f, s.accuracy), f(s.guard), f(s.sleeping), f(s.fast_contacts), f(s.erp), f(s.cfm);
}

template <class F, class S>
void each(const F& f, S& s) requires std::same_as<std::remove_const_t<S>, AssemblySettings> {
  f(s.has_self), f(s.self_collisions), f(s.self_erp), f(s.self_cfm), f(s.has_accuracy), each(f, s.accuracy);
}

template <class F, class E>
void each(const F& f, E& e) requires std::same_as<std::remove_const_t<E>, Energy> {
  f(e.motor_work), f(e.script_work), f(e.contact_loss), f(e.friction_loss), f(e.drag_loss), f(e.limit_loss);
  f(e.residual);
}

template <class F, class J>
void each(const F& f, J& j) requires std::same_as<std::remove_const_t<J>, JointEntry> {
  f(j.owner), f(j.serial), f(j.ring), f(j.position), f(j.limit);
  auto& is = j.is;
  f(is.kind), f(is.parent), f(is.child), f(is.parent_point), f(is.child_point), f(is.relative_rotation);
  f(is.normal), f(is.other_axis), f(is.keep_rotation);
  auto& d = j.drive;
  f(d.motor_speed), f(d.strength_limit), f(d.double_strength), f(d.double_max), f(d.double_min), f(d.damping);
  f(d.stiffness), f(d.rest), f(d.force), f(d.low), f(d.high), f(d.limit_restitution);
}

template <class F, class T>
void each(const F& f, T& t) requires std::same_as<std::remove_const_t<T>, SpringEntry> {
  f(t.owner), f(t.force);
  auto& is = t.is;
  f(is.a), f(is.b), f(is.point_a), f(is.point_b), f(is.length), f(is.strength), f(is.damping);
  f(is.maximum_force), f(is.mode);
}

template <class F, class B>
void each(const F& f, B& b) requires std::same_as<std::remove_const_t<B>, BodyEntry> {
  f(b.force_method), f(b.known), f(b.location), f(b.velocity), f(b.spin), f(b.orientation), f(b.step);
}

void put_numbers(ByteWriter& out, const articulated::Vector& v) {
  for (const double x : v) out.put(x);
}

template <class Table>
void put_table(ByteWriter& out, const Table& table) {
  out.put(static_cast<std::uint64_t>(table.size()));
  for (const auto& entry : table) {
    out.put(entry.used);
    if (entry.used) each(Writer{out}, entry);
  }
}

template <class Entry>
void get_table(ByteReader& in, std::pmr::vector<Entry>& table) {
  const std::size_t count = in.get_count();
  for (std::size_t i = 0; i < count; ++i) {
    Entry entry;
    entry.used = in.get_bool();
    if (entry.used) each(Reader{in}, entry);
    table.push_back(entry);
  }
}

template <class Index>
void put_free(ByteWriter& out, const std::pmr::vector<Index>& list) {
  out.put(static_cast<std::uint64_t>(list.size()));
  for (const Index index : list) out.put(index);
}

template <class Table, class Index>
void get_free(ByteReader& in, const Table& table, std::pmr::vector<Index>& list) {
  const std::size_t count = in.get_count(sizeof(Index));
  for (std::size_t i = 0; i < count; ++i) {
    const Index index = in.get<Index>();
    if (index >= table.size() || table[index].used) ByteReader::fail();
    list.push_back(index);
  }
}

}  // namespace

void Dynamics::save(ByteWriter& out) const {
  out.put(core_ != nullptr);
  if (core_) core_->save(out);
}

void Dynamics::load(ByteReader& in) {
  if (in.get_bool()) core().load(in);
}

void Dynamics::hash(Hasher& hasher) const {
  if (core_) core_->hash(hasher);
}

void Dynamics::Core::save(ByteWriter& out) const {
  each(Writer{out}, settings);
  each(Writer{out}, account);
  out.put(next_serial);
  out.put(sub_step);
  put_table(out, joints);
  put_free(out, free_joints);
  put_table(out, springs);
  put_free(out, free_springs);
  out.put(static_cast<std::uint64_t>(own.size()));
  for (const auto& [body, assembly] : own) {
    out.put(body);
    each(Writer{out}, assembly);
  }
  // By body, so that it does not matter which entries were used before.
  std::uint64_t count = 0;
  for (const std::uint32_t index : entry_of) count += index != kNone;
  out.put(count);
  for (BodyIndex body = 0; body < entry_of.size(); ++body) {
    if (!find(body)) continue;
    out.put(body);
    each(Writer{out}, *find(body));
  }
  out.put(graph_changed);
  out.put(static_cast<std::uint64_t>(tree_order.size()));
  for (const std::uint32_t index : tree_order) save_tree(out, *trees[index]);
  near.save(out);
}

void Dynamics::Core::save_tree(ByteWriter& out, const Tree& tree) const {
  out.put(tree.first_body());
  out.put(tree.step);
  each(Writer{out}, tree.account);
  put_numbers(out, tree.state.q);
  put_numbers(out, tree.state.v);
  put_numbers(out, tree.limit_force);
  for (const TreeLink& link : tree.links)
    out.put(link.gain_unit), out.put(link.contact.force), out.put(link.contact.couple);
}

void Dynamics::Core::load(ByteReader& in) {
  each(Reader{in}, settings);
  breve::check(settings.accuracy);
  each(Reader{in}, account);
  next_serial = in.get<std::uint64_t>();
  sub_step = in.get<std::uint64_t>();
  get_table(in, joints);
  get_free(in, joints, free_joints);
  get_table(in, springs);
  get_free(in, springs, free_springs);
  const std::size_t assemblies = in.get_count(sizeof(BodyIndex));
  for (std::size_t i = 0; i < assemblies; ++i) {
    const auto body = in.get<BodyIndex>();
    each(Reader{in}, own[body]);
    breve::check(own[body].accuracy);
  }
  const std::size_t count = in.get_count(sizeof(BodyIndex));
  for (std::size_t i = 0; i < count; ++i) {
    const auto body = in.get<BodyIndex>();
    if (!bodies->used(body)) ByteReader::fail();
    each(Reader{in}, entry(body));
  }
  join_loaded();
  const bool pending = in.get_bool();
  loading = true;  // the arrays are as they were saved, and stay so
  build_trees();
  const std::size_t stored = in.get_count(sizeof(BodyIndex));
  std::pmr::vector<std::uint32_t> kept(memory);
  for (std::size_t i = 0; i < stored; ++i) kept.push_back(load_tree(in));
  for (std::uint32_t i = 0; i < trees.size(); ++i)
    if (trees[i] && std::find(kept.begin(), kept.end(), i) == kept.end()) drop_tree(i);
  loading = false;
  graph_changed = pending;
  near.load(in, *bodies);
  bodies->touch_rigid();  // what was set in the arrays and not taken yet is found by comparing
}

void Dynamics::Core::join_loaded() {
  std::pmr::vector<JointIndex> order(memory);
  for (JointIndex i = 0; i < joints.size(); ++i)
    if (joints[i].used) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [this](JointIndex x, JointIndex y) { return joints[x].serial < joints[y].serial; });
  for (const JointIndex index : order) {
    const JointDescription& is = joints[index].is;
    try {
      check(is, *bodies);
    } catch (const Error&) {
      ByteReader::fail();
    }
    entry(is.child).joints.push_back(index);
    if (is.parent != kNoBody) entry(is.parent).joints.push_back(index);
  }
  for (const SpringEntry& tie : springs) {
    if (!tie.used) continue;
    for (const BodyIndex end : {tie.is.a, tie.is.b}) {
      if (!bodies->used(end)) ByteReader::fail();
      ++entry(end).ties;
    }
  }
}

std::uint32_t Dynamics::Core::load_tree(ByteReader& in) {
  const auto body = in.get<BodyIndex>();
  const BodyEntry* known = find(body);
  if (!known || known->tree == kNone) ByteReader::fail();
  Tree& tree = *trees[known->tree];
  tree.step = in.get<double>();
  each(Reader{in}, tree.account);
  for (double& x : tree.state.q) x = in.get<double>();
  for (double& x : tree.state.v) x = in.get<double>();
  for (double& x : tree.limit_force) x = in.get<double>();
  for (TreeLink& link : tree.links) {
    link.gain_unit = in.get<double>();
    link.contact.force = in.get_vector();
    link.contact.couple = in.get_vector();
  }
  return known->tree;
}

void Dynamics::Core::hash(Hasher& hasher) const {
  const Adder add{hasher};
  each(add, settings);
  each(add, account);
  for (const JointEntry& joint : joints)
    if (joint.used) each(add, joint);
  for (const SpringEntry& tie : springs)
    if (tie.used) each(add, tie);
  for (const auto& [body, assembly] : own) {
    add(body);
    each(add, assembly);
  }
  for (const std::uint32_t index : tree_order) {
    const Tree& tree = *trees[index];
    add(tree.step);
    for (const double x : tree.state.q) add(x);
    for (const double x : tree.state.v) add(x);
  }
  near.hash(hasher);
}

}  // namespace breve

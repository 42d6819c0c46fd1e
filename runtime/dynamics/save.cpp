// Dynamics in a snapshot and in the world hash: joints, springs, settings, and the exact states of trees. Which trees
// there are follows from the joints; a tree is built again as it was and then takes up its numbers.
#include <algorithm>
#include <span>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/core.hpp"
#include "runtime/dynamics/stale.hpp"
#include "runtime/mechanics/members.hpp"

namespace breve {

namespace {

using members::Adder;
using members::each;
using members::get_free;
using members::get_table;
using members::Is;
using members::put_free;
using members::put_table;
using members::Reader;
using members::Writer;

}  // namespace

template <class F, Is<AssemblySettings> S>
void each(const F& f, S& s) {
  f(s.has_self), f(s.self_collisions), f(s.self_erp), f(s.self_cfm), f(s.has_accuracy), each(f, s.accuracy);
}

template <class F, Is<JointEntry> J>
void each(const F& f, J& j) {
  f(j.owner), f(j.serial), f(j.loop), f(j.position), f(j.limit), f(j.limit_before), f(j.motor), each(f, j.is),
      each(f, j.drive);
}

template <class F, Is<SpringEntry> T>
void each(const F& f, T& t) {
  f(t.owner), f(t.force), f(t.booked), each(f, t.is);
}

template <class F, Is<BodyEntry> B>
void each(const F& f, B& b) {
  f(b.force_method), f(b.known), f(b.location), f(b.velocity), f(b.spin), f(b.orientation), f(b.step);
}

namespace {

void put_numbers(ByteWriter& out, const articulated::Vector& v) {
  for (const double x : v) out.put(x);
}

/// Which trees are to be dropped when changes are taken next; by index.
std::pmr::vector<std::uint8_t> stale_trees(const Dynamics::Core& core) {
  std::pmr::vector<std::uint8_t> stale(core.trees.size(), core.memory);
  for (std::size_t i = 0; i < stale.size(); ++i) stale[i] = core.trees[i] && is_stale(core, *core.trees[i]);
  return stale;
}

/// As dropping its tree will leave it, if that is to go.
JointEntry as_kept(const Dynamics::Core& core, const JointEntry& joint, std::span<const std::uint8_t> stale) {
  JointEntry kept = joint;
  if (joint.tree != kNone && joint.link >= 0 && stale[joint.tree] != 0) kept.position = core.read_position(joint);
  return kept;
}

/// By body, what those without a tree have by the books.
std::pmr::vector<double> books_of_all(const Dynamics::Core& core) {
  std::pmr::vector<double> books(core.booked, core.memory);
  books.resize(core.bodies->index_end(), kNoBook);
  return books;
}

/// Energy by the books, as dropping these trees will leave it.
/// @param books  by body, what those without a tree have
Energy ledger_kept(const Dynamics::Core& core, std::span<const std::uint8_t> stale, std::span<double> books) {
  Energy ledger = core.ledger;
  for (const std::uint32_t index : core.tree_order)
    if (stale[index] != 0) ledger.script_work += core.unbook(*core.trees[index], books);
  return ledger;
}

/// A number that an image must not make larger than the last of an enumeration.
template <class Enum>
bool is_one_of(Enum value, Enum last) {
  return static_cast<int>(value) <= static_cast<int>(last);
}

}  // namespace

void Dynamics::save(ByteWriter& out) const {
  out.put(core_ != nullptr);
  if (!core_) return;
  wake_disturbed();
  core_->save(out);
}

void Dynamics::load(ByteReader& in) {
  if (in.get_bool()) core().load(in);
}

void Dynamics::hash(Hasher& hasher) const {
  if (!core_) return;
  wake_disturbed();
  core_->hash(hasher);
}

/// Bodies that wake up in the next step are awake in an image, and so in the hash.
void Dynamics::wake_disturbed() const {
  if (core_->settings.sleeping) core_->near.wake_disturbed(*bodies_, core_->settings.unit);
}

void Dynamics::Core::save(ByteWriter& out) const {
  const std::pmr::vector<std::uint8_t> stale = stale_trees(*this);
  std::pmr::vector<double> books = books_of_all(*this);
  const Energy kept_ledger = ledger_kept(*this, stale, books);
  each(Writer{out}, settings);
  out.put(settings.unit);
  each(Writer{out}, kept_ledger);
  out.put(next_serial);
  out.put(sub_step);
  out.put(static_cast<std::uint64_t>(joints.size()));
  for (const JointEntry& joint : joints) {
    out.put(joint.used);
    if (!joint.used) continue;
    const JointEntry kept = as_kept(*this, joint, stale);
    each(Writer{out}, kept);
  }
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
  for (const double energy : books) out.put(energy);
  put_unsettled(out);
  std::pmr::vector<std::uint32_t> kept(memory);
  for (const std::uint32_t index : tree_order)
    if (stale[index] == 0) kept.push_back(index);
  out.put(graph_changed || kept.size() != tree_order.size());
  out.put(static_cast<std::uint64_t>(kept.size()));
  for (const std::uint32_t index : kept) out.put(trees[index]->first_body());
  for (const std::uint32_t index : kept) save_tree(out, *trees[index]);
  near.save(out, *bodies);
}

/// Bodies whose books the next step settles.
void Dynamics::Core::put_unsettled(ByteWriter& out) const {
  std::pmr::vector<BodyIndex> some(memory);
  for (const BodyIndex body : unsettled)
    if (bodies->used(body)) some.push_back(body);
  std::sort(some.begin(), some.end());
  some.erase(std::unique(some.begin(), some.end()), some.end());
  out.put(static_cast<std::uint64_t>(some.size()));
  for (const BodyIndex body : some) out.put(body);
}

void Dynamics::Core::save_tree(ByteWriter& out, const Tree& tree) const {
  out.put(tree.step);
  out.put(tree.unheld);
  out.put(tree.booked);
  out.put(tree.owed);
  out.put(tree.fastest);
  out.put(tree.credit);
  out.put(tree.set_apart);
  out.put(tree.set_open);
  out.put(tree.changed);
  each(Writer{out}, tree.ledger);
  put_numbers(out, tree.state.q);
  put_numbers(out, tree.state.v);
  put_numbers(out, tree.mean);
  put_numbers(out, tree.limit_force);
  for (const TreeLink& link : tree.links)
    out.put(link.gain_unit), out.put(link.contact.force), out.put(link.contact.couple);
}

void Dynamics::Core::load(ByteReader& in) {
  each(Reader{in}, settings);
  settings.unit = in.get<double>();
  check_loaded(settings);
  each(Reader{in}, ledger);
  next_serial = in.get<std::uint64_t>();
  sub_step = in.get<std::uint64_t>();
  get_table(in, joints);
  get_free(in, joints, free_joints);
  get_table(in, springs);
  get_free(in, springs, free_springs);
  const std::size_t assemblies = in.get_count(sizeof(BodyIndex));
  for (std::size_t i = 0; i < assemblies; ++i) {
    const auto body = in.get<BodyIndex>();
    if (!bodies->used(body)) ByteReader::fail();
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
  booked.resize(bodies->index_end(), kNoBook);
  for (double& energy : booked) energy = in.get<double>();
  const std::size_t open = in.get_count(sizeof(BodyIndex));
  for (std::size_t i = 0; i < open; ++i) {
    unsettled.push_back(in.get<BodyIndex>());
    if (!bodies->used(unsettled.back())) ByteReader::fail();
  }
  const bool pending = in.get_bool();
  std::pmr::vector<std::uint8_t> loops(memory);
  for (const JointEntry& joint : joints) loops.push_back(joint.loop);
  loading = true;  // the arrays are as they were saved, and stay so
  load_trees(in);
  for (JointIndex i = 0; i < joints.size(); ++i)
    if (joints[i].tree == kNone) joints[i].loop = loops[i] != 0;  // what a tree that was not there made of it
  loading = false;
  graph_changed = pending;
  near.load(in, *bodies, settings.unit);
}

void Dynamics::Core::join_loaded() {
  for (const JointIndex index : used_joints(joints, memory)) {
    const JointDescription& is = joints[index].is;
    check(is, *bodies);
    check(joints[index].drive, is.kind);
    entry(is.child).joints.push_back(index);
    if (is.parent != kNoBody) entry(is.parent).joints.push_back(index);
  }
  for (const SpringEntry& spring : springs) {
    if (!spring.used) continue;
    check(spring.is);
    if (!is_one_of(spring.is.mode, SpringMode::ContractOnly) || spring.is.a == spring.is.b) ByteReader::fail();
    for (const BodyIndex end : {spring.is.a, spring.is.b}) {
      if (!bodies->used(end)) ByteReader::fail();
      ++entry(end).springs;
    }
  }
}

/// Those that the image holds: others are built in the next step, or cannot be.
void Dynamics::Core::load_trees(ByteReader& in) {
  std::pmr::vector<BodyIndex> stored(in.get_count(sizeof(BodyIndex)), memory);
  for (BodyIndex& body : stored) {
    body = in.get<BodyIndex>();
    if (!find(body) || find(body)->tree != kNone) ByteReader::fail();
    build_tree_of(body);
    if (find(body)->tree == kNone) ByteReader::fail();
  }
  order_trees();
  for (const BodyIndex body : stored) load_tree(in, *trees[find(body)->tree]);
}

void Dynamics::Core::load_tree(ByteReader& in, Tree& tree) {
  tree.step = in.get<double>();
  tree.unheld = std::clamp(in.get<int>(), 0, kMostUnheld);
  tree.booked = in.get<double>();
  tree.owed = std::max(0.0, in.get<double>());
  tree.fastest = std::max(0.0, in.get<double>());
  tree.credit = std::max(0.0, in.get<double>());
  tree.set_apart = in.get_bool();
  tree.set_open = std::max(0.0, in.get<double>());
  tree.changed = in.get_bool();
  each(Reader{in}, tree.ledger);
  for (double& x : tree.state.q) x = in.get<double>();
  for (double& x : tree.state.v) x = in.get<double>();
  for (double& x : tree.mean) x = in.get<double>();
  for (double& x : tree.limit_force) x = in.get<double>();
  for (TreeLink& link : tree.links) {
    link.gain_unit = in.get<double>();
    link.contact.force = in.get_vector();
    link.contact.couple = in.get_vector();
  }
}

void Dynamics::Core::hash(Hasher& hasher) const {
  const Adder add{hasher};
  const std::pmr::vector<std::uint8_t> stale = stale_trees(*this);
  std::pmr::vector<double> books = books_of_all(*this);
  const Energy kept_ledger = ledger_kept(*this, stale, books);
  each(add, settings);
  if (settings.unit != 1) add(settings.unit);
  each(add, kept_ledger);
  for (const JointEntry& joint : joints) {
    if (!joint.used) continue;
    const JointEntry kept = as_kept(*this, joint, stale);
    each(add, kept);
  }
  for (const SpringEntry& spring : springs)
    if (spring.used) each(add, spring);
  for (const auto& [body, assembly] : own) {
    add(body);
    each(add, assembly);
  }
  for (const std::uint32_t index : tree_order) {
    if (stale[index] != 0) continue;
    const Tree& tree = *trees[index];
    add(tree.step);
    add(tree.unheld);
    add(tree.owed);
    add(tree.fastest);
    add(tree.credit);
    add(tree.set_apart);
    add(tree.set_open);
    for (const double x : tree.state.q) add(x);
    for (const double x : tree.state.v) add(x);
    for (const double x : tree.mean) add(x);
  }
  near.hash(hasher, *bodies);
}

}  // namespace breve

// The lists of members of what both backends keep, for snapshots and hashes: written, read and hashed by the same list,
// so that these cannot get out of step. And tables with free places.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory_resource>
#include <type_traits>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/mechanics/accuracy.hpp"
#include "runtime/mechanics/core.hpp"
#include "runtime/mechanics/joint.hpp"
#include "runtime/mechanics/ledger.hpp"
#include "runtime/mechanics/spring.hpp"

namespace breve::members {

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

struct Adder {
  Hasher& hasher;
  void operator()(const Vector3& v) const { hasher.add(v); }
  void operator()(const Quaternion& q) const { hasher.add(q); }
  void operator()(const ObjectId& id) const { hasher.add(std::uint64_t{id.index} << 32 | id.generation); }
  void operator()(double value) const { hasher.add(value); }
  void operator()(float value) const { hasher.add(double{value}); }
  template <class T>
  void operator()(const T& value) const {
    hasher.add(static_cast<std::uint64_t>(value));
  }
};

/// A list serves for const and for changeable members.
template <class T, class U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

template <class F, Is<Accuracy> A>
void each(const F& f, A& a) {
  f(a.rung), f(a.custom), f(a.scheme), f(a.implicit_joints), f(a.implicit_spin), f(a.step), f(a.tolerance);
  f(a.contact_step), f(a.iterations), f(a.direct), f(a.locate_impacts), f(a.impacts), f(a.contact_springs);
  f(a.link_springs), f(a.contact_stiffness), f(a.contact_damping);
}

/// But not the length unit, which space does not have.
template <class F, Is<WorldSettings> S>
void each(const F& f, S& s) {
  f(s.gravity), each(f, s.accuracy), f(s.guard), f(s.sleeping), f(s.fast_contacts), f(s.erp), f(s.cfm);
}

template <class F, Is<Energy> E>
void each(const F& f, E& e) {
  f(e.motor_work), f(e.script_work), f(e.contact_loss), f(e.friction_loss), f(e.drag_loss), f(e.limit_loss);
  f(e.residual);
}

template <class F, Is<JointDescription> J>
void each(const F& f, J& j) {
  f(j.kind), f(j.parent), f(j.child), f(j.parent_point), f(j.child_point), f(j.relative_rotation);
  f(j.normal), f(j.other_axis), f(j.keep_rotation);
}

template <class F, Is<JointDrive> D>
void each(const F& f, D& d) {
  f(d.motor_speed), f(d.strength_limit), f(d.double_strength), f(d.double_max), f(d.double_min), f(d.damping);
  f(d.stiffness), f(d.rest), f(d.force), f(d.low), f(d.high), f(d.limit_restitution);
}

template <class F, Is<SpringDescription> S>
void each(const F& f, S& s) {
  f(s.a), f(s.b), f(s.point_a), f(s.point_b), f(s.length), f(s.strength), f(s.damping);
  f(s.maximum_force), f(s.mode);
}

template <class F, Is<SpringRecord> S>
void each(const F& f, S& s) {
  f(s.owner), f(s.force), each(f, s.is);
}

/// Whether all listed members of two are the same, bit for bit.
template <class T>
bool same(const T& x, const T& y) {
  Hasher of_x, of_y;
  each(Adder{of_x}, x);
  each(Adder{of_y}, y);
  return of_x.value() == of_y.value();
}

/// Entries whose `used` says whether the place is taken; those that are have a list of members.
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

/// Free places of a table, the next to be used last.
template <class Index>
void put_free(ByteWriter& out, const std::pmr::vector<Index>& list) {
  out.put(static_cast<std::uint64_t>(list.size()));
  for (const Index index : list) out.put(index);
}

template <class Table, class Index>
void get_free(ByteReader& in, const Table& table, std::pmr::vector<Index>& list) {
  const std::size_t count = in.get_count(sizeof(Index));
  std::pmr::vector<std::uint8_t> met(table.size(), in.memory());
  list.reserve(table.size());  // who gives a place back allocates nothing
  for (std::size_t i = 0; i < count; ++i) {
    const Index index = in.get<Index>();
    if (index >= table.size() || table[index].used || met[index] != 0) ByteReader::fail();
    met[index] = 1;
    list.push_back(index);
  }
}

}  // namespace breve::members

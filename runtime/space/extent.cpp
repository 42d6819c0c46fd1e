// Wrapping and reflecting, axis by axis.
#include "runtime/space/extent.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/base/error.hpp"

namespace breve {

void Extent::set(int axis, Ending edge, double low, double high) {
  if (axis < 0 || axis > 2) throw Error(ErrorCode::Argument, "space has no axis " + std::to_string(axis) + " (0 to 2)");
  if (edge == Ending::Open) low = high = 0;
  if (edge != Ending::Open && !(std::isfinite(low) && std::isfinite(high) && std::isfinite(high - low) && low < high)) {
    throw Error(ErrorCode::Argument, "the bounds of space are " + std::to_string(low) + " and " + std::to_string(high) +
                                         " (must be finite, the first below the second)");
  }
  axes_[static_cast<std::size_t>(axis)] = {edge, low, high};
  closed_ = wraps_ = false;
  for (const Axis& one : axes_) {
    closed_ = closed_ || one.edge != Ending::Open;
    wraps_ = wraps_ || one.edge == Ending::Wrap;
  }
}

bool Extent::holds(const Vector3& location) const {
  for (int i = 0; i < 3; ++i) {
    const Axis& a = axis(i);
    if (a.edge == Ending::Open) continue;
    if (location[i] < a.low || location[i] > a.high || (a.edge == Ending::Wrap && location[i] == a.high)) return false;
  }
  return true;
}

Vector3 Extent::inside(const Vector3& location) const {
  Vector3 place = location, still = Vector3::Zero();
  bring_inside(place, still);
  return place;
}

void Extent::bring_inside(Vector3& location, Vector3& velocity) const {
  for (int i = 0; i < 3; ++i) {
    const Axis& a = axis(i);
    double& x = location[i];
    if (a.edge == Ending::Open || (x >= a.low && x < a.high)) continue;
    const double length = a.high - a.low;
    const double turns = std::floor((x - a.low) / length);
    // Rounding may leave a place at, or just beyond, an edge.
    double rest = std::clamp(x - a.low - turns * length, 0.0, length);
    if (a.edge == Ending::Wrap) {
      x = a.low + (rest < length ? rest : 0.0);
      if (x >= a.high) x = a.low;
      continue;
    }
    if (x == a.high) continue;
    if (std::fmod(turns, 2.0) != 0) {
      rest = length - rest;
      velocity[i] = -velocity[i];
    }
    x = std::clamp(a.low + rest, a.low, a.high);
  }
}

Vector3 Extent::offset(const Vector3& from, const Vector3& to) const {
  const Vector3 way = to - from;
  return wraps_ ? Vector3(way + image(from, to)) : way;
}

Vector3 Extent::image(const Vector3& from, const Vector3& to) const {
  Vector3 shift = Vector3::Zero();
  if (!wraps_) return shift;
  for (int i = 0; i < 3; ++i) {
    const Axis& a = axis(i);
    if (a.edge != Ending::Wrap) continue;
    const double length = a.high - a.low, way = to[i] - from[i];
    if (std::abs(way) > 0.5 * length) shift[i] = -length * std::round(way / length);
  }
  return shift;
}

void Extent::save(ByteWriter& out) const {
  for (const Axis& a : axes_) {
    out.put(a.edge);
    out.put(a.low);
    out.put(a.high);
  }
}

void Extent::load(ByteReader& in) {
  for (int i = 0; i < 3; ++i) {
    const auto edge = in.get<Ending>();
    const auto low = in.get<double>();
    const auto high = in.get<double>();
    if (edge > Ending::Wall) ByteReader::fail();
    try {
      set(i, edge, low, high);
    } catch (const Error&) {
      ByteReader::fail();
    }
  }
}

void Extent::hash(Hasher& hasher) const {
  if (open()) return;
  for (const Axis& a : axes_) {
    hasher.add(static_cast<std::uint64_t>(a.edge));
    hasher.add(a.low);
    hasher.add(a.high);
  }
}

}  // namespace breve

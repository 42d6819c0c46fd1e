// Wrapping and reflecting, axis by axis.
#include "runtime/space/extent.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/base/error.hpp"
#include "runtime/space/walls.hpp"

namespace breve {

void Extent::set(int axis, Ending edge, double low, double high) {
  if (axis < 0 || axis > 2) throw Error(ErrorCode::Argument, "space has no axis " + std::to_string(axis) + " (0 to 2)");
  if (edge == Ending::Open) low = high = 0;
  if (edge != Ending::Open && !(std::isfinite(low) && std::isfinite(high) && std::isfinite(high - low) && low < high)) {
    throw Error(ErrorCode::Argument, "the bounds of space are " + fmt::to_string(low) + " and " + fmt::to_string(high) +
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
  Vector3 position = location, still = Vector3::Zero();
  bring_inside(position, still);
  return position;
}

namespace {

/// Wrapped, or folded back by walls: as what moves at a constant speed.
void fold(const Extent::Axis& a, double& x, double& v) {
  if (a.edge == Ending::Open || (x >= a.low && x < a.high)) return;
  const double length = a.high - a.low;
  const double laps = std::floor((x - a.low) / length);
  // Rounding may leave a place at, or just beyond, an edge.
  double rest = std::clamp(x - a.low - laps * length, 0.0, length);
  if (a.edge == Ending::Wrap) {
    x = a.low + (rest < length ? rest : 0.0);
    if (x >= a.high) x = a.low;
    return;
  }
  if (x == a.high) return;
  if (std::fmod(laps, 2.0) != 0) {
    rest = length - rest;
    v = -v;
  }
  x = std::clamp(a.low + rest, a.low, a.high);
}

/// Reflected once, at the wall that lies between. Outward are the distance from the wall, the speed and the
/// acceleration.
void bounce(double wall, double out, double& x, double& v, double acceleration) {
  const double far = out * (x - wall), speed = out * v, pull = out * acceleration;
  const double met = std::sqrt(std::max(0.0, speed * speed - 2 * pull * far));  // speed at the wall, by its energy
  double since = std::max(0.0, (speed - met) / pull);                           // s, since it was there
  // A body that is pulled outward comes back to the wall again and again.
  if (pull > 0) since = met > 0 ? std::fmod(since, 2 * met / pull) : 0;
  x = wall + out * since * (0.5 * pull * since - met);
  v = out * (pull * since - met);
}

}  // namespace

void Extent::bring_inside(Vector3& location, Vector3& velocity) const {
  for (int i = 0; i < 3; ++i) fold(axis(i), location[i], velocity[i]);
}

void throw_back(const Extent& space, Vector3& location, Vector3& velocity, const Vector3& acceleration) {
  constexpr int kMost = 100;  // bounces between two walls: what is so fast does not feel the acceleration
  for (int i = 0; i < 3; ++i) {
    const Extent::Axis& a = space.axis(i);
    double &x = location[i], &v = velocity[i];
    const double pull = acceleration[i];
    const auto outside = [&] { return x < a.low || x > a.high; };
    if (a.edge == Ending::Wall && pull != 0 && std::isfinite(v))
      for (int k = 0; k < kMost && outside(); ++k) bounce(x < a.low ? a.low : a.high, x < a.low ? -1 : 1, x, v, pull);
    if (a.edge != Ending::Wall || !outside()) {
      fold(a, x, v);
      continue;
    }
    const double from = x, energy = v * v;
    fold(a, x, v);
    v = std::copysign(std::sqrt(std::max(0.0, energy + 2 * pull * (x - from))), v);
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

// How far space goes: along each axis it is open, wraps around, or ends at walls that reflect.
#pragma once

#include <array>
#include <cstdint>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/math.hpp"

namespace breve {

enum class Ending : std::uint8_t { Open, Wrap, Wall };

class Extent {
 public:
  struct Axis {
    Ending edge = Ending::Open;
    double low = 0, high = 0;  // m; low < high unless open
    friend bool operator==(const Axis&, const Axis&) = default;
  };

  /// @param axis  0, 1, 2 for x, y, z
  /// @throws Error{Argument} for an invalid axis, bounds that are not finite or not low < high
  void set(int axis, Ending edge, double low, double high);
  const Axis& axis(int axis) const { return axes_[static_cast<std::size_t>(axis)]; }
  bool open() const { return !closed_; }  // along all axes
  bool wraps() const { return wraps_; }   // along some axis

  /// Is a place within all bounds? Wrapping axes hold low but not high, walls both.
  bool holds(const Vector3& location) const;
  /// The place where a finite one comes to lie: wrapped, or thrown back by walls as often as needed.
  Vector3 inside(const Vector3& location) const;
  /// The same for something that moves: an odd number of walls along an axis reverses its velocity.
  void bring_inside(Vector3& location, Vector3& velocity) const;
  /// The shortest way from one place to another, across edges that wrap; of two equally short ones any, but the way
  /// back is its opposite.
  Vector3 offset(const Vector3& from, const Vector3& to) const;
  /// The offset to be added to `to` for that: whole lengths of space along axes that wrap.
  Vector3 image(const Vector3& from, const Vector3& to) const;
  friend bool operator==(const Extent&, const Extent&) = default;

  void save(ByteWriter& out) const;
  void load(ByteReader& in);  // Error{Image}
  void hash(Hasher& hasher) const;

 private:
  std::array<Axis, 3> axes_;
  bool closed_ = false, wraps_ = false;
};

}  // namespace breve

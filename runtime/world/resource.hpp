// Native data behind one object of the world: an image's pixels, a matrix, a menu entry. Owned by the world, saved
// and hashed with it, gone when the object is freed.
#pragma once

#include <memory>
#include <string_view>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/memory.hpp"

namespace breve {

class Resource : public InMemory {
 public:
  virtual ~Resource() = default;
  /// A constant, unique name of the concrete class; the snapshot finds the loader by it.
  virtual std::string_view kind() const = 0;
  virtual void save(ByteWriter& out) const = 0;
  virtual void hash(Hasher& hasher) const = 0;
};

/// A resource that shares a Shape (or the like) with bodies writes it with out.put_shared(shape) and reads it with
/// in.get_shared<Shape>(), so that it is the same shape again after loading.
/// A loaded resource takes its bytes from in.memory(): make_in<R>(in.memory()).
/// Registered once per kind with World::add_resource_kind.
using ResourceLoader = std::unique_ptr<Resource> (*)(ByteReader& in);

}  // namespace breve

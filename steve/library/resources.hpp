// The native data behind Shape, Matrix2D, Matrix3D, Vector and Reaction objects.
#pragma once

#include <memory>
#include <optional>

#include "runtime/patches/field.hpp"
#include "runtime/patches/reaction.hpp"
#include "runtime/solid/shape.hpp"
#include "runtime/world/resource.hpp"

namespace breve::steve {

/// A Shape object. The geometry is shared with the bodies that use it and lives on while one does.
class ShapeResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "shape";
  std::shared_ptr<Shape> shape;  // null until built
  double density = 1;            // for the geometry to come

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

/// A Matrix2D, Matrix3D or Vector object.
class FieldResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "field";
  std::optional<Field> field;  // none until sized

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

/// A Reaction object.
class ReactionResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "reaction";
  std::optional<Reaction> reaction;  // none until its matrices are named

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

}  // namespace breve::steve

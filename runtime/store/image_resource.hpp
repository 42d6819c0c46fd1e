// The picture behind a script's Image object.
#pragma once

#include <memory>
#include <utility>

#include "runtime/store/image.hpp"
#include "runtime/world/resource.hpp"

namespace breve {

class ImageResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "image";
  explicit ImageResource(Image image_) : image(std::move(image_)) {}
  explicit ImageResource(std::pmr::memory_resource* memory) : image(memory) {}

  Image image;

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override { image.save(out); }
  void hash(Hasher& hasher) const override { image.hash(hasher); }
  static std::unique_ptr<Resource> load(ByteReader& in) { return make_in<ImageResource>(in.memory(), Image::load(in)); }
};

}  // namespace breve

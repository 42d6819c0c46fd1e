// What Sound and Tone objects are made of, and what is heard of all of a world.
#pragma once

#include <memory>
#include <span>

#include "runtime/store/sound.hpp"
#include "runtime/world/resource.hpp"
#include "runtime/world/world.hpp"

namespace breve::steve {

/// A Sound object.
class SoundResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "sound";
  explicit SoundResource(std::pmr::memory_resource* memory) : sound(memory) {}
  PlayedSound sound;

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override { sound.save(out); }
  void hash(Hasher& hasher) const override { sound.hash(hasher); }
  static std::unique_ptr<Resource> load(ByteReader& in) {
    auto resource = make_in<SoundResource>(in.memory(), in.memory());
    resource->sound.load(in);
    return resource;
  }
};

/// A Tone object.
class ToneResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "tone";
  SineTone tone;

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override { tone.save(out); }
  void hash(Hasher& hasher) const override { tone.hash(hasher); }
  static std::unique_ptr<Resource> load(ByteReader& in) {
    auto resource = make_in<ToneResource>(in.memory());
    resource->tone.load(in);
    return resource;
  }
};

/// Add all that the world's objects play to frames of two samples, object by object in the order of creation.
void add_sounds(const World& world, std::span<float> frames, const Listening& listening);

}  // namespace breve::steve

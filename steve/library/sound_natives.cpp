// Natives of Sound and Tone.
#include <algorithm>
#include <cmath>
#include <typeinfo>

#include "steve/library/sounds.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

void add_sounds(const World& world, std::span<float> frames, const Listening& listening) {
  for (const ObjectId id : world.objects()) {
    const Resource* resource = world.resource(id);
    if (!resource) continue;
    if (typeid(*resource) == typeid(SoundResource))
      static_cast<const SoundResource&>(*resource).sound.add_to(frames, listening);
    if (typeid(*resource) == typeid(ToneResource))
      static_cast<const ToneResource&>(*resource).tone.add_to(frames, listening);
  }
}

namespace {

using Text = StringCell*;

PlayedSound& sound(Machine& machine, Instance& self) { return resource_made<SoundResource>(machine, self).sound; }
SineTone& tone(Machine& machine, Instance& self) { return resource_made<ToneResource>(machine, self).tone; }

// --- Sound -----------------------------------------------------------------------------------------------------------

Instance* sound_load(Machine& machine, Instance& self, Text file) {
  const std::string name(view(file));
  PlayedSound& own = sound(machine, self);
  try {
    const std::pmr::string bytes = read_file(machine, name);
    machine.charge(bytes.size());  // a loop iteration for each byte
    Samples samples = Samples::parse(bytes, name, machine.heap().memory(), machine.poller());
    own.stop();
    own.samples = std::move(samples);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File && error.code() != ErrorCode::Unsupported) throw;
    // A world without one of its sounds goes on as where nobody listens: with a moment of silence.
    constexpr std::uint32_t kRate = 44100;
    own.stop();
    own.samples = Samples(std::pmr::vector<float>(1, 0.0F, machine.heap().memory()), 1, kRate);
    machine.warn_once("sound:" + name, "sound '" + name + "' not loaded, silence in its place: " + error.what());
  }
  return &self;
}

void sound_play(Machine& machine, Instance& self, double speed) {
  PlayedSound& own = sound(machine, self);
  if (own.samples.empty()) throw Error(ErrorCode::Argument, "play: the sound has no samples: load a file first");
  own.play(machine.world().time(), speed > 0 ? std::min(speed, PlayedSound::kMostSpeed) : 1);
}

void sound_stop(Machine& machine, Instance& self) { sound(machine, self).stop(); }
std::int32_t sound_is_playing(Machine& machine, Instance& self) {
  return sound(machine, self).sounds_at(machine.world().time());
}
double sound_get_duration(Machine& machine, Instance& self) { return sound(machine, self).samples.seconds(); }

// --- Tone ------------------------------------------------------------------------------------------------------------

void tone_init(Machine& machine, Instance& self) { tone(machine, self); }

void tone_set_frequency(Machine& machine, Instance& self, double hertz) {
  if (!(hertz >= 0) || hertz > SineTone::kMostFrequency)
    throw Error(ErrorCode::Argument,
                "set-frequency: " + std::to_string(hertz) + " Hz is not a frequency from 0 to 1000000 Hz");
  tone(machine, self).set_frequency(machine.world().time(), hertz);
}

void tone_set_volume(Machine& machine, Instance& self, double volume) {
  tone(machine, self).set_volume(std::clamp(finite(volume, "a volume"), 0.0, 1.0));
}
void tone_set_balance(Machine& machine, Instance& self, double balance) {
  tone(machine, self).set_balance(std::clamp(finite(balance, "a balance"), 0.0, 1.0));
}
double tone_get_frequency(Machine& machine, Instance& self) { return tone(machine, self).frequency(); }
double tone_get_volume(Machine& machine, Instance& self) { return tone(machine, self).volume(); }
double tone_get_balance(Machine& machine, Instance& self) { return tone(machine, self).balance(); }

constexpr Native kSoundNatives[] = {
    native<sound_load>("sound.load", Reach::Reads),
    native<sound_play>("sound.play"),
    native<sound_stop>("sound.stop"),
    native<sound_is_playing>("sound.is-playing"),
    native<sound_get_duration>("sound.get-duration"),
    native<tone_init>("tone.init"),
    native<tone_set_frequency>("tone.set-frequency"),
    native<tone_set_volume>("tone.set-volume"),
    native<tone_set_balance>("tone.set-balance"),
    native<tone_get_frequency>("tone.get-frequency"),
    native<tone_get_volume>("tone.get-volume"),
    native<tone_get_balance>("tone.get-balance"),
};

}  // namespace

std::span<const Native> sound_natives() { return kSoundNatives; }

}  // namespace breve::steve

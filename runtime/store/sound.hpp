// Sounds: the samples of a file, the tones and sounds that play, and what is heard of them at a time. Nothing is
// computed until somebody listens.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/poll.hpp"

namespace breve {

/// The moments at which a listener takes frames of two samples, left and right: `start`, then every 1 / rate seconds.
struct Listening {
  double start;  // simulated s
  double rate;   // frames in a second
};

/// The samples of a sound file, from -1 to 1.
class Samples {
 public:
  static constexpr std::size_t kMostFileBytes = std::size_t{64} << 20;
  static constexpr std::uint32_t kMostChannels = 64, kMostRate = 1'000'000;

  explicit Samples(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : values_(memory) {}
  /// From the bytes of a file: WAV, AIFF, AU, FLAC, Ogg Vorbis and whatever else libsndfile reads. More channels than
  /// two are reduced to the first two. Error{File} names the file, which is only a name here, and says why there are
  /// none.
  static Samples parse(std::string_view bytes, const std::string& name,
                       std::pmr::memory_resource* memory = std::pmr::get_default_resource(), const Poll& poll = {});
  /// `values` are frames of `channels` samples, 1 or 2.
  Samples(std::pmr::vector<float> values, std::uint32_t channels, std::uint32_t rate);

  bool empty() const { return values_.empty(); }
  std::uint32_t rate() const { return rate_; }  // frames in a second
  std::size_t frames() const { return values_.size() / channels_; }
  double seconds() const { return rate_ != 0 ? static_cast<double>(frames()) / rate_ : 0; }
  /// A sample between two frames, linearly. 0 <= frame <= frames() - 1
  double at(double frame, std::uint32_t channel) const;

  void save(ByteWriter& out) const;
  static Samples load(ByteReader& in);  // Error{Image}
  void hash(Hasher& hasher) const { hasher.add(digest_); }

 private:
  std::pmr::vector<float> values_;
  std::uint32_t channels_ = 1, rate_ = 0;
  std::uint64_t digest_ = 0;  // of all samples: a world is hashed more often than a file is read
};

/// A sound that plays: since when, and how fast. It ends by itself.
struct Playing {
  double since;  // simulated s
  double speed;  // 1 as recorded
};

/// A sound file, and each time that it was started and has not ended.
class PlayedSound {
 public:
  static constexpr double kMostSpeed = 1000;
  static constexpr std::size_t kMostAtOnce = 32;

  explicit PlayedSound(std::pmr::memory_resource* memory) : samples(memory), playing_(memory) {}
  /// Start it once more. Of more than kMostAtOnce the oldest ends. 0 < speed <= kMostSpeed
  void play(double now, double speed);
  /// Whether something is left to be heard at that time.
  bool sounds_at(double time) const;
  void stop() { playing_.clear(); }
  /// Add what is heard to frames of two samples.
  void add_to(std::span<float> frames, const Listening& listening) const;

  void save(ByteWriter& out) const;
  void load(ByteReader& in);
  void hash(Hasher& hasher) const;

  Samples samples;

 private:
  bool has_ended(const Playing& one, double time) const;

  std::pmr::vector<Playing> playing_;
};

/// A sine that has sounded since it got a frequency. Its phase goes on when the frequency changes.
class SineTone {
 public:
  static constexpr double kMostFrequency = 1e6;

  /// 0 <= frequency <= kMostFrequency, Hz; 0 is silence
  void set_frequency(double now, double frequency);
  void set_volume(double volume) { volume_ = volume; }      // 0 to 1
  void set_balance(double balance) { balance_ = balance; }  // 0 is left, 1 is right
  double frequency() const { return frequency_; }
  double volume() const { return volume_; }
  double balance() const { return balance_; }
  /// Add what is heard to frames of two samples. Nothing is heard of frequencies that the rate cannot hold.
  void add_to(std::span<float> frames, const Listening& listening) const;

  void save(ByteWriter& out) const;
  void load(ByteReader& in);
  void hash(Hasher& hasher) const;

 private:
  double phase_at(double time) const;

  double frequency_ = 0, volume_ = 1, balance_ = 0.5;
  double since_ = 0, phase_ = 0;  // simulated s, and the phase then in rad
};

}  // namespace breve

// Sounds and tones in images and in the ears of a listener.
#include "runtime/store/sound.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace breve {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kRounding = 1e-6;  // frames: rounding of times must not cost a sound its first or last frame

std::uint64_t digest_of(std::span<const float> values, std::uint32_t channels, std::uint32_t rate) {
  Hasher hasher;
  hasher.add(std::uint64_t{channels});
  hasher.add(std::uint64_t{rate});
  hasher.add(std::string_view(reinterpret_cast<const char*>(values.data()), values.size_bytes()));
  return hasher.value();
}

bool is_finite_from(double value, double least, double most) { return value >= least && value <= most; }

}  // namespace

Samples::Samples(std::pmr::vector<float> values, std::uint32_t channels, std::uint32_t rate)
    : values_(std::move(values)), channels_(channels), rate_(rate), digest_(digest_of(values_, channels, rate)) {}

double Samples::at(double frame, std::uint32_t channel) const {
  const auto first = static_cast<std::size_t>(frame);
  const std::size_t second = std::min(first + 1, frames() - 1);
  const std::uint32_t own = std::min(channel, channels_ - 1);
  const double part = frame - static_cast<double>(first);
  return (1 - part) * values_[first * channels_ + own] + part * values_[second * channels_ + own];
}

void Samples::save(ByteWriter& out) const {
  out.put(channels_);
  out.put(rate_);
  out.put(std::uint64_t{values_.size()});
  out.raw(values_.data(), values_.size() * sizeof(float));
}

Samples Samples::load(ByteReader& in) {
  const auto channels = in.get<std::uint32_t>(), rate = in.get<std::uint32_t>();
  const std::size_t count = in.get_count(sizeof(float));
  if (channels < 1 || channels > 2 || count % channels != 0 || rate > kMostRate) ByteReader::fail();
  if (count == 0) return Samples(in.memory());
  if (rate == 0) ByteReader::fail();
  std::pmr::vector<float> values(count, in.memory());
  in.raw(values.data(), count * sizeof(float));
  for (const float value : values)
    if (!std::isfinite(value)) ByteReader::fail();
  return Samples(std::move(values), channels, rate);
}

// --- sounds ----------------------------------------------------------------------------------------------------------

bool PlayedSound::has_ended(const Playing& one, double time) const {
  return (time - one.since) * one.speed * samples.rate() >= static_cast<double>(samples.frames()) - kRounding;
}

void PlayedSound::play(double now, double speed) {
  std::erase_if(playing_, [&](const Playing& one) { return has_ended(one, now); });
  if (playing_.size() == kMostAtOnce) playing_.erase(playing_.begin());
  playing_.push_back({now, speed});
}

bool PlayedSound::sounds_at(double time) const {
  return std::any_of(playing_.begin(), playing_.end(), [&](const Playing& one) { return !has_ended(one, time); });
}

void PlayedSound::add_to(std::span<float> frames, const Listening& listening) const {
  if (samples.empty()) return;
  const auto last = static_cast<double>(samples.frames() - 1);
  const std::size_t wanted = frames.size() / 2;
  for (const Playing& one : playing_) {
    const double per_second = one.speed * samples.rate();
    const double first = (listening.start - one.since) * per_second, step = per_second / listening.rate;
    // The first frame that lies in the sound; it has not begun before.
    const double silent = first < 0 ? std::ceil(-first / step - kRounding) : 0;
    if (silent >= static_cast<double>(wanted)) continue;
    for (auto i = static_cast<std::size_t>(silent); i < wanted; ++i) {
      const double frame = std::max(0.0, first + static_cast<double>(i) * step);
      if (frame > last + kRounding) break;
      frames[2 * i] += static_cast<float>(samples.at(std::min(frame, last), 0));
      frames[2 * i + 1] += static_cast<float>(samples.at(std::min(frame, last), 1));
    }
  }
}

void PlayedSound::save(ByteWriter& out) const {
  samples.save(out);
  out.put(std::uint64_t{playing_.size()});
  for (const Playing& one : playing_) {
    out.put(one.since);
    out.put(one.speed);
  }
}

void PlayedSound::load(ByteReader& in) {
  samples = Samples::load(in);
  const std::size_t count = in.get_count(2 * sizeof(double));
  if (count > kMostAtOnce) ByteReader::fail();
  playing_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const auto since = in.get<double>(), speed = in.get<double>();
    if (!std::isfinite(since) || !(speed > 0) || speed > kMostSpeed) ByteReader::fail();
    playing_.push_back({since, speed});
  }
}

void PlayedSound::hash(Hasher& hasher) const {
  samples.hash(hasher);
  hasher.add(std::uint64_t{playing_.size()});
  for (const Playing& one : playing_) {
    hasher.add(one.since);
    hasher.add(one.speed);
  }
}

// --- tones -----------------------------------------------------------------------------------------------------------

double SineTone::phase_at(double time) const { return std::fmod(phase_ + kTurn * frequency_ * (time - since_), kTurn); }

void SineTone::set_frequency(double now, double frequency) {
  phase_ = phase_at(now);
  since_ = now;
  frequency_ = frequency;
}

void SineTone::add_to(std::span<float> frames, const Listening& listening) const {
  if (!(frequency_ > 0) || !(volume_ > 0) || frequency_ >= listening.rate / 2) return;
  // In the middle both sides have the full volume.
  const double left = volume_ * std::min(1.0, 2 * (1 - balance_)), right = volume_ * std::min(1.0, 2 * balance_);
  const double first = phase_at(listening.start), step = kTurn * frequency_ / listening.rate;
  for (std::size_t i = 0; 2 * i + 1 < frames.size(); ++i) {
    const double value = std::sin(first + static_cast<double>(i) * step);
    frames[2 * i] += static_cast<float>(left * value);
    frames[2 * i + 1] += static_cast<float>(right * value);
  }
}

void SineTone::save(ByteWriter& out) const {
  for (const double value : {frequency_, volume_, balance_, since_, phase_}) out.put(value);
}

void SineTone::load(ByteReader& in) {
  for (double* value : {&frequency_, &volume_, &balance_, &since_, &phase_}) *value = in.get<double>();
  if (!is_finite_from(frequency_, 0, kMostFrequency) || !is_finite_from(volume_, 0, 1) ||
      !is_finite_from(balance_, 0, 1) || !std::isfinite(since_) || !is_finite_from(phase_, -kTurn, kTurn))
    ByteReader::fail();
}

void SineTone::hash(Hasher& hasher) const {
  for (const double value : {frequency_, volume_, balance_, since_, phase_}) hasher.add(value);
}

}  // namespace breve

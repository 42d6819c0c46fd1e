// WAV files (Multimedia Programming Interface and Data Specifications 1.0, IBM and Microsoft 1991), written as the run
// goes on.
#include "sound.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace breve::command {

namespace {

constexpr std::uint32_t kRate = 44100, kFrameBytes = 4, kHeaderBytes = 44;
constexpr std::uint64_t kMostFrames = (0xffffffffU - kHeaderBytes) / kFrameBytes;  // of a file: its size has 32 bits

void put(std::vector<std::uint8_t>& bytes, std::uint64_t number, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i) & 255));
}

void put(std::vector<std::uint8_t>& bytes, const char* mark) { bytes.insert(bytes.end(), mark, mark + 4); }

}  // namespace

SoundWriter::SoundWriter(std::string path) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) fail();
  write_header();
}

SoundWriter::~SoundWriter() {
  if (file_) std::fclose(file_);
}

void SoundWriter::listen(breve_world* world) {
  const double now = breve_world_time(world);
  const double until = std::min((now + breve_world_iteration_step(world)) * kRate, static_cast<double>(kMostFrames));
  // Frames that lie before `until`, and were not written yet. Times are sums of steps, and rounding must not add a
  // frame.
  constexpr double kRounding = 1e-6;
  const double end = std::ceil(until - kRounding);
  if (!(end > static_cast<double>(frames_))) return;
  const auto count = static_cast<std::size_t>(end - static_cast<double>(frames_));
  heard_.resize(2 * count);
  if (breve_world_sound(world, static_cast<double>(frames_) / kRate, kRate, heard_.data(), count) != BREVE_OK) {
    const breve_error* error = breve_world_last_error(world);
    throw std::runtime_error(fmt::format("{}: {}", path_, error ? error->message : "no sound"));
  }
  bytes_.clear();
  for (const float sample : heard_)
    put(bytes_, static_cast<std::uint16_t>(std::lround(32767 * std::clamp(sample, -1.0F, 1.0F))), 2);
  write(bytes_.data(), bytes_.size());
  frames_ += count;
}

void SoundWriter::finish() {
  if (std::fseek(file_, 0, SEEK_SET) != 0) fail();
  write_header();
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) fail();
}

void SoundWriter::write_header() {
  bytes_.clear();
  put(bytes_, "RIFF");
  put(bytes_, kHeaderBytes - 8 + frames_ * kFrameBytes, 4);
  put(bytes_, "WAVE");
  put(bytes_, "fmt ");
  put(bytes_, 16, 4);  // bytes of what follows
  put(bytes_, 1, 2);   // plain samples
  put(bytes_, 2, 2);   // channels
  put(bytes_, kRate, 4);
  put(bytes_, kRate * kFrameBytes, 4);
  put(bytes_, kFrameBytes, 2);
  put(bytes_, 16, 2);  // bits of a sample
  put(bytes_, "data");
  put(bytes_, frames_ * kFrameBytes, 4);
  write(bytes_.data(), bytes_.size());
}

void SoundWriter::write(const void* bytes, std::size_t size) {
  if (std::fwrite(bytes, 1, size, file_) != size) fail();
}

void SoundWriter::fail() const {
  throw std::runtime_error(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
}

}  // namespace breve::command

// The sound of a run, in a WAV file.
#pragma once

#include <breve/sound.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace breve::command {

/// Writes what a world plays, from its beginning on, as samples of 16 bits for two ears.
class SoundWriter {
 public:
  /// @throws std::runtime_error if the file cannot be written
  explicit SoundWriter(std::string path);
  ~SoundWriter();
  SoundWriter(const SoundWriter&) = delete;
  SoundWriter& operator=(const SoundWriter&) = delete;

  /// The world has gone one iteration on, or is at its beginning: what it plays during the next one is written.
  void listen(breve_world* world);  // std::runtime_error
  /// The run is over: the header gets the length.
  void finish();  // std::runtime_error

 private:
  void write(const void* bytes, std::size_t size);
  void write_header();
  [[noreturn]] void fail() const;

  std::string path_;
  std::FILE* file_;
  std::uint64_t frames_ = 0;  // written
  std::vector<float> heard_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace breve::command

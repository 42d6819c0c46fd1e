// Sound files are read by libsndfile, which is seen here and nowhere else. It reads from memory and opens no file.
#include <fmt/format.h>
#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "runtime/base/error.hpp"
#include "runtime/store/sound.hpp"

namespace breve {

namespace {

[[noreturn]] void refuse_sound(const std::string& name, std::string_view why) {
  throw Error(ErrorCode::File, fmt::format("cannot read sound file '{}': {}", name, why));
}

/// Bytes as libsndfile reads them.
struct Source {
  std::string_view bytes;
  std::size_t at = 0;

  static sf_count_t size(void* user) { return static_cast<sf_count_t>(of(user).bytes.size()); }
  static sf_count_t tell(void* user) { return static_cast<sf_count_t>(of(user).at); }
  static sf_count_t seek(sf_count_t offset, int whence, void* user) {
    Source& source = of(user);
    const auto end = static_cast<sf_count_t>(source.bytes.size());
    const sf_count_t base = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? static_cast<sf_count_t>(source.at) : end;
    // Bounded before the sum: a damaged file may ask for any offset.
    const sf_count_t to = std::clamp<sf_count_t>(offset, -base, end - base) + base;
    source.at = static_cast<std::size_t>(to);
    return to;
  }
  static sf_count_t read(void* to, sf_count_t count, void* user) {
    Source& source = of(user);
    const std::size_t got =
        std::min(static_cast<std::size_t>(std::max<sf_count_t>(count, 0)), source.bytes.size() - source.at);
    if (got != 0) std::memcpy(to, source.bytes.data() + source.at, got);
    source.at += got;
    return static_cast<sf_count_t>(got);
  }
  static sf_count_t write(const void*, sf_count_t, void*) { return 0; }
  static Source& of(void* user) { return *static_cast<Source*>(user); }
};

/// A number of four bytes in a file.
std::size_t number_at(std::string_view bytes, std::size_t at, bool little) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < 4; ++i)
    number = number << 8 | static_cast<unsigned char>(bytes[at + (little ? 3 - i : i)]);
  return number;
}

/// libsndfile plays what there is of a file that was cut off. Files that state their size must be as long; those that
/// were written to a pipe state none.
void check_length(std::string_view bytes, const std::string& name) {
  constexpr std::size_t kHead = 12, kUnknown = 0xffffffff;
  if (bytes.size() < kHead) refuse_sound(name, "it is truncated");
  const bool riff = bytes.starts_with("RIFF"), au = bytes.starts_with(".snd");
  if (!riff && !au && !bytes.starts_with("FORM")) return;
  const std::size_t size = number_at(bytes, au ? 8 : 4, riff), begin = au ? number_at(bytes, 4, false) : 8;
  if (size != kUnknown && size + begin > bytes.size()) refuse_sound(name, "it is truncated");
}

void check_format(const SF_INFO& info, const std::string& name) {
  if (info.channels < 1 || info.channels > static_cast<int>(Samples::kMostChannels))
    refuse_sound(name, fmt::format("it has {} channels (must be 1 to {})", info.channels, Samples::kMostChannels));
  if (info.samplerate < 1 || info.samplerate > static_cast<int>(Samples::kMostRate))
    refuse_sound(name,
                 fmt::format("it has {} frames in a second (must be 1 to {})", info.samplerate, Samples::kMostRate));
}

}  // namespace

// Samples are counted as they come: the number of frames that a file states may be anything.
Samples Samples::parse(std::string_view bytes, const std::string& name, std::pmr::memory_resource* memory,
                       const Poll& poll) {
  if (bytes.size() > kMostFileBytes) refuse_sound(name, "it is too large");
  check_length(bytes, name);
  SF_VIRTUAL_IO access{&Source::size, &Source::seek, &Source::read, &Source::write, &Source::tell};
  Source source{bytes};
  SF_INFO info{};
  const std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file(sf_open_virtual(&access, SFM_READ, &info, &source), &sf_close);
  if (!file) refuse_sound(name, sf_strerror(nullptr));
  check_format(info, name);

  constexpr sf_count_t kPiece = 4096;  // frames
  constexpr std::size_t kMostSamples = kMostFileBytes;
  const auto in_file = static_cast<std::size_t>(info.channels), kept = std::min<std::size_t>(in_file, 2);
  std::vector<float> piece(kPiece * in_file);
  std::pmr::vector<float> values(memory);
  while (true) {
    const sf_count_t got = sf_readf_float(file.get(), piece.data(), kPiece);
    if (got <= 0) break;
    if (poll) poll();
    if (values.size() > kMostSamples) refuse_sound(name, "it is too long");
    for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i)
      for (std::size_t c = 0; c < kept; ++c) {
        const float value = piece[i * in_file + c];
        values.push_back(std::isfinite(value) ? std::clamp(value, -1.0F, 1.0F) : 0.0F);
      }
  }
  if (sf_error(file.get()) != SF_ERR_NO_ERROR) refuse_sound(name, sf_strerror(file.get()));
  if (values.empty()) refuse_sound(name, "it has no samples");
  if (info.frames > 0 && static_cast<std::size_t>(info.frames) > values.size() / kept)
    refuse_sound(name, "it is truncated");
  return Samples(std::move(values), static_cast<std::uint32_t>(kept), static_cast<std::uint32_t>(info.samplerate));
}

}  // namespace breve

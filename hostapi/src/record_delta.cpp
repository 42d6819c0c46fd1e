// Logs as bytes: numbers, texts, and images as differences to earlier ones.
#include <cstring>
#include <unordered_map>

#include "guard.hpp"
#include "tape.hpp"

namespace breve::host {

void LogWriter::number(std::uint64_t value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }

void LogWriter::text(std::string_view bytes) {
  number(bytes.size());
  bytes_.append(bytes);
}

std::uint64_t LogReader::number() {
  std::uint64_t value = 0;
  if (rest_.size() < sizeof value) {
    failed_ = true;
    rest_ = {};
    return 0;
  }
  std::memcpy(&value, rest_.data(), sizeof value);
  rest_.remove_prefix(sizeof value);
  return value;
}

std::string_view LogReader::text() {
  const std::uint64_t size = number();
  if (size > rest_.size()) {
    failed_ = true;
    rest_ = {};
    return {};
  }
  const std::string_view bytes = rest_.substr(0, static_cast<std::size_t>(size));
  rest_.remove_prefix(bytes.size());
  return bytes;
}

namespace {

constexpr std::size_t kBlock = 32;  // bytes: shorter matches are not worth their two numbers

/// The most that an image may be larger than what it is made of, so that a forged log takes no more memory than that.
std::uint64_t most_bytes(std::string_view base, std::string_view delta) {
  return 64 * (std::uint64_t{base.size()} + delta.size()) + (1U << 20U);
}

std::uint64_t digest(const char* block) {
  std::uint64_t words[kBlock / 8], sum = 0;
  std::memcpy(words, block, kBlock);
  for (const std::uint64_t word : words) sum = (sum ^ word) * 0x9e3779b97f4a7c15U + (sum >> 29U);
  return sum;
}

std::size_t matching(std::string_view a, std::string_view b) {
  const std::size_t most = std::min(a.size(), b.size());
  std::size_t same = 0;
  while (same < most && a[same] == b[same]) ++same;
  return same;
}

/// Finds parts of an image in an earlier one: at the place of the last match, or by the digest of a block.
class Matcher {
 public:
  Matcher(std::string_view base, std::string_view image) : base_(base), image_(image) {
    for (std::size_t at = 0; at + kBlock <= base.size(); at += kBlock) blocks_.emplace(digest(base.data() + at), at);
  }
  /// @param from  set to the place in the earlier image
  /// @return      the length of the match at a place of the image; 0 if there is none
  std::size_t find(std::size_t at, std::size_t& from) {
    const std::size_t straight = at + shift_;  // modulo the word, for negative shifts
    if (straight < base_.size())
      if (const std::size_t size = matching(base_.substr(straight), image_.substr(at)); size >= kBlock) {
        from = straight;
        return size;
      }
    if (at + kBlock > image_.size()) return 0;
    const auto found = blocks_.find(digest(image_.data() + at));
    if (found == blocks_.end()) return 0;
    const std::size_t size = matching(base_.substr(found->second), image_.substr(at));
    if (size < kBlock) return 0;
    from = found->second;
    shift_ = from - at;
    return size;
  }

 private:
  const std::string_view base_, image_;
  std::unordered_map<std::uint64_t, std::size_t> blocks_;
  std::size_t shift_ = 0;
};

std::string whole(std::string_view image) {
  LogWriter out;
  out.number(image.size());
  out.text(image);
  return out.bytes();
}

}  // namespace

std::string delta_of(std::string_view base, std::string_view image) {
  LogWriter out;
  out.number(image.size());
  Matcher matcher(base, image);
  std::size_t literal = 0, from = 0;  // where the bytes begin that are in no match
  for (std::size_t at = 0; at < image.size();) {
    const std::size_t size = matcher.find(at, from);
    if (size == 0) {
      ++at;
      continue;
    }
    out.text(image.substr(literal, at - literal));
    out.number(from);
    out.number(size);
    literal = at += size;
  }
  out.text(image.substr(literal));
  return image.size() > most_bytes(base, out.bytes()) ? whole(image) : out.bytes();
}

std::string apply_delta(std::string_view base, std::string_view delta) {
  const auto damaged = [] { fail(BREVE_ERROR_IMAGE, "the log has a damaged image"); };
  LogReader in(delta);
  const std::uint64_t size = in.number();
  if (size > most_bytes(base, delta)) damaged();
  std::string image;
  while (!in.failed()) {
    image += in.text();
    if (image.size() == size && in.rest().empty()) return image;
    const std::uint64_t from = in.number(), count = in.number();
    if (from > base.size() || count > base.size() - from || image.size() + count > size) break;
    image += base.substr(static_cast<std::size_t>(from), static_cast<std::size_t>(count));
  }
  damaged();
  return {};
}

}  // namespace breve::host

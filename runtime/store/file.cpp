// Text files on C streams, with every failure reported.
#include "runtime/store/file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "runtime/base/error.hpp"

namespace breve {

struct TextFile::Handle {
  std::FILE* stream;
  explicit Handle(std::FILE* s) : stream(s) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (stream != nullptr) std::fclose(stream);
  }
};

void TextFile::fail(const char* verb, const char* why) const {
  throw Error(ErrorCode::File, fmt::format("cannot {} file '{}': {}", verb, path_, why));
}

TextFile::TextFile(std::string path, Mode mode) : path_(std::move(path)), mode_(mode) {
  static constexpr const char* kModes[] = {"rb", "wb", "ab"};
  const char* verb = mode == Mode::Read ? "read" : "write";
  if (const auto zero = path_.find('\0'); zero != std::string::npos) {
    path_.replace(zero, 1, "\\0");
    fail(verb, "the name contains a zero byte");
  }
  file_ = std::make_unique<Handle>(std::fopen(path_.c_str(), kModes[static_cast<int>(mode)]));
  if (file_->stream == nullptr) fail(verb, std::strerror(errno));
  // A folder can be opened for reading, but every read would fail: say it now.
  struct stat info {};
  if (fstat(fileno(file_->stream), &info) == 0 && S_ISDIR(info.st_mode)) fail(verb, std::strerror(EISDIR));
}

TextFile::~TextFile() = default;
TextFile::TextFile(TextFile&&) noexcept = default;
TextFile& TextFile::operator=(TextFile&&) noexcept = default;

void TextFile::need(Mode mode, const char* verb) const {
  if (!file_) fail(verb, "it is closed");
  if ((mode_ == Mode::Read) != (mode == Mode::Read)) {
    fail(verb, mode_ == Mode::Read ? "it was opened for reading" : "it was opened for writing");
  }
}

std::string TextFile::read_line() {
  need(Mode::Read, "read");
  std::string line;
  for (int c = std::getc(file_->stream); c != '\n'; c = std::getc(file_->stream)) {
    if (c == EOF) {
      if (std::ferror(file_->stream) != 0) fail("read", std::strerror(errno));
      end_ = true;
      return line;
    }
    line.push_back(static_cast<char>(c));
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

std::string TextFile::read_all() {
  need(Mode::Read, "read");
  std::string text;
  char block[65536];
  for (std::size_t got = 1; got != 0;) {
    got = std::fread(block, 1, sizeof block, file_->stream);
    text.append(block, got);
  }
  if (std::ferror(file_->stream) != 0) fail("read", std::strerror(errno));
  end_ = true;
  return text;
}

void TextFile::write(std::string_view text) {
  need(Mode::Write, "write");
  if (std::fwrite(text.data(), 1, text.size(), file_->stream) != text.size()) fail("write", std::strerror(errno));
}

void TextFile::close() {
  if (!file_) return;
  const auto file = std::move(file_);
  if (std::fclose(std::exchange(file->stream, nullptr)) != 0) fail("close", std::strerror(errno));
}

}  // namespace breve

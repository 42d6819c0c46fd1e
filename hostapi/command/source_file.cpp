// Source files by zlib, which passes plain files through as they are.
#include "source_file.hpp"

#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace breve::command {

namespace {

// Nobody writes a source file of this size; a small file that unpacks to more is an attack or a mistake.
constexpr std::size_t kLargestSource = std::size_t{256} << 20;

struct Close {
  void operator()(gzFile_s* file) const { gzclose_r(file); }
};

}  // namespace

std::string read_source(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& why) {
    throw std::runtime_error("cannot read " + path.string() + ": " + why);
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail("it is a directory");
  errno = 0;
  const std::unique_ptr<gzFile_s, Close> file(gzopen(path.c_str(), "rb"));
  if (!file) fail(errno != 0 ? std::strerror(errno) : "out of memory");
  std::string text;
  std::array<char, 1 << 16> chunk;
  for (;;) {
    const int size = gzread(file.get(), chunk.data(), static_cast<unsigned>(chunk.size()));
    int error = Z_OK;
    const char* message = gzerror(file.get(), &error);
    if (size < 0 || error == Z_BUF_ERROR) fail(error == Z_ERRNO ? std::strerror(errno) : message);
    if (size == 0) return text;
    text.append(chunk.data(), static_cast<std::size_t>(size));
    if (text.size() > kLargestSource) fail("it is larger than 256 MiB");
  }
}

}  // namespace breve::command

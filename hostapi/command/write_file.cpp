// A file of bytes that is written as a whole.
#include "write_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace breve::command {

namespace {

[[noreturn]] void fail(const std::string& path, int reason) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", path, std::strerror(reason)));
}

}  // namespace

void write_file(const std::string& path, std::span<const std::uint8_t> bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) fail(path, errno);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int why = errno;
  if (std::fclose(file) == 0 && written) return;
  const int reason = written ? errno : why;
  std::error_code nothing;
  if (std::filesystem::is_regular_file(path, nothing)) std::filesystem::remove(path, nothing);
  fail(path, reason);
}

}  // namespace breve::command

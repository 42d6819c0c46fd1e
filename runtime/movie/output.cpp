// Bytes in memory and on disk.
#include "runtime/movie/output.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "runtime/base/error.hpp"

namespace breve::movie {

void MemoryOutput::write(std::uint64_t position, std::span<const std::uint8_t> bytes) {
  if (bytes_.size() < position + bytes.size()) bytes_.resize(position + bytes.size());
  std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(position));
}

std::size_t MemoryOutput::read(std::uint64_t position, std::span<std::uint8_t> bytes) {
  if (position >= bytes_.size()) return 0;
  const std::size_t count = std::min<std::size_t>(bytes.size(), bytes_.size() - position);
  std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(position), count, bytes.begin());
  return count;
}

FileOutput::FileOutput(std::string path) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "w+b")) {
  if (!file_) file_ = std::fopen(path_.c_str(), "wb");  // of devices and pipes nothing can be read
  if (!file_) fail(errno);
}

FileOutput::~FileOutput() {
  if (!file_) return;
  std::fclose(file_);
  remove_file();
}

/// Devices and pipes stay.
void FileOutput::remove_file() const {
  std::error_code nothing;
  if (std::filesystem::is_regular_file(path_, nothing)) std::filesystem::remove(path_, nothing);
}

void FileOutput::fail(int reason) const {
  throw Error(ErrorCode::File, "cannot write " + path_ + ": " + std::strerror(reason));
}

void FileOutput::write(std::uint64_t position, std::span<const std::uint8_t> bytes) {
  if (std::fseek(file_, static_cast<long>(position), SEEK_SET) != 0 && position != size_) fail(errno);
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail(errno);
  size_ = std::max(size_, position + bytes.size());
}

std::size_t FileOutput::read(std::uint64_t position, std::span<std::uint8_t> bytes) {
  if (std::fseek(file_, static_cast<long>(position), SEEK_SET) != 0) fail(errno);
  return std::fread(bytes.data(), 1, bytes.size(), file_);
}

void FileOutput::close() {
  std::FILE* const file = std::exchange(file_, nullptr);
  const bool flushed = std::fflush(file) == 0;
  const int reason = errno;
  if (std::fclose(file) == 0 && flushed) return;
  const int why = flushed ? errno : reason;
  remove_file();
  fail(why);
}

}  // namespace breve::movie

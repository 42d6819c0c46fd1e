// Where the bytes of a movie go. Formats such as MP4 write into what they have written, and read it again.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory_resource>
#include <span>
#include <string>
#include <string_view>

namespace breve::movie {

class Output {
 public:
  virtual ~Output() = default;
  /// @throws Error{File} if they cannot be written
  virtual void write(std::uint64_t position, std::span<const std::uint8_t> bytes) = 0;
  /// As many as there are, up to the size of `bytes`; 0 at the end.
  virtual std::size_t read(std::uint64_t position, std::span<std::uint8_t> bytes) = 0;
  virtual std::uint64_t size() const = 0;
};

class MemoryOutput final : public Output {
 public:
  explicit MemoryOutput(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : bytes_(memory) {}
  void write(std::uint64_t position, std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::uint64_t position, std::span<std::uint8_t> bytes) override;
  std::uint64_t size() const override { return bytes_.size(); }
  std::string_view bytes() const { return bytes_; }

 private:
  std::pmr::string bytes_;
};

/// A file on disk. One that is not closed is removed at the end.
class FileOutput final : public Output {
 public:
  /// @throws Error{File}
  explicit FileOutput(std::string path);
  ~FileOutput() override;
  FileOutput(const FileOutput&) = delete;
  FileOutput& operator=(const FileOutput&) = delete;
  void write(std::uint64_t position, std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::uint64_t position, std::span<std::uint8_t> bytes) override;
  std::uint64_t size() const override { return size_; }
  void close();  // @throws Error{File}

 private:
  [[noreturn]] void fail(int reason) const;
  void remove_file() const;
  std::string path_;
  std::FILE* file_;
  std::uint64_t size_ = 0;
};

}  // namespace breve::movie

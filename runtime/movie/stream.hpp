// An Output as ffmpeg's libraries write to it.
#pragma once

#include <exception>
#include <memory>

#include "runtime/movie/ffmpeg.hpp"
#include "runtime/movie/output.hpp"

namespace breve::movie {

/// One place in the output, where reading or writing goes on.
class Stream {
 public:
  /// @throws std::bad_alloc
  Stream(const Ffmpeg& library, Output& output, bool writes);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  AVIOContext* context() const { return context_; }
  /// Throws what the output has thrown while C code was in between.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  static int read(void* self, std::uint8_t* bytes, int size);
  static int write(void* self, std::uint8_t* bytes, int size);
  static std::int64_t seek(void* self, std::int64_t offset, int whence);

  const Ffmpeg& ff_;
  Output& output_;
  AVIOContext* context_ = nullptr;
  std::uint64_t position_ = 0;
  std::exception_ptr failure_;
};

}  // namespace breve::movie

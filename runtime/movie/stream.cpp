// ffmpeg's libraries are C: what the output throws is kept until they have returned.
#include "runtime/movie/stream.hpp"

#include <new>

namespace breve::movie {

Stream::Stream(const Ffmpeg& library, Output& output, bool writes) : ff_(library), output_(output) {
  constexpr int kBlock = 1 << 16;
  auto* block = static_cast<unsigned char*>(ff_.av_malloc(kBlock));
  if (block) context_ = ff_.avio_alloc_context(block, kBlock, writes ? 1 : 0, this, read, write, seek);
  if (context_) return;
  ff_.av_free(block);
  throw std::bad_alloc();
}

Stream::~Stream() {
  ff_.av_free(context_->buffer);
  ff_.avio_context_free(&context_);
}

int Stream::read(void* self, std::uint8_t* bytes, int size) {
  auto& stream = *static_cast<Stream*>(self);
  try {
    const std::size_t got = stream.output_.read(stream.position_, {bytes, static_cast<std::size_t>(size)});
    stream.position_ += got;
    return got > 0 ? static_cast<int>(got) : AVERROR_EOF;
  } catch (...) {
    stream.failure_ = std::current_exception();
    return AVERROR(EIO);
  }
}

int Stream::write(void* self, std::uint8_t* bytes, int size) {
  auto& stream = *static_cast<Stream*>(self);
  try {
    stream.output_.write(stream.position_, {bytes, static_cast<std::size_t>(size)});
    stream.position_ += static_cast<std::uint64_t>(size);
    return size;
  } catch (...) {
    stream.failure_ = std::current_exception();
    return AVERROR(EIO);
  }
}

std::int64_t Stream::seek(void* self, std::int64_t offset, int whence) {
  auto& stream = *static_cast<Stream*>(self);
  const auto size = static_cast<std::int64_t>(stream.output_.size());
  if (whence == AVSEEK_SIZE) return size;
  const std::int64_t from = whence == SEEK_CUR   ? static_cast<std::int64_t>(stream.position_)
                            : whence == SEEK_END ? size
                                                 : 0;
  if (from + offset < 0) return AVERROR(EINVAL);
  stream.position_ = static_cast<std::uint64_t>(from + offset);
  return from + offset;
}

}  // namespace breve::movie

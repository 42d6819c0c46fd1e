// ffmpeg's libraries, found at run time. They stay loaded until the process ends: encoders have threads of their own.
#include "runtime/movie/ffmpeg.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>

#include "runtime/base/error.hpp"

namespace breve::movie {

namespace {

void* open_library(const char* name, int version) {
  const std::string file = fmt::format("lib{}.so.{}", name, version);
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw Error(ErrorCode::Unsupported, fmt::format("{} is not installed", file));
  return library;
}

void* symbol(void* library, const char* name) {
  void* found = dlsym(library, name);
  if (!found) throw Error(ErrorCode::Unsupported, fmt::format("ffmpeg's libraries have no function {}", name));
  return found;
}

}  // namespace

Ffmpeg::Ffmpeg() {
  void* const avutil = open_library("avutil", LIBAVUTIL_VERSION_MAJOR);
  void* const avcodec = open_library("avcodec", LIBAVCODEC_VERSION_MAJOR);
  void* const avformat = open_library("avformat", LIBAVFORMAT_VERSION_MAJOR);
  void* const swscale = open_library("swscale", LIBSWSCALE_VERSION_MAJOR);
#define BREVE_FFMPEG_LOAD(library, name) name = reinterpret_cast<decltype(name)>(symbol(library, #name));
  BREVE_FFMPEG_FUNCTIONS(BREVE_FFMPEG_LOAD)
#undef BREVE_FFMPEG_LOAD
}

}  // namespace breve::movie

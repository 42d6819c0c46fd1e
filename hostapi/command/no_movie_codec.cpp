// A build without the headers of ffmpeg's libraries.
#include "movie_codec.hpp"

namespace breve::command {

std::unique_ptr<MovieWriter> open_codec_movie(const std::string&, double, std::string& why) {
  why = "this breve was built without ffmpeg's libraries";
  return nullptr;
}

}  // namespace breve::command

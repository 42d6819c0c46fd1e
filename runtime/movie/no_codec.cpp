// A build without the headers of ffmpeg's libraries.
#include "runtime/base/error.hpp"
#include "runtime/movie/codec.hpp"

namespace breve::movie {

std::unique_ptr<Movie> open_codec(const Settings&, Output&) {
  throw Error(ErrorCode::Unsupported, "this breve was built without ffmpeg's libraries (BREVE_WITH_MOVIES)");
}

}  // namespace breve::movie

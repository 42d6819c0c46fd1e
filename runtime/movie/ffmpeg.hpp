// The functions of ffmpeg's libraries that movies need. They are loaded when the first movie is made: linked, they and
// the forty libraries below them would be loaded into each process that links breve.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace breve::movie {

// X(library, function)
#define BREVE_FFMPEG_FUNCTIONS(X)             \
  X(avutil, av_d2q)                           \
  X(avutil, av_frame_alloc)                   \
  X(avutil, av_frame_free)                    \
  X(avutil, av_frame_get_buffer)              \
  X(avutil, av_frame_make_writable)           \
  X(avutil, av_free)                          \
  X(avutil, av_malloc)                        \
  X(avutil, av_log_set_level)                 \
  X(avutil, av_opt_set)                       \
  X(avutil, av_strerror)                      \
  X(avcodec, av_packet_alloc)                 \
  X(avcodec, av_packet_free)                  \
  X(avcodec, av_packet_rescale_ts)            \
  X(avcodec, avcodec_alloc_context3)          \
  X(avcodec, avcodec_find_encoder)            \
  X(avcodec, avcodec_find_encoder_by_name)    \
  X(avcodec, avcodec_free_context)            \
  X(avcodec, avcodec_open2)                   \
  X(avcodec, avcodec_parameters_from_context) \
  X(avcodec, avcodec_receive_packet)          \
  X(avcodec, avcodec_send_frame)              \
  X(avformat, av_guess_format)                \
  X(avformat, av_interleaved_write_frame)     \
  X(avformat, av_write_trailer)               \
  X(avformat, avformat_alloc_output_context2) \
  X(avformat, avformat_free_context)          \
  X(avformat, avformat_new_stream)            \
  X(avformat, avformat_write_header)          \
  X(avformat, avio_alloc_context)             \
  X(avformat, avio_context_free)              \
  X(avformat, avio_flush)                     \
  X(swscale, sws_freeContext)                 \
  X(swscale, sws_getCoefficients)             \
  X(swscale, sws_getContext)                  \
  X(swscale, sws_scale)                       \
  X(swscale, sws_setColorspaceDetails)

struct Ffmpeg {
  /// Loads the libraries of the versions whose headers this file was compiled with.
  /// @throws Error{Unsupported} naming the library or function that is missing
  Ffmpeg();
#define BREVE_FFMPEG_MEMBER(library, function) decltype(&::function) function = nullptr;
  BREVE_FFMPEG_FUNCTIONS(BREVE_FFMPEG_MEMBER)
#undef BREVE_FFMPEG_MEMBER
};

}  // namespace breve::movie

// A picture becomes a frame of the codec's colours, a frame becomes packets, and packets go into the file.
#include "runtime/movie/codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <string_view>

#include "runtime/base/error.hpp"
#include "runtime/movie/stream.hpp"

namespace breve::movie {

namespace {

class CodecMovie final : public Movie {
 public:
  CodecMovie(const Settings& settings, Output& output) : settings_(settings), output_(output) {}
  ~CodecMovie() override {
    if (scaler_) ff_.sws_freeContext(scaler_);
    ff_.av_packet_free(&packet_);
    ff_.av_frame_free(&frame_);
    ff_.avcodec_free_context(&codec_);
    ff_.avformat_free_context(format_);
  }
  CodecMovie(const CodecMovie&) = delete;
  CodecMovie& operator=(const CodecMovie&) = delete;

  /// Everything that can be refused, before anything is written.
  void open() {
    ff_.av_log_set_level(AV_LOG_QUIET);  // what fails is an exception
    const std::string name = "movie." + settings_.format;
    const AVOutputFormat* const kind = ff_.av_guess_format(nullptr, name.c_str(), nullptr);
    if (!kind || kind->video_codec == AV_CODEC_ID_NONE || (kind->flags & AVFMT_NOFILE) || is_of_pictures(*kind))
      throw Error(
          ErrorCode::Argument,
          fmt::format("there is no movie format of that name; .mp4, .mkv, .webm, .avi, .mpeg and .gif are some"));
    check(ff_.avformat_alloc_output_context2(&format_, kind, nullptr, name.c_str()));
    open_codec();
    stream_ = ff_.avformat_new_stream(format_, nullptr);
    frame_ = ff_.av_frame_alloc();
    packet_ = ff_.av_packet_alloc();
    if (!stream_ || !frame_ || !packet_) throw std::bad_alloc();
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = rate_;
    check(ff_.avcodec_parameters_from_context(stream_->codecpar, codec_));
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    check(ff_.av_frame_get_buffer(frame_, 0));
    open_scaler();
  }

  void add(std::span<const std::uint8_t> rgba) override {
    begin();
    check(ff_.av_frame_make_writable(frame_));
    const std::uint8_t* const rows[] = {rgba.data()};
    const int stride[] = {4 * settings_.width};
    ff_.sws_scale(scaler_, rows, stride, 0, settings_.height, frame_->data, frame_->linesize);
    // At another rate than that of the codec some pictures are repeated or left out, so that the movie keeps its pace.
    for (const double due = static_cast<double>(++added_) * pace_; static_cast<double>(number_) < due - 1e-6;) {
      frame_->pts = number_++;
      check(ff_.avcodec_send_frame(codec_, frame_));
      write_packets();
    }
  }
  void finish() override {
    if (number_ == 0) throw Error(ErrorCode::File, "a movie without pictures is not written");
    check(ff_.avcodec_send_frame(codec_, nullptr));
    write_packets();
    check(ff_.av_write_trailer(format_));
    ff_.avio_flush(format_->pb);
    check(format_->pb->error);
  }

 private:
  /// Formats that are one picture, or one picture a file.
  static bool is_of_pictures(const AVOutputFormat& kind) {
    const std::string_view name = kind.name;
    return name.starts_with("image2") || name == "gif" || name == "apng";
  }

  /// The first picture begins the file.
  void begin() {
    if (stream_of_output_) return;
    stream_of_output_.emplace(ff_, output_, true);
    format_->pb = stream_of_output_->context();
    format_->flags |= AVFMT_FLAG_CUSTOM_IO;
    format_->opaque = this;
    format_->io_open = open_again;
    format_->io_close2 = close_again;
    // So that players on the web can begin before they have all of it. Formats without this option ignore it.
    ff_.av_opt_set(format_->priv_data, "movflags", "+faststart", 0);
    check(ff_.avformat_write_header(format_, nullptr));
  }
  /// MP4 moves what it has written, for which it reads it.
  static int open_again(AVFormatContext* format, AVIOContext** context, const char*, int flags, AVDictionary**) {
    auto& movie = *static_cast<CodecMovie*>(format->opaque);
    if (flags & AVIO_FLAG_WRITE) return AVERROR(EACCES);
    try {
      *context = movie.reading_.emplace(movie.ff_, movie.output_, false).context();
      return 0;
    } catch (const std::bad_alloc&) {
      return AVERROR(ENOMEM);
    }
  }
  static int close_again(AVFormatContext* format, AVIOContext*) {
    static_cast<CodecMovie*>(format->opaque)->reading_.reset();
    return 0;
  }

  void open_scaler() {
    scaler_ = ff_.sws_getContext(settings_.width, settings_.height, AV_PIX_FMT_RGBA, codec_->width, codec_->height,
                                 codec_->pix_fmt, SWS_BICUBIC, nullptr, nullptr, nullptr);
    if (!scaler_) fail("pictures of this size cannot be converted");
    constexpr int kOne = 1 << 16;
    ff_.sws_setColorspaceDetails(scaler_, ff_.sws_getCoefficients(SWS_CS_DEFAULT), 1,
                                 ff_.sws_getCoefficients(SWS_CS_ITU709), 0, 0, kOne, kOne);
  }

  /// The first encoder that works: which are there depends on how the libraries were built.
  void open_codec() {
    const AVCodecID usual = format_->oformat->video_codec;
    const bool h264 = usual == AV_CODEC_ID_H264 || usual == AV_CODEC_ID_MPEG4;
    const std::array<const AVCodec*, 4> candidates{h264 ? ff_.avcodec_find_encoder_by_name("libx264") : nullptr,
                                                   h264 ? ff_.avcodec_find_encoder_by_name("libopenh264") : nullptr,
                                                   ff_.avcodec_find_encoder(usual),
                                                   h264 ? ff_.avcodec_find_encoder(AV_CODEC_ID_MPEG4) : nullptr};
    int error = AVERROR_ENCODER_NOT_FOUND;
    for (const AVCodec* candidate : candidates) {
      if (!candidate) continue;
      configure(candidate);
      error = ff_.avcodec_open2(codec_, candidate, nullptr);
      if (error >= 0) return;
      ff_.avcodec_free_context(&codec_);
    }
    throw Error(ErrorCode::Unsupported,
                fmt::format("no codec for movies of this kind works here ({}); .gif needs none", text_of(error)));
  }

  /// MPEG-1 and 2 have a few rates only; those below 23 a second are of the libraries alone, and no player has to know
  /// them.
  AVRational rate_of(const AVCodec& codec) {
    AVRational rate = ff_.av_d2q(settings_.fps, 1'000'000);
    pace_ = 1;
    if (!codec.supported_framerates) return rate;
    constexpr double kLeast = 23;
    double nearest = std::numeric_limits<double>::infinity();
    for (const AVRational* one = codec.supported_framerates; one->num != 0; ++one) {
      const double fps = av_q2d(*one), away = std::abs(fps - settings_.fps);
      if (fps < kLeast || away >= nearest) continue;
      nearest = away;
      rate = *one;
    }
    pace_ = av_q2d(rate) / settings_.fps;
    return rate;
  }

  void configure(const AVCodec* codec) {
    codec_ = ff_.avcodec_alloc_context3(codec);
    if (!codec_) throw std::bad_alloc();
    // Colours are kept for every second pixel, so sides are even.
    codec_->width = std::max(2, settings_.width & ~1);
    codec_->height = std::max(2, settings_.height & ~1);
    codec_->pix_fmt = codec->pix_fmts ? codec->pix_fmts[0] : AV_PIX_FMT_YUV420P;
    for (const AVPixelFormat* one = codec->pix_fmts; one && *one != AV_PIX_FMT_NONE; ++one)
      if (*one == AV_PIX_FMT_YUV420P) codec_->pix_fmt = *one;  // what every player shows
    rate_ = rate_of(*codec);
    codec_->time_base = {rate_.den, rate_.num};
    codec_->framerate = rate_;
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
    codec_->bit_rate = std::int64_t{4} * codec_->width * codec_->height;  // of codecs that know no quality
    if (format_->oformat->flags & AVFMT_GLOBALHEADER) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    // Quality in place of a bit rate, as H.264 has it; other codecs have no such option.
    if (ff_.av_opt_set(codec_->priv_data, "crf", "20", 0) >= 0) codec_->bit_rate = 0;
    ff_.av_opt_set(codec_->priv_data, "preset", "fast", 0);
  }

  void write_packets() {
    for (;;) {
      const int status = ff_.avcodec_receive_packet(codec_, packet_);
      if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return;
      check(status);
      packet_->duration = 1;
      ff_.av_packet_rescale_ts(packet_, codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      check(ff_.av_interleaved_write_frame(format_, packet_));
      check(format_->pb->error);
    }
  }

  std::string text_of(int error) const {
    std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
    ff_.av_strerror(error, text.data(), text.size());
    return text.data();
  }
  /// What the output said comes before what the libraries made of it.
  void check(int status) const {
    if (stream_of_output_) stream_of_output_->rethrow();
    if (status == AVERROR(ENOMEM)) throw std::bad_alloc();
    if (status < 0) fail(text_of(status));
  }
  [[noreturn]] static void fail(const std::string& why) {
    throw Error(ErrorCode::File, "the movie cannot be encoded: " + why);
  }

  Ffmpeg ff_;
  Settings settings_;
  Output& output_;
  AVRational rate_{};
  std::optional<Stream> stream_of_output_, reading_;
  AVFormatContext* format_ = nullptr;
  AVStream* stream_ = nullptr;  // the format's
  AVCodecContext* codec_ = nullptr;
  SwsContext* scaler_ = nullptr;
  AVFrame* frame_ = nullptr;
  AVPacket* packet_ = nullptr;
  double pace_ = 1;          // pictures of the movie for one that is added
  std::int64_t added_ = 0;   // pictures
  std::int64_t number_ = 0;  // of the movie's next one
};

}  // namespace

std::unique_ptr<Movie> open_codec(const Settings& settings, Output& output) {
  auto movie = std::make_unique<CodecMovie>(settings, output);
  movie->open();
  return movie;
}

}  // namespace breve::movie

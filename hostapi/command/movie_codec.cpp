// A picture becomes a frame of the codec's colours, a frame becomes packets, and packets go into the file.
#include "movie_codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include "ffmpeg.hpp"

namespace breve::command {

namespace {

class CodecMovie final : public MovieWriter {
 public:
  CodecMovie(std::unique_ptr<Ffmpeg> library, std::string path, double fps)
      : ff_(std::move(library)), path_(std::move(path)), rate_(ff_->av_d2q(fps, 1'000'000)) {}
  ~CodecMovie() override {
    const bool unfinished = format_ && format_->pb;
    close();
    if (unfinished) std::remove(path_.c_str());
  }
  CodecMovie(const CodecMovie&) = delete;
  CodecMovie& operator=(const CodecMovie&) = delete;

  void open() {
    ff_->av_log_set_level(AV_LOG_QUIET);  // what fails is an exception
    if (!ff_->av_guess_format(nullptr, path_.c_str(), nullptr))
      throw std::runtime_error(fmt::format(
          "--movie {}: there is no movie format of that name; .mp4, .mkv, .webm, .avi and .gif are some", path_));
    check(ff_->avformat_alloc_output_context2(&format_, nullptr, nullptr, path_.c_str()));
    if (format_->oformat->video_codec == AV_CODEC_ID_NONE) fail("this format has no pictures");
    check(ff_->avio_open(&format_->pb, path_.c_str(), AVIO_FLAG_WRITE));
  }

  void add(const Frame& picture) override {
    if (!codec_) begin(picture);
    check(ff_->av_frame_make_writable(frame_));
    const std::uint8_t* const rows[] = {picture.rgba.data()};
    const int stride[] = {4 * static_cast<int>(picture.width)};
    ff_->sws_scale(scaler_, rows, stride, 0, static_cast<int>(picture.height), frame_->data, frame_->linesize);
    frame_->pts = number_++;
    check(ff_->avcodec_send_frame(codec_, frame_));
    write_packets();
  }
  void finish() override {
    if (!codec_) fail("the run has no frames");
    check(ff_->avcodec_send_frame(codec_, nullptr));
    write_packets();
    check(ff_->av_write_trailer(format_));
    check(ff_->avio_closep(&format_->pb));
  }

 private:
  void begin(const Frame& picture) {
    open_codec(picture);
    stream_ = ff_->avformat_new_stream(format_, nullptr);
    frame_ = ff_->av_frame_alloc();
    packet_ = ff_->av_packet_alloc();
    if (!stream_ || !frame_ || !packet_) fail("there is no memory for it");
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = rate_;
    check(ff_->avcodec_parameters_from_context(stream_->codecpar, codec_));
    // So that players on the web can begin before they have all of it. Formats without this option ignore it.
    ff_->av_opt_set(format_->priv_data, "movflags", "+faststart", 0);
    check(ff_->avformat_write_header(format_, nullptr));
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    check(ff_->av_frame_get_buffer(frame_, 0));
    scaler_ =
        ff_->sws_getContext(static_cast<int>(picture.width), static_cast<int>(picture.height), AV_PIX_FMT_RGBA,
                            codec_->width, codec_->height, codec_->pix_fmt, SWS_BICUBIC, nullptr, nullptr, nullptr);
    if (!scaler_) fail("pictures of this size cannot be converted");
    constexpr int kOne = 1 << 16;
    ff_->sws_setColorspaceDetails(scaler_, ff_->sws_getCoefficients(SWS_CS_DEFAULT), 1,
                                  ff_->sws_getCoefficients(SWS_CS_ITU709), 0, 0, kOne, kOne);
  }

  /// The first encoder that works: which are there depends on how the libraries were built.
  void open_codec(const Frame& picture) {
    const AVCodecID usual = format_->oformat->video_codec;
    const bool h264 = usual == AV_CODEC_ID_H264 || usual == AV_CODEC_ID_MPEG4;
    const std::array<const AVCodec*, 4> candidates{h264 ? ff_->avcodec_find_encoder_by_name("libx264") : nullptr,
                                                   h264 ? ff_->avcodec_find_encoder_by_name("libopenh264") : nullptr,
                                                   ff_->avcodec_find_encoder(usual),
                                                   h264 ? ff_->avcodec_find_encoder(AV_CODEC_ID_MPEG4) : nullptr};
    int error = AVERROR_ENCODER_NOT_FOUND;
    for (const AVCodec* candidate : candidates) {
      if (!candidate) continue;
      configure(candidate, picture);
      error = ff_->avcodec_open2(codec_, candidate, nullptr);
      if (error >= 0) return;
      ff_->avcodec_free_context(&codec_);
    }
    fail(fmt::format("no codec for movies of this kind works here ({}); .gif needs none", text_of(error)));
  }

  void configure(const AVCodec* codec, const Frame& picture) {
    codec_ = ff_->avcodec_alloc_context3(codec);
    if (!codec_) fail("there is no memory for it");
    // Colours are kept for every second pixel, so sides are even.
    codec_->width = std::max(2, static_cast<int>(picture.width & ~1U));
    codec_->height = std::max(2, static_cast<int>(picture.height & ~1U));
    codec_->pix_fmt = codec->pix_fmts ? codec->pix_fmts[0] : AV_PIX_FMT_YUV420P;
    for (const AVPixelFormat* one = codec->pix_fmts; one && *one != AV_PIX_FMT_NONE; ++one)
      if (*one == AV_PIX_FMT_YUV420P) codec_->pix_fmt = *one;  // what every player shows
    codec_->time_base = {rate_.den, rate_.num};
    codec_->framerate = rate_;
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
    codec_->bit_rate = std::int64_t{4} * codec_->width * codec_->height;  // of codecs that know no quality
    if (format_->oformat->flags & AVFMT_GLOBALHEADER) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    // Quality in place of a bit rate, as H.264 has it; other codecs have no such option.
    if (ff_->av_opt_set(codec_->priv_data, "crf", "20", 0) >= 0) codec_->bit_rate = 0;
    ff_->av_opt_set(codec_->priv_data, "preset", "fast", 0);
  }

  void write_packets() {
    for (;;) {
      const int status = ff_->avcodec_receive_packet(codec_, packet_);
      if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return;
      check(status);
      packet_->duration = 1;
      ff_->av_packet_rescale_ts(packet_, codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      check(ff_->av_interleaved_write_frame(format_, packet_));
      if (format_->pb->error < 0) check(format_->pb->error);
    }
  }

  void close() {
    if (scaler_) ff_->sws_freeContext(scaler_);
    ff_->av_packet_free(&packet_);
    ff_->av_frame_free(&frame_);
    ff_->avcodec_free_context(&codec_);
    if (format_ && format_->pb) ff_->avio_closep(&format_->pb);
    ff_->avformat_free_context(format_);
  }

  std::string text_of(int error) const {
    std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
    ff_->av_strerror(error, text.data(), text.size());
    return text.data();
  }
  void check(int status) const {
    if (status < 0) fail(text_of(status));
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error(fmt::format("cannot write {}: {}", path_, why));
  }

  std::unique_ptr<Ffmpeg> ff_;
  std::string path_;
  AVRational rate_;
  AVFormatContext* format_ = nullptr;
  AVStream* stream_ = nullptr;  // the format's
  AVCodecContext* codec_ = nullptr;
  SwsContext* scaler_ = nullptr;
  AVFrame* frame_ = nullptr;
  AVPacket* packet_ = nullptr;
  std::int64_t number_ = 0;  // of the next frame
};

}  // namespace

std::unique_ptr<MovieWriter> open_codec_movie(const std::string& path, double fps, std::string& why) {
  std::unique_ptr<Ffmpeg> library;
  try {
    library = std::make_unique<Ffmpeg>();
  } catch (const std::runtime_error& error) {
    why = error.what();
    return nullptr;
  }
  auto movie = std::make_unique<CodecMovie>(std::move(library), path, fps);
  movie->open();
  return movie;
}

}  // namespace breve::command

#include <cmath>
#include <system_error>

#include "fmt/format.h"
#include "media/animation.h"
#include "media/libav.h"

namespace diaphane::media {
namespace {

namespace fs = std::filesystem;

class Mp4Writer final : public AnimationWriter {
 public:
  Mp4Writer(fs::path path, const AnimationOptions& options)
      : path_(std::move(path)), part_(path_.string() + ".part"), options_(options) {}

  ~Mp4Writer() override {
    std::error_code ignored;
    if (file_opened_) fs::remove(part_, ignored);
  }

  // The file and the first encoder that opens.
  absl::Status open() {
    // What encoders tell of themselves is not this program's to say.
    av_log_set_level(AV_LOG_FATAL);
    for (const char* name : kMp4Encoders) {
      const AVCodec* codec = avcodec_find_encoder_by_name(name);
      if (codec != nullptr && open_encoder(*codec)) return open_file();
    }
    return absl::UnavailableError("libavcodec has no encoder for MP4 that opens");
  }

  absl::Status add(const Picture& frame) override {
    if (absl::Status status = check_frame(frame, options_); !status.ok()) return status;
    const Picture opaque = over(frame, {});
    if (int code = av_frame_make_writable(frame_.get()); code < 0) return failed("frame", code);
    const uint8_t* planes[] = {opaque.rgba.data()};
    const int strides[] = {4 * frame.width_px};
    sws_scale(scaler_.get(), planes, strides, 0, codec_->height, frame_->data, frame_->linesize);
    frame_->pts = count_++;
    return encode(frame_.get());
  }

  absl::Status finish() override {
    if (count_ == 0) return absl::FailedPreconditionError("an animation must have a frame");
    if (absl::Status status = encode(nullptr); !status.ok()) return status;
    if (int code = av_write_trailer(format_.get()); code < 0) return failed("trailer", code);
    format_.reset();
    std::error_code code;
    fs::rename(part_, path_, code);
    if (code) return absl::DataLossError(fmt::format("{}: cannot be written: {}", path_.string(), code.message()));
    file_opened_ = false;
    return absl::OkStatus();
  }

  std::string encoder() const override { return codec_->codec->name; }

 private:
  bool open_encoder(const AVCodec& codec) {
    codec_.reset(avcodec_alloc_context3(&codec));
    if (codec_ == nullptr) return false;
    codec_->width = options_.width_px & ~1;
    codec_->height = options_.height_px & ~1;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->time_base = av_inv_q(av_d2q(options_.frames_per_second, 1 << 16));
    codec_->framerate = av_inv_q(codec_->time_base);
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
    // MP4 keeps the encoder's headers once, not in every packet.
    codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    // Encoders that know no constant quality keep to a rate: a tenth of a bit a pixel at 50, six tenths at 100.
    const double bits = 0.1 * std::pow(6, (options_.quality - 50) / 50.0);
    codec_->bit_rate = static_cast<int64_t>(bits * codec_->width * codec_->height * options_.frames_per_second);
    // x264's scale: 51 is worst, 18 next to lossless.
    av_opt_set_int(codec_->priv_data, "crf", std::lround(51 - 0.33 * options_.quality), 0);
    return avcodec_open2(codec_.get(), &codec, nullptr) >= 0;
  }

  absl::Status open_file() {
    AVFormatContext* format = nullptr;
    if (int code = avformat_alloc_output_context2(&format, nullptr, "mp4", part_.c_str()); code < 0) {
      return failed("container", code);
    }
    format_.reset(format);
    stream_ = avformat_new_stream(format, nullptr);
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
    if (stream_ == nullptr || frame_ == nullptr || packet_ == nullptr) return failed("memory", AVERROR(ENOMEM));
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = codec_->framerate;
    avcodec_parameters_from_context(stream_->codecpar, codec_.get());
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    if (int code = av_frame_get_buffer(frame_.get(), 0); code < 0) return failed("frame", code);
    scaler_.reset(sws_getContext(codec_->width, codec_->height, AV_PIX_FMT_RGBA, codec_->width, codec_->height,
                                 codec_->pix_fmt, SWS_BICUBIC, nullptr, nullptr, nullptr));
    if (scaler_ == nullptr) return failed("scaler", AVERROR(EINVAL));
    const int* to_bt709 = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(scaler_.get(), to_bt709, 1, to_bt709, 0, 0, 1 << 16, 1 << 16);
    if (int code = avio_open(&format->pb, part_.c_str(), AVIO_FLAG_WRITE); code < 0) {
      return absl::DataLossError(fmt::format("{}: cannot be written: {}", part_.string(), reason(code)));
    }
    file_opened_ = true;
    if (int code = avformat_write_header(format, nullptr); code < 0) return failed("header", code);
    return absl::OkStatus();
  }

  // Null tells the encoder that no more come.
  absl::Status encode(const AVFrame* frame) {
    int code = avcodec_send_frame(codec_.get(), frame);
    while (code >= 0) {
      code = avcodec_receive_packet(codec_.get(), packet_.get());
      if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return absl::OkStatus();
      if (code < 0) break;
      packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      code = av_interleaved_write_frame(format_.get(), packet_.get());
    }
    return failed(codec_->codec->name, code);
  }

  absl::Status failed(const char* what, int code) const {
    return absl::InternalError(fmt::format("{}: {}: {}", path_.string(), what, reason(code)));
  }

  static std::string reason(int code) {
    char text[AV_ERROR_MAX_STRING_SIZE] = {};
    av_strerror(code, text, sizeof text);
    return text;
  }

  fs::path path_;
  fs::path part_;
  AnimationOptions options_;
  libav::Codec codec_;
  libav::OutputFile format_;
  libav::Frame frame_;
  libav::Packet packet_;
  libav::Scaler scaler_;
  AVStream* stream_ = nullptr;  // of format_
  bool file_opened_ = false;
  int64_t count_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<AnimationWriter>> open_mp4(const fs::path& path, const AnimationOptions& options) {
  if (absl::Status status = check_animation_options(options); !status.ok()) return status;
  auto writer = std::make_unique<Mp4Writer>(path, options);
  if (absl::Status status = writer->open(); !status.ok()) return status;
  return writer;
}

}  // namespace diaphane::media

#include <utility>

#include "encode/h264.h"
#include "encode/over_black.h"
#include "fmt/format.h"

extern "C" {
#include "libavcodec/avcodec.h"
#include "libavutil/opt.h"
#include "libswscale/swscale.h"
}

namespace diaphane::encode {
namespace {

struct Delete {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

constexpr int kFramesBetweenKeys = 10 * kVideoRate;

absl::Status failed(std::string_view what, int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return absl::InternalError(fmt::format("encoding H.264: {}: {}", what, text));
}

/// Half a second may be spent at once.
void set_rate(AVCodecContext& codec, uint32_t bits_per_second) {
  codec.bit_rate = bits_per_second;
  codec.rc_max_rate = bits_per_second;
  codec.rc_buffer_size = static_cast<int>(bits_per_second / 2);
}

std::unique_ptr<AVCodecContext, Delete> open_codec(const AVCodec& encoder, int width_px, int height_px,
                                                   uint32_t bits_per_second) {
  std::unique_ptr<AVCodecContext, Delete> codec(avcodec_alloc_context3(&encoder));
  if (codec == nullptr) return nullptr;
  codec->width = width_px;
  codec->height = height_px;
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  codec->time_base = {1, kVideoRate};
  codec->framerate = {kVideoRate, 1};
  codec->gop_size = kFramesBetweenKeys;
  codec->max_b_frames = 0;
  codec->thread_count = 1;
  codec->color_range = AVCOL_RANGE_MPEG;
  codec->colorspace = AVCOL_SPC_BT709;
  codec->color_primaries = AVCOL_PRI_BT709;
  codec->color_trc = AVCOL_TRC_IEC61966_2_1;
  set_rate(*codec, bits_per_second);
  // Each encoder takes what it knows of these.
  av_opt_set(codec->priv_data, "preset", encoder.name == std::string_view("h264_nvenc") ? "p1" : "ultrafast", 0);
  av_opt_set(codec->priv_data, "tune", encoder.name == std::string_view("h264_nvenc") ? "ull" : "zerolatency", 0);
  av_opt_set_int(codec->priv_data, "forced-idr", 1, 0);
  av_opt_set_int(codec->priv_data, "delay", 0, 0);
  av_opt_set(codec->priv_data, "rc", "cbr", 0);
  return avcodec_open2(codec.get(), &encoder, nullptr) >= 0 ? std::move(codec) : nullptr;
}

std::unique_ptr<AVCodecContext, Delete> open_any(int width_px, int height_px, uint32_t bits_per_second) {
  // What encoders tell of themselves is not this program's to say.
  av_log_set_level(AV_LOG_FATAL);
  for (const char* name : kH264Encoders) {
    const AVCodec* encoder = avcodec_find_encoder_by_name(name);
    if (encoder == nullptr) continue;
    if (auto codec = open_codec(*encoder, width_px, height_px, bits_per_second); codec != nullptr) return codec;
  }
  return nullptr;
}

}  // namespace

class H264Encoder::Impl {
 public:
  static absl::StatusOr<std::unique_ptr<Impl>> open(const base::Image8& image, uint32_t bits_per_second) {
    auto impl = std::make_unique<Impl>();
    const auto width_px = static_cast<int>(image.width_px), height_px = static_cast<int>(image.height_px);
    impl->codec_ = open_any(width_px, height_px, bits_per_second);
    if (impl->codec_ == nullptr) return absl::UnimplementedError("H.264: libavcodec has no encoder that opens");
    impl->frame_.reset(av_frame_alloc());
    impl->packet_.reset(av_packet_alloc());
    impl->scaler_.reset(sws_getContext(width_px, height_px, AV_PIX_FMT_RGB0, width_px, height_px, AV_PIX_FMT_YUV420P,
                                       SWS_BILINEAR, nullptr, nullptr, nullptr));
    if (impl->frame_ == nullptr || impl->packet_ == nullptr || impl->scaler_ == nullptr) {
      return failed("memory", AVERROR(ENOMEM));
    }
    const int* to_bt709 = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(impl->scaler_.get(), to_bt709, 1, to_bt709, 0, 0, 1 << 16, 1 << 16);
    impl->frame_->format = AV_PIX_FMT_YUV420P;
    impl->frame_->width = width_px;
    impl->frame_->height = height_px;
    if (const int code = av_frame_get_buffer(impl->frame_.get(), 0); code < 0) return failed("frame", code);
    return impl;
  }

  /// Whether the encoder goes on with such frames. Cisco's cannot change its bitrate.
  bool fits(const base::Image8& image, uint32_t bits_per_second) const {
    const bool same_rate = codec_->bit_rate == bits_per_second;
    if (!same_rate && codec_->codec->name == std::string_view("libopenh264")) return false;
    return codec_->width == static_cast<int>(image.width_px) && codec_->height == static_cast<int>(image.height_px);
  }

  absl::StatusOr<H264Frame> encode(const base::Image8& image, const H264Options& options) {
    if (codec_->bit_rate != options.bits_per_second) set_rate(*codec_, options.bits_per_second);
    if (const int code = av_frame_make_writable(frame_.get()); code < 0) return failed("frame", code);
    lay_over_black(image, over_black_);
    const uint8_t* planes[] = {over_black_.data()};
    const int strides[] = {4 * codec_->width};
    sws_scale(scaler_.get(), planes, strides, 0, codec_->height, frame_->data, frame_->linesize);
    frame_->pts = count_++;
    frame_->pict_type = options.key_frame ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
    if (const int code = avcodec_send_frame(codec_.get(), frame_.get()); code < 0) return failed("frame", code);
    if (const int code = avcodec_receive_packet(codec_.get(), packet_.get()); code < 0) return failed("packet", code);
    H264Frame out{std::string(packet_->data, packet_->data + packet_->size), (packet_->flags & AV_PKT_FLAG_KEY) != 0};
    av_packet_unref(packet_.get());
    return out;
  }

 private:
  std::unique_ptr<AVCodecContext, Delete> codec_;
  std::unique_ptr<AVFrame, Delete> frame_;
  std::unique_ptr<AVPacket, Delete> packet_;
  std::unique_ptr<SwsContext, Delete> scaler_;
  std::vector<uint8_t> over_black_;
  int64_t count_ = 0;
};

H264Encoder::H264Encoder() = default;
H264Encoder::~H264Encoder() = default;

absl::StatusOr<H264Frame> H264Encoder::encode(const base::Image8& image, const H264Options& options) {
  if (impl_ == nullptr || !impl_->fits(image, options.bits_per_second)) {
    absl::StatusOr<std::unique_ptr<Impl>> opened = Impl::open(image, options.bits_per_second);
    if (!opened.ok()) return opened.status();
    impl_ = *std::move(opened);
  }
  return impl_->encode(image, options);
}

const std::string& h264_encoder() {
  static const std::string name = [] {
    const auto codec = open_any(320, 240, H264Options().bits_per_second);
    return codec == nullptr ? std::string() : std::string(codec->codec->name);
  }();
  return name;
}

}  // namespace diaphane::encode

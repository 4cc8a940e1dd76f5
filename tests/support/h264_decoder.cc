#include "tests/support/h264_decoder.h"

#include <string>

extern "C" {
#include "libavcodec/avcodec.h"
#include "libavutil/log.h"
}

namespace diaphane::testing_support {

class H264Decoder::Impl {
 public:
  Impl() {
    av_log_set_level(AV_LOG_FATAL);
    const AVCodec* decoder = avcodec_find_decoder(AV_CODEC_ID_H264);
    codec_ = avcodec_alloc_context3(decoder);
    codec_->thread_count = 1;
    codec_->flags |= AV_CODEC_FLAG_LOW_DELAY;
    codec_->err_recognition = AV_EF_EXPLODE | AV_EF_CRCCHECK | AV_EF_BITSTREAM;
    avcodec_open2(codec_, decoder, nullptr);
    frame_ = av_frame_alloc();
    packet_ = av_packet_alloc();
  }
  ~Impl() {
    av_packet_free(&packet_);
    av_frame_free(&frame_);
    avcodec_free_context(&codec_);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::optional<DecodedFrame> decode(std::string_view access_unit) {
    std::string padded(access_unit);
    padded.resize(padded.size() + AV_INPUT_BUFFER_PADDING_SIZE);
    packet_->data = reinterpret_cast<uint8_t*>(padded.data());
    packet_->size = static_cast<int>(access_unit.size());
    if (avcodec_send_packet(codec_, packet_) < 0 || avcodec_receive_frame(codec_, frame_) < 0) return std::nullopt;
    if (frame_->decode_error_flags != 0) return std::nullopt;
    double sum = 0;
    for (int y = 0; y < frame_->height; ++y) {
      for (int x = 0; x < frame_->width; ++x) sum += frame_->data[0][y * frame_->linesize[0] + x];
    }
    return DecodedFrame{frame_->width, frame_->height, frame_->key_frame != 0,
                        sum / (static_cast<double>(frame_->width) * frame_->height)};
  }

 private:
  AVCodecContext* codec_ = nullptr;
  AVFrame* frame_ = nullptr;
  AVPacket* packet_ = nullptr;
};

H264Decoder::H264Decoder() : impl_(std::make_unique<Impl>()) {}
H264Decoder::~H264Decoder() = default;
std::optional<DecodedFrame> H264Decoder::decode(std::string_view access_unit) { return impl_->decode(access_unit); }

}  // namespace diaphane::testing_support

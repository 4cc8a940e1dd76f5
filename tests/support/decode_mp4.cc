#include "media/libav.h"
#include "tests/support/decoders.h"

namespace diaphane::testing_support {
namespace {

using media::libav::Codec;
using media::libav::Frame;
using media::libav::Packet;

struct CloseInput {
  void operator()(AVFormatContext* input) const { avformat_close_input(&input); }
};
using InputFile = std::unique_ptr<AVFormatContext, CloseInput>;

// Takes what the decoder has ready.
void take_frames(AVCodecContext* codec, AVFrame* frame, Animation* animation) {
  while (avcodec_receive_frame(codec, frame) >= 0) {
    double sum = 0;
    for (int y = 0; y < frame->height; ++y) {
      for (int x = 0; x < frame->width; ++x) sum += frame->data[0][y * frame->linesize[0] + x];
    }
    animation->mean.push_back(sum / (static_cast<double>(frame->width) * frame->height));
  }
}

}  // namespace

std::optional<Animation> decode_mp4(const std::filesystem::path& path) {
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, path.c_str(), nullptr, nullptr) < 0) return std::nullopt;
  const InputFile input(opened);
  if (avformat_find_stream_info(opened, nullptr) < 0) return std::nullopt;
  const AVCodec* decoder = nullptr;
  const int stream = av_find_best_stream(opened, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
  if (stream < 0) return std::nullopt;
  const Codec codec(avcodec_alloc_context3(decoder));
  if (avcodec_parameters_to_context(codec.get(), opened->streams[stream]->codecpar) < 0 ||
      avcodec_open2(codec.get(), decoder, nullptr) < 0) {
    return std::nullopt;
  }
  Animation animation{codec->width, codec->height, {}};
  const Frame frame(av_frame_alloc());
  const Packet packet(av_packet_alloc());
  while (av_read_frame(opened, packet.get()) >= 0) {
    if (packet->stream_index == stream) avcodec_send_packet(codec.get(), packet.get());
    av_packet_unref(packet.get());
    take_frames(codec.get(), frame.get(), &animation);
  }
  avcodec_send_packet(codec.get(), nullptr);
  take_frames(codec.get(), frame.get(), &animation);
  return animation;
}

}  // namespace diaphane::testing_support

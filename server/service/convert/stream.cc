#include "service/convert/stream.h"

#include <utility>

#include "base/status.h"
#include "encode/h264.h"
#include "fmt/format.h"
#include "service/convert/check.h"
#include "service/convert/frame.h"

namespace diaphane::service {

namespace {

absl::Status check_video(const session::FrameTask& task) {
  if (encode::h264_encoder().empty())
    return absl::UnimplementedError("moving.format: this server has no H.264 encoder");
  constexpr uint32_t kSmallest_px = 32, kLargest_px = 4096;  // what encoders take
  for (const auto& [field, side_px] :
       {std::pair("size.width_px", task.request.width_px), std::pair("size.height_px", task.request.height_px)}) {
    if (side_px % 2 == 0 && side_px >= kSmallest_px && side_px <= kLargest_px) continue;
    return base::invalid_field(field, fmt::format("even and {}..{} for H.264", kSmallest_px, kLargest_px), side_px);
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<StreamView> from_proto(const v1::StreamView& message, uint64_t max_pixels) {
  v1::RenderFrameRequest request;
  *request.mutable_camera() = message.camera();
  *request.mutable_size() = message.size();
  *request.mutable_settings() = message.settings();
  *request.mutable_encoding() = message.moving();
  absl::StatusOr<session::FrameTask> task = from_proto(request, max_pixels);
  if (!task.ok()) return task.status();
  if (task->request.settings.technique == render::Technique::kReference) {
    return base::invalid_field("settings.technique", "integral, paper or lambert", "reference");
  }
  if (task->encoding.format == encode::ImageFormat::kExr) {
    return base::invalid_field("moving.format", "PNG, JPEG, WebP or H.264", "EXR");
  }
  if (task->encoding.format == encode::ImageFormat::kH264) {
    if (absl::Status status = check_video(*task); !status.ok()) return status;
  }
  const double rate = message.frames_per_second();
  if (rate != 0) {
    if (absl::Status status = check_range("frames_per_second", rate, 1, 240); !status.ok()) return status;
  }
  const auto bytes = static_cast<double>(message.bytes_per_second());
  if (bytes != 0) {
    if (absl::Status status = check_range("bytes_per_second", bytes, 1e4, 1e12); !status.ok()) return status;
  }
  return StreamView{
      message.sequence(), *std::move(task), message.lossless_at_rest(), message.min_revision(), {rate, bytes}};
}

}  // namespace diaphane::service

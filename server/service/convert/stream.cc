#include "service/convert/stream.h"

#include <utility>

#include "base/status.h"
#include "service/convert/check.h"
#include "service/convert/frame.h"

namespace diaphane::service {

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
    return base::invalid_field("moving.format", "PNG or JPEG", "EXR");
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

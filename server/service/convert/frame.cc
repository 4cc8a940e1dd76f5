#include "service/convert/frame.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "glm/geometric.hpp"
#include "service/convert/check.h"
#include "service/convert/picture.h"

namespace diaphane::service {
namespace {

constexpr uint32_t kLargestSide_px = 8192;
constexpr double kSmallestDistance = 1e-12;
constexpr double kSmallestSine = 3e-4;  // of the angle between view and up: 0.02 degrees

std::string show(const v1::Vec3& v) { return fmt::format("{},{},{}", v.x(), v.y(), v.z()); }

absl::StatusOr<render::Technique> from_proto(v1::Technique technique) {
  switch (technique) {
    case v1::TECHNIQUE_UNSPECIFIED:
    case v1::TECHNIQUE_INTEGRAL:
      return render::Technique::kIntegral;
    case v1::TECHNIQUE_REFERENCE:
      return render::Technique::kReference;
    case v1::TECHNIQUE_PAPER:
      return render::Technique::kPaper;
    case v1::TECHNIQUE_LAMBERT:
      return render::Technique::kLambert;
    default:
      return unknown_value("settings.technique", technique);
  }
}

absl::StatusOr<diffusion::Quality> from_proto(v1::Quality quality) {
  switch (quality) {
    case v1::QUALITY_DRAFT:
      return diffusion::Quality::kDraft;
    case v1::QUALITY_UNSPECIFIED:
    case v1::QUALITY_NORMAL:
      return diffusion::Quality::kNormal;
    case v1::QUALITY_FINE:
      return diffusion::Quality::kFine;
    default:
      return unknown_value("settings.quality", quality);
  }
}

absl::StatusOr<std::optional<bool>> from_proto(v1::Shadows shadows) {
  switch (shadows) {
    case v1::SHADOWS_UNSPECIFIED:
      return std::optional<bool>();
    case v1::SHADOWS_OFF:
      return std::optional<bool>(false);
    case v1::SHADOWS_ON:
      return std::optional<bool>(true);
    default:
      return unknown_value("settings.shadows", shadows);
  }
}

absl::StatusOr<render::Channel> channel_from_proto(v1::Channel channel, std::string_view field) {
  switch (channel) {
    case v1::CHANNEL_IRRADIANCE:
      return render::Channel::kIrradiance;
    case v1::CHANNEL_RADIOSITY:
      return render::Channel::kRadiosity;
    case v1::CHANNEL_NORMAL:
      return render::Channel::kNormal;
    case v1::CHANNEL_DEPTH:
      return render::Channel::kDepth;
    case v1::CHANNEL_POSITION:
      return render::Channel::kPosition;
    default:
      return unknown_value(field, channel);
  }
}

absl::StatusOr<render::Terms> from_proto(v1::Terms terms) {
  switch (terms) {
    case v1::TERMS_UNSPECIFIED:
    case v1::TERMS_BOTH:
      return render::Terms::kBoth;
    case v1::TERMS_LOCAL:
      return render::Terms::kLocal;
    case v1::TERMS_GLOBAL:
      return render::Terms::kGlobal;
    default:
      return unknown_value("settings.paper.terms", terms);
  }
}

absl::StatusOr<render::PaperSettings> from_proto(const v1::PaperSettings& message) {
  render::PaperSettings settings;
  const absl::StatusOr<render::Terms> terms = from_proto(message.terms());
  if (!terms.ok()) return terms.status();
  settings.terms = *terms;
  if (message.kernel_taps() != 0) {
    absl::Status taps = check_range("settings.paper.kernel_taps", message.kernel_taps(), 3, 6);
    if (!taps.ok()) return taps;
    settings.kernel_taps = message.kernel_taps();
  }
  if (message.face_size_px() != 0) {
    absl::Status face = check_range("settings.paper.face_size_px", message.face_size_px(), 16, 2048);
    if (!face.ok()) return face;
    settings.face_size_px = message.face_size_px();
  }
  if (message.has_global_gain()) {
    absl::Status gain = check_range("settings.paper.global_gain", message.global_gain(), 0, 1000);
    if (!gain.ok()) return gain;
    settings.global_gain = message.global_gain();
  }
  return settings;
}

}  // namespace

absl::StatusOr<scene::Camera> from_proto(const v1::Camera& message) {
  const auto eye = position_from_proto(message.eye(), "camera.eye");
  if (!eye.ok()) return eye.status();
  const auto target = position_from_proto(message.target(), "camera.target");
  if (!target.ok()) return target.status();
  const auto up = position_from_proto(message.up(), "camera.up");
  if (!up.ok()) return up.status();
  const glm::dvec3 view = glm::dvec3(*target) - glm::dvec3(*eye);
  const double distance = glm::length(view);
  if (distance < kSmallestDistance) {
    return base::invalid_field("camera.eye", "apart from camera.target", show(message.eye()));
  }
  const double up_length = glm::length(glm::dvec3(*up));
  if (up_length < kSmallestDistance) return base::invalid_field("camera.up", "a direction", show(message.up()));
  const glm::dvec3 up_direction = glm::dvec3(*up) / up_length;
  if (glm::length(glm::cross(view / distance, up_direction)) < kSmallestSine) {
    return base::invalid_field("camera.up", "not parallel to the view", show(message.up()));
  }
  absl::Status fov = check_range("camera.fov_y_deg", message.fov_y_deg(), 1, 170);
  if (!fov.ok()) return fov;
  return scene::Camera{*eye, *target, glm::vec3(up_direction), message.fov_y_deg()};
}

absl::StatusOr<render::RenderSettings> from_proto(const v1::RenderSettings& message) {
  const absl::StatusOr<render::Technique> technique = from_proto(message.technique());
  if (!technique.ok()) return technique.status();
  const absl::StatusOr<diffusion::Quality> quality = from_proto(message.quality());
  if (!quality.ok()) return quality.status();
  const absl::StatusOr<std::optional<bool>> shadows = from_proto(message.shadows());
  if (!shadows.ok()) return shadows.status();
  const absl::StatusOr<render::PaperSettings> paper = from_proto(message.paper());
  if (!paper.ok()) return paper.status();
  render::RenderSettings settings;
  if (absl::Status picture = take_picture_settings(message, settings); !picture.ok()) return picture;
  settings.technique = *technique;
  settings.quality = *quality;
  settings.shadows = *shadows;
  settings.paper = *paper;
  settings.slab_correction = message.slab_correction();
  return settings;
}

absl::StatusOr<encode::Encoding> from_proto(const v1::Encoding& message) {
  encode::Encoding encoding;
  switch (message.format()) {
    case v1::IMAGE_FORMAT_UNSPECIFIED:
    case v1::IMAGE_FORMAT_PNG:
      encoding.format = encode::ImageFormat::kPng;
      break;
    case v1::IMAGE_FORMAT_JPEG:
      encoding.format = encode::ImageFormat::kJpeg;
      break;
    case v1::IMAGE_FORMAT_EXR:
      encoding.format = encode::ImageFormat::kExr;
      break;
    case v1::IMAGE_FORMAT_WEBP:
      encoding.format = encode::ImageFormat::kWebp;
      break;
    case v1::IMAGE_FORMAT_H264:
      encoding.format = encode::ImageFormat::kH264;
      break;
    default:
      return unknown_value("encoding.format", message.format());
  }
  if (message.quality() != 0) {
    absl::Status quality = check_range("encoding.quality", message.quality(), 1, 100);
    if (!quality.ok()) return quality;
    encoding.quality = static_cast<int>(message.quality());
  }
  if (message.bits_per_second() != 0) {
    absl::Status rate = check_range("encoding.bits_per_second", message.bits_per_second(), 1e4, 1e9);
    if (!rate.ok()) return rate;
    encoding.bits_per_second = message.bits_per_second();
  }
  return encoding;
}

absl::StatusOr<std::vector<render::Channel>> channels_from_proto(const v1::Encoding& message) {
  if (message.channels_size() > 0 && message.format() != v1::IMAGE_FORMAT_EXR) {
    return base::invalid_field("encoding.channels", "none, but of IMAGE_FORMAT_EXR",
                               fmt::format("{}", message.channels_size()));
  }
  std::vector<render::Channel> channels;
  for (int i = 0; i < message.channels_size(); ++i) {
    const std::string field = fmt::format("encoding.channels[{}]", i);
    const absl::StatusOr<render::Channel> channel = channel_from_proto(message.channels(i), field);
    if (!channel.ok()) return channel.status();
    if (std::find(channels.begin(), channels.end(), *channel) != channels.end()) {
      return base::invalid_field(field, "given once", v1::Channel_Name(message.channels(i)));
    }
    channels.push_back(*channel);
  }
  return channels;
}

absl::Status check_size(const v1::Size& message, uint64_t max_pixels) {
  absl::Status width = check_range("size.width_px", message.width_px(), 1, kLargestSide_px);
  if (!width.ok()) return width;
  absl::Status height = check_range("size.height_px", message.height_px(), 1, kLargestSide_px);
  if (!height.ok()) return height;
  if (uint64_t{message.width_px()} * message.height_px() <= max_pixels) return absl::OkStatus();
  return base::invalid_field("size", fmt::format("at most {} pixels", max_pixels),
                             fmt::format("{}x{}", message.width_px(), message.height_px()));
}

absl::StatusOr<session::FrameTask> from_proto(const v1::RenderFrameRequest& message, uint64_t max_pixels) {
  const absl::StatusOr<scene::Camera> camera = from_proto(message.camera());
  if (!camera.ok()) return camera.status();
  if (absl::Status size = check_size(message.size(), max_pixels); !size.ok()) return size;
  const absl::StatusOr<render::RenderSettings> settings = from_proto(message.settings());
  if (!settings.ok()) return settings.status();
  if (settings->technique == render::Technique::kReference) {
    absl::Status size = check_size(message.size(), std::min(max_pixels, kMaxReferencePixels / settings->samples));
    if (!size.ok()) return size;
  }
  const absl::StatusOr<encode::Encoding> encoding = from_proto(message.encoding());
  if (!encoding.ok()) return encoding.status();
  absl::StatusOr<std::vector<render::Channel>> channels = channels_from_proto(message.encoding());
  if (!channels.ok()) return channels.status();
  if (!channels->empty()) {
    // Seventeen values a pixel at most, where max_pixels speaks of four.
    absl::Status size = check_size(message.size(), max_pixels / 4);
    if (!size.ok()) return size;
  }
  session::FrameTask task;
  task.request.channels = *std::move(channels);
  task.request.camera = *camera;
  task.request.width_px = message.size().width_px();
  task.request.height_px = message.size().height_px();
  task.request.settings = *settings;
  task.encoding = *encoding;
  // JPEG has no alpha, nor has H.264: edges that share a pixel with nothing are mixed with its black as light, not as
  // codes.
  const bool opaque = encoding->format == encode::ImageFormat::kJpeg || encoding->format == encode::ImageFormat::kH264;
  if (opaque && settings->samples > 1 && !settings->background && !settings->environment_background) {
    task.request.settings.background = glm::vec3(0);
  }
  return task;
}

void to_proto(session::EncodedFrame frame, v1::RenderFrameResponse& message) {
  message.set_image(std::move(frame.bytes));
  message.set_content_type(std::string(frame.content_type));
  message.set_scene_revision(frame.scene_revision);
  message.mutable_size()->set_width_px(frame.width_px);
  message.mutable_size()->set_height_px(frame.height_px);
  for (const render::StageTime& stage : frame.stages) {
    v1::StageTime& time = *message.add_stages();
    time.set_stage(stage.stage);
    time.set_milliseconds(stage.milliseconds);
    time.set_ran(stage.ran);
  }
  message.set_path(std::move(frame.path));
  message.set_exposure_ev(frame.exposure_ev);
}

}  // namespace diaphane::service

// A frame that somebody asked for, and the frame that came of it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "base/image.h"
#include "diffusion/dipole_integral.h"
#include "glm/vec3.hpp"
#include "scene/camera.h"
#include "scene/snapshot.h"

namespace diaphane::render {

enum class Technique {
  kIntegral,   ///< the dipole over the whole surface
  kPaper,      ///< the two-pass cube map, as published
  kReference,  ///< the dipole by brute force, a pixel at a time: slow
  kLambert     ///< opaque and matt, for comparison
};
enum class Terms { kBoth, kLocal, kGlobal };

struct PaperSettings {
  Terms terms = Terms::kBoth;
  uint32_t kernel_taps = 5;     ///< a side, 3..6
  uint32_t face_size_px = 256;  ///< 16..2048
  float global_gain = 1;        ///< 0..1000
};

/// How radiance becomes what a screen can show.
enum class ToneMapping {
  kNone,    ///< above 1 is cut
  kNeutral  ///< tone_map_neutral()
};

struct RenderSettings {
  Technique technique = Technique::kIntegral;
  diffusion::Quality quality = diffusion::Quality::kNormal;  ///< of the integral
  std::optional<bool> shadows;  ///< not given: on for the integral and the reference, off for the others
  PaperSettings paper;
  float exposure_ev = 0;                          ///< stops; not applied to linear pixels
  bool slab_correction = false;                   ///< of the integral and the reference; see slab_correction.h
  bool auto_exposure = false;                     ///< adds find_exposure_ev() of the frame
  ToneMapping tone_mapping = ToneMapping::kNone;  ///< not applied to linear pixels
  uint32_t samples = 1;                           ///< a pixel, 1..64
  std::optional<glm::vec3> background;            ///< linear colour, 0..1e6, where no surface is; not given: nothing
  bool environment_background = false;            ///< the scene's environment there instead
};

/// Whether 8-bit pixels are made from linear ones, and not by the driver as it stores them.
inline bool needs_developing(const RenderSettings& settings) {
  return settings.samples > 1 || settings.auto_exposure || settings.tone_mapping != ToneMapping::kNone ||
         settings.background.has_value() || settings.environment_background;
}

/// Whether the meshes of a frame hide lights.
inline bool casts_shadows(const RenderSettings& settings) {
  return settings.shadows.value_or(settings.technique == Technique::kIntegral ||
                                   settings.technique == Technique::kReference);
}

/// What linear pixels tell beside R G B A, of the surface that a pixel's centre shows; 0 where it shows none, but for
/// Z.
enum class Channel {
  kIrradiance,  ///< irradiance.R .G .B: E, the light that enters, W·mm⁻²; Fresnel included, except by lambert
  kRadiosity,   ///< radiosity.R .G .B: B, the light that leaves, W·mm⁻²: radiance = Ft·B/π, by lambert B/π
  kNormal,      ///< N.X .Y .Z: unit, scene axes, turned to the eye on the inside of an open surface
  kDepth,       ///< Z: along the view axis from the eye, scene units; +infinity where there is no surface
  kPosition     ///< P.X .Y .Z: scene units and axes
};

enum class PixelFormat {
  kSrgb8,       ///< base::Image8, after exposure
  kLinearFloat  ///< base::ImageF, outgoing radiance in W·mm⁻²·sr⁻¹ times alpha: R G B A, then the channels asked for
};

/// Plain values; the snapshot keeps everything it needs alive.
struct FrameRequest {
  std::shared_ptr<const scene::SceneSnapshot> scene;
  scene::Camera camera;
  uint32_t width_px = 1280;
  uint32_t height_px = 720;
  RenderSettings settings;
  PixelFormat format = PixelFormat::kSrgb8;
  std::vector<Channel> channels;  ///< of linear pixels; each at most once
  /// Told the share of the work done, 0..1, growing, by one thread at a time, while the reference is at work. May be
  /// empty; must be quick.
  std::function<void(double)> progress;
};

struct StageTime {
  std::string stage;
  double milliseconds = 0;
  bool ran = false;  ///< false: inputs unchanged, the stage slept
};

struct Frame {
  std::variant<base::Image8, base::ImageF> image;
  uint64_t scene_revision = 0;
  std::vector<StageTime> stages;
  std::string path;       ///< the code path that made the pixels
  float exposure_ev = 0;  ///< that the picture was multiplied by, in stops; 0 for linear pixels
};

struct RendererInfo {
  std::string gl_renderer;
  std::string gl_vendor;
  std::string gl_version;
  bool software = false;
  std::string reason;  ///< how the context was found, and why this one
};

/// Makes frames. One thread only: the one that made it. Tests put a fake in its place.
class FrameRenderer {
 public:
  virtual ~FrameRenderer() = default;
  /// Errors: FAILED_PRECONDITION no mesh, or no environment for the background; CANCELLED once `cancelled` is seen set;
  /// RESOURCE_EXHAUSTED out of memory.
  virtual absl::StatusOr<Frame> render(const FrameRequest& request, const std::atomic<bool>& cancelled) = 0;
  /// Takes back a frame that nobody needs any more: the next one is made in its memory. Any thread.
  virtual void recycle(Frame /*frame*/) {}
  virtual RendererInfo info() const = 0;
};

}  // namespace diaphane::render

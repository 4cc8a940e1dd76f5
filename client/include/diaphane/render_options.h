// What can be asked of a frame, and what comes back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diaphane/values.h"

namespace diaphane {

enum class Technique {
  kServerDefault = 0,
  kPaper = 1,     ///< the two-pass cube map, as published
  kLambert = 2,   ///< opaque and matt, for comparison
  kIntegral = 3,  ///< the dipole over the whole surface, every frame: the server's default
  kReference = 4  ///< the same by brute force at every pixel: slow
};

/// The techniques that can be asked for by name.
struct NamedTechnique {
  std::string_view name;
  Technique technique;
};
inline constexpr NamedTechnique kTechniques[] = {{"integral", Technique::kIntegral},
                                                 {"paper", Technique::kPaper},
                                                 {"reference", Technique::kReference},
                                                 {"lambert", Technique::kLambert}};

/// Accuracy of the integral against its time.
enum class Quality { kDraft = 1, kNormal = 2, kFine = 3 };

struct NamedQuality {
  std::string_view name;
  Quality quality;
};
inline constexpr NamedQuality kQualities[] = {
    {"draft", Quality::kDraft}, {"normal", Quality::kNormal}, {"fine", Quality::kFine}};

/// Whether meshes hide lights, each other's and their own. The default is on for the integral and the reference, off
/// for paper and lambert.
enum class Shadows { kDefault = 0, kOn = 1, kOff = 2 };

struct NamedShadows {
  std::string_view name;
  Shadows shadows;
};
inline constexpr NamedShadows kShadows[] = {{"on", Shadows::kOn}, {"off", Shadows::kOff}};

/// Which part of the paper technique's answer is shown (its Fig. 9).
enum class Terms { kBoth = 1, kLocal = 2, kGlobal = 3 };

struct NamedTerms {
  std::string_view name;
  Terms terms;
};
inline constexpr NamedTerms kTerms[] = {{"local", Terms::kLocal}, {"global", Terms::kGlobal}, {"both", Terms::kBoth}};

struct PaperSettings {
  Terms terms = Terms::kBoth;
  uint32_t kernel_taps = 5;     ///< a side, 3..6
  uint32_t face_size_px = 256;  ///< edge of a cube face in texels, 16..2048
  float global_gain = 1;        ///< multiplies the global term, 0..1000
};

/// How radiance becomes what a screen can show; never in EXR. Neutral leaves colours up to 0.8 as they are, and
/// compresses brighter ones.
enum class ToneMapping { kNone = 1, kNeutral = 2 };

struct NamedToneMapping {
  std::string_view name;
  ToneMapping tone_mapping;
};
inline constexpr NamedToneMapping kToneMappings[] = {{"none", ToneMapping::kNone}, {"neutral", ToneMapping::kNeutral}};

struct RenderSettings {
  Technique technique = Technique::kServerDefault;
  Quality quality = Quality::kNormal;  ///< of the integral
  Shadows shadows = Shadows::kDefault;
  bool slab_correction = false;  ///< of the integral and the reference: thin parts give back no more than they got
  PaperSettings paper;
  float exposure_ev = 0;       ///< stops, -32..32; multiplies radiance by 2^exposure_ev before sRGB, never in EXR
  bool auto_exposure = false;  ///< finds the exposure by the frame, and adds exposure_ev
  ToneMapping tone_mapping = ToneMapping::kNone;
  uint32_t samples = 1;                 ///< a pixel, 1..64
  std::optional<Rgb> background;        ///< linear, each 0..1e6, where no surface is; not given: nothing, alpha 0
  bool environment_background = false;  ///< the scene's environment there instead, which it must have
};

struct Size {
  uint32_t width_px = 1280;  ///< 1..8192; the product at most ServerInfo::max_pixels
  uint32_t height_px = 720;  ///< 1..8192
};

enum class ImageFormat {
  kPng = 1,   ///< 8-bit sRGB with unassociated alpha, lossless
  kJpeg = 2,  ///< 8-bit sRGB over black
  kExr = 3,   ///< linear outgoing radiance times alpha, W·mm⁻²·sr⁻¹, 32-bit float RGBA
  kWebp = 4,  ///< 8-bit sRGB with alpha, lossy
  kH264 = 5   ///< of streams alone: see StreamView::moving
};

/// What an EXR tells beside its colour, of the surface that each pixel's centre shows, as 32-bit floats. Where a pixel
/// shows none, alpha and all of these are 0, but for depth, which is +infinity.
enum class Channel {
  kIrradiance = 1,  ///< irradiance.R .G .B: the light that enters, W·mm⁻², Fresnel included (except by lambert)
  kRadiosity = 2,  ///< radiosity.R .G .B: the light that leaves, W·mm⁻²: the colour is Ft/π times it, by lambert 1/π
  kNormal = 3,     ///< N.X .Y .Z: unit, in the scene's axes
  kDepth = 4,      ///< Z: along the view axis from the eye, scene units
  kPosition = 5  ///< P.X .Y .Z: scene units
};

struct NamedChannel {
  std::string_view name;
  Channel channel;
};
inline constexpr NamedChannel kChannels[] = {{"irradiance", Channel::kIrradiance},
                                             {"radiosity", Channel::kRadiosity},
                                             {"normal", Channel::kNormal},
                                             {"depth", Channel::kDepth},
                                             {"position", Channel::kPosition}};

struct RenderOptions {
  Camera camera;
  Size size;
  RenderSettings settings;
  ImageFormat format = ImageFormat::kPng;
  uint32_t quality = 90;      ///< of JPEG and WebP, 1..100
  uint64_t min_revision = 0;  ///< FAILED_PRECONDITION where the server's scene has not come so far
  /// Of EXR alone, each at most once; the frame has then at most a quarter of ServerInfo::max_pixels.
  std::vector<Channel> channels;
};

/// What one stage of the server did for a frame.
struct StageTime {
  std::string stage;
  double milliseconds = 0;
  bool ran = false;  ///< false: its inputs had not changed
};

struct RenderedFrame {
  std::string image;         ///< the encoded file's bytes
  std::string content_type;  ///< image/png, image/jpeg, image/x-exr, image/webp or video/h264
  uint64_t scene_revision = 0;
  Size size;
  std::vector<StageTime> stages;
  std::string path;       ///< the code path that made the pixels; the same path makes the same bytes
  float exposure_ev = 0;  ///< stops that the picture was multiplied by, found ones included
};

}  // namespace diaphane

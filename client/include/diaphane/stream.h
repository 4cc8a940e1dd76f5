// Live scenes: frames as they change, and changes as they come.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "diaphane/render_options.h"
#include "diaphane/values.h"

namespace diaphane {

struct MeshHandle;
struct MaterialHandle;
struct LightHandle;

/// What a stream shows.
struct StreamView {
  Camera camera;
  Size size;
  RenderSettings settings;  ///< any technique but kReference
  /// Of frames while scene or view change; not kExr. Of kH264 (even sides of 32..4096) every frame is one access unit,
  /// Annex B, which refers to those before it: the first, and one after a connection was lost, is a key frame.
  ImageFormat moving = ImageFormat::kJpeg;
  uint32_t quality = 80;                 ///< of JPEG and WebP, 1..100
  uint32_t bits_per_second = 4'000'000;  ///< of H.264 at 30 frames a second, 10,000..1e9
  bool lossless_at_rest = true;          ///< a PNG follows once neither has changed for 150 ms
  uint64_t min_revision = 0;             ///< no frame of an older revision comes
  /// 1..240: so many come while things move, no more, and cheaper ones rather than fewer: see
  /// StreamedFrame::reduced. 0: as many as can be drawn.
  float frames_per_second = 0;
  uint64_t bytes_per_second = 0;  ///< 10,000 or more: what they take at most; 0: whatever they take
};

struct StreamOptions {
  StreamView view;
  /// Frames that may be on their way to here at once, 1..64: more hide the way's delay, but wait here for a program
  /// that takes them slowly. 0: each is asked for by next(), and shows what is newest then.
  uint32_t frames_in_flight = 2;
  /// For recording: a frame of every revision, in order. next() fails with RESOURCE_EXHAUSTED when more than 64
  /// revisions wait, and with what broke the connection: nothing is left out in silence. Excludes rates in the view.
  bool every_revision = false;
};

struct StreamedFrame {
  RenderedFrame frame;
  uint64_t view_number = 0;  ///< what set_view() returned, or 1 for the first view
  bool at_rest = false;      ///< the lossless frame
  bool reduced = false;      ///< smaller, coarser or more compressed than asked for, to hold a rate
  bool key_frame = false;    ///< of H.264: it can be decoded by itself
};

/// Frames of a scene as it changes; the newest revision and view win, and what is older and not drawn is passed over.
/// next() is for one thread at a time; the others are for any. A connection that breaks is opened again, for as long as
/// ClientOptions::connect_timeout, with the newest view.
class FrameStream {
 public:
  FrameStream(FrameStream&&) noexcept;
  FrameStream& operator=(FrameStream&&) noexcept;
  ~FrameStream();

  /// Waits for the next frame. Errors: CANCELLED after close(); those of Scene::render; NOT_FOUND the scene is gone.
  absl::StatusOr<StreamedFrame> next();

  /// Shows something else from now on; returns its number. Errors of the view come out of next().
  uint64_t set_view(const StreamView& view);

  /// Has the next frame of H.264 be a key frame, which comes even where nothing changes.
  void request_key_frame();

  /// Ends the stream, and a next() that waits.
  void close();

 private:
  friend class Scene;
  class Impl;
  explicit FrameStream(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

struct DeformerOptions {
  /// Positions go through meshoptimizer's codec: docs/streaming.md has what that saves and costs.
  bool compress = false;
  /// Long positions go to a server of the same user on this machine through memory that both share, not through the
  /// connection: see docs/streaming.md. Nothing else changes, and elsewhere nothing at all.
  bool share_memory = true;
};

/// Live changes of a scene, in order. Calls return once a change is sent, and wait only while too many are not applied;
/// what could not be sent, because the connection broke, is sent again on the next one. Changes between begin() and
/// commit() are applied together, as one revision. One thread at a time.
///
/// Errors, of whichever call meets them first, and of all after it: those of the same change by Scene, with the field
/// "changes[i].…"; UNAVAILABLE the server did not come back within ClientOptions::connect_timeout.
class Deformer {
 public:
  Deformer(Deformer&&) noexcept;
  Deformer& operator=(Deformer&&) noexcept;
  ~Deformer();

  /// Memory for `count` positions of no particular value, in place of a program's own: what is written there and then
  /// given to set_positions() is not copied, where it is of a server that shares memory not at all. Until that call, or
  /// the next of this.
  std::span<Vec3> positions_buffer(size_t count);

  /// New positions of all vertices of a mesh, in mesh units; its normals are computed from now on.
  absl::Status set_positions(const MeshHandle& mesh, std::span<const Vec3> positions);
  /// The same of some: vertex indices[i] to positions[i]. None is no change. INVALID_ARGUMENT, which the calls after it
  /// do not repeat, for counts that differ.
  absl::Status set_positions(const MeshHandle& mesh, std::span<const uint32_t> indices,
                             std::span<const Vec3> positions);
  /// All positions in 16 bits an axis within the box from `lowest` to `highest`: half the bytes, and at most 0.51 steps
  /// of (highest − lowest)/65535 lost. INVALID_ARGUMENT, which the calls after it do not repeat, for a box that is
  /// none, or a position outside it.
  absl::Status set_quantized_positions(const MeshHandle& mesh, std::span<const Vec3> positions, const Vec3& lowest,
                                       const Vec3& highest);
  /// The same of some: vertex indices[i] to positions[i].
  absl::Status set_quantized_positions(const MeshHandle& mesh, std::span<const uint32_t> indices,
                                       std::span<const Vec3> positions, const Vec3& lowest, const Vec3& highest);
  /// The same of all, as displacements from the uploaded positions: where a body deforms smoothly they compress better
  /// than positions, in a box that is no smaller than theirs (docs/streaming.md).
  absl::Status set_quantized_displacements(const MeshHandle& mesh, std::span<const Vec3> displacements,
                                           const Vec3& lowest, const Vec3& highest);
  /// The uploaded positions plus, of each of MeshData::morph_targets, the displacements times a weight.
  absl::Status set_weights(const MeshHandle& mesh, std::span<const float> weights);
  /// The uploaded positions so far on their way to their bounding sphere, 0..1: the paper's morph (§4.5).
  absl::Status morph_to_sphere(const MeshHandle& mesh, float amount);
  absl::Status set_material(const MaterialHandle& handle, const Material& material);
  absl::Status set_light(const LightHandle& handle, const Light& light);

  /// From here on changes are kept, up to 256, and sent by commit().
  void begin();
  absl::Status commit();

  /// Waits until all is applied; the scene's revision then.
  absl::StatusOr<uint64_t> flush();

 private:
  friend class Scene;
  class Impl;
  explicit Deformer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace diaphane

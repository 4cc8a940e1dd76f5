#include <algorithm>
#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "connection.h"
#include "convert.h"
#include "diaphane/scene.h"
#include "diaphane/stream.h"
#include "fmt/format.h"
#include "meshoptimizer.h"
#include "outgoing_edit.h"
#include "quantize.h"
#include "reopening.h"

namespace diaphane {

using internal::to_proto;

namespace {

v1::SceneChange change_of(const MeshHandle& mesh, std::span<const uint32_t> indices) {
  v1::SceneChange change;
  change.mutable_positions()->set_mesh(mesh.name);
  change.mutable_positions()->mutable_indices()->Add(indices.begin(), indices.end());
  return change;
}

absl::Status check_counts(std::span<const uint32_t> indices, std::span<const Vec3> positions) {
  if (indices.size() == positions.size()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      fmt::format("indices: must be one for each of {} positions, got {}", positions.size(), indices.size()));
}

}  // namespace

class Deformer::Impl {
 public:
  Impl(std::shared_ptr<internal::Connection> connection, std::string scene, const DeformerOptions& options)
      : options_(options),
        connection_(std::move(connection)),
        reopening_(connection_->options()),
        scene_(std::move(scene)) {}

  absl::Status add_floats(v1::SceneChange change, std::span<const Vec3> values) {
    v1::VertexPositions& positions = *change.mutable_positions();
    positions.mutable_float32();
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    if (options_.compress && !values.empty()) {
      return add_bytes(std::move(change), compressed(values.data(), values.size(), sizeof(Vec3), positions));
    }
    if (lent_ != nullptr && lent_->bytes.data() == bytes && lent_->bytes.size() == values.size_bytes()) {
      return add_payload(std::move(change), std::exchange(lent_, nullptr), std::nullopt);
    }
    return add_filling(std::move(change), values.size_bytes(),
                       [&](char* to, size_t first, size_t count) { std::memcpy(to, bytes + first, count); });
  }
  absl::Status add_quantized(v1::SceneChange change, std::span<const Vec3> values, const Vec3& lowest,
                             const Vec3& highest) {
    if (absl::Status held = internal::check_in_box(values, lowest, highest); !held.ok()) return held;
    v1::VertexPositions& positions = *change.mutable_positions();
    v1::QuantizedPositions& quantized = *positions.mutable_quantized();
    *quantized.mutable_lowest() = to_proto(lowest);
    *quantized.mutable_highest() = to_proto(highest);
    if (options_.compress && !values.empty()) {
      // The codec's elements are of four bytes or a multiple.
      constexpr size_t kEach = 4 * sizeof(uint16_t);
      steps_.resize(4 * values.size());
      internal::steps_in_box(values, lowest, highest, 4, steps_.data());
      return add_bytes(std::move(change), compressed(steps_.data(), values.size(), kEach, positions));
    }
    constexpr size_t kEach = 3 * sizeof(uint16_t);
    return add_filling(std::move(change), kEach * values.size(), [&](char* to, size_t first, size_t count) {
      internal::steps_in_box(values.subspan(first / kEach, count / kEach), lowest, highest, 3,
                             reinterpret_cast<uint16_t*>(to));
    });
  }

  std::span<Vec3> positions_buffer(size_t count) {
    lent_ = take_memory(count * sizeof(Vec3));
    return {reinterpret_cast<Vec3*>(lent_->bytes.data()), count};
  }

  void begin() { group_.emplace(); }

  absl::Status add(v1::SceneChange change) {
    if (group_.has_value()) {
      *group_->request->mutable_edit()->add_changes() = std::move(change);
      return failed_;
    }
    return send(edit_of(std::move(change)), std::nullopt);
  }

  absl::Status commit() {
    if (!group_.has_value()) return absl::FailedPreconditionError("commit(): must follow begin()");
    return send(*std::exchange(group_, std::nullopt), std::nullopt);
  }

  absl::StatusOr<uint64_t> flush() {
    if (absl::Status applied = wait_until(0); !applied.ok()) return applied;
    return revision_;
  }

 private:
  static constexpr size_t kMostWaiting = 32;
  // Of payloads: edits of any size must not pile up.
  static constexpr size_t kMostWaitingBytes = size_t{64} << 20;

  // Fewer bytes travel with their edit.
  static constexpr size_t kInlineBytes = size_t{64} << 10;

  static internal::OutgoingEdit edit_of(v1::SceneChange change) {
    internal::OutgoingEdit edit;
    *edit.request->mutable_edit()->add_changes() = std::move(change);
    return edit;
  }

  /// `values`, `each` bytes an element, as the codec makes them.
  static std::string compressed(const void* values, size_t count, size_t each, v1::VertexPositions& positions) {
    meshopt_encodeVertexVersion(0);
    std::string bytes(meshopt_encodeVertexBufferBound(count, each), '\0');
    bytes.resize(
        meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), values, count, each));
    positions.set_meshopt_count(static_cast<uint32_t>(count));
    return bytes;
  }

  /// Positions whose bytes are made.
  absl::Status add_bytes(v1::SceneChange change, const std::string& bytes) {
    return add_filling(std::move(change), bytes.size(),
                       [&](char* to, size_t first, size_t count) { std::memcpy(to, bytes.data() + first, count); });
  }

  /// Those whose bytes `fill` makes.
  absl::Status add_filling(v1::SceneChange change, size_t count, internal::FillPayload fill) {
    v1::VertexPositions& positions = *change.mutable_positions();
    if (count <= kInlineBytes) {
      std::string& bytes =
          positions.has_quantized() ? *positions.mutable_quantized()->mutable_uint16() : *positions.mutable_float32();
      bytes.resize(count);
      fill(bytes.data(), 0, count);
      return add(std::move(change));
    }
    return add_payload(std::move(change), take_memory(count), fill);
  }

  internal::PayloadPtr take_memory(size_t count) {
    internal::PayloadPtr payload = call_.has_value() ? call_->take_shared(count) : nullptr;
    return payload != nullptr ? payload : payloads_.take(count);
  }

  /// Those whose bytes are there, or `fill` makes.
  absl::Status add_payload(v1::SceneChange change, internal::PayloadPtr payload,
                           std::optional<internal::FillPayload> fill) {
    internal::announce(*payload, *change.mutable_positions());
    if (group_.has_value()) {
      if (fill.has_value()) (*fill)(payload->bytes.data(), 0, payload->bytes.size());
      group_->payloads.push_back(std::move(payload));
      return add(std::move(change));
    }
    internal::OutgoingEdit edit = edit_of(std::move(change));
    edit.payloads.push_back(std::move(payload));
    return send(std::move(edit), fill);
  }

  absl::Status send(internal::OutgoingEdit edit, std::optional<internal::FillPayload> fill) {
    if (!failed_.ok()) return failed_;
    edit.request->mutable_edit()->set_sequence(++sequence_);
    waiting_.push_back(std::move(edit));
    // What is lost with a call that breaks is written again to the next.
    internal::OutgoingEdit& last = waiting_.back();
    if (call_.has_value()) last.unshare_but_with(*call_);
    if (!call_.has_value()) {
      if (fill.has_value()) (*fill)(last.payloads.front()->bytes.data(), 0, last.payload_bytes());
      open();
    } else if (fill.has_value()) {
      write_filling(*call_, last, *fill);
    } else {
      write(*call_, last);
    }
    return is_full() ? wait_until(waiting_.size() / 2) : absl::OkStatus();
  }

  bool is_full() const {
    size_t bytes = 0;
    for (const internal::OutgoingEdit& edit : waiting_) bytes += edit.payload_bytes();
    return waiting_.size() >= kMostWaiting || bytes >= kMostWaitingBytes;
  }

  /// Reads until at most `most` edits are not known to be applied.
  absl::Status wait_until(size_t most) {
    if (!failed_.ok()) return failed_;
    while (waiting_.size() > most) {
      v1::EditSceneResponse response;
      if (!call_.has_value()) open();
      if (call_->read(&response)) {
        reopening_.succeeded();
        revision_ = response.scene_revision();
        while (!waiting_.empty() && waiting_.front().sequence() <= response.applied()) waiting_.pop_front();
        continue;
      }
      const absl::Status ended = call_->finish();
      call_.reset();
      failed_ = reopening_.wait_after(ended);
      if (!failed_.ok()) return failed_;
    }
    return absl::OkStatus();
  }

  /// And writes all that waits.
  void open() {
    call_.emplace(connection_->channel(), options_.share_memory && connection_->is_local());
    auto request = std::make_shared<v1::EditSceneRequest>();
    request->mutable_opening()->set_scene(scene_);
    request->mutable_opening()->set_editor_id(id_);
    call_->write(request);
    size_t longest = 0;
    for (const internal::OutgoingEdit& waiting : waiting_) longest = std::max(longest, waiting.longest_payload());
    call_->ask_for_shared(longest);
    for (internal::OutgoingEdit& waiting : waiting_) {
      waiting.unshare_but_with(*call_);
      if (!write(*call_, waiting)) return;  // the next read says why
    }
  }

  const DeformerOptions options_;
  const std::shared_ptr<internal::Connection> connection_;
  internal::Reopening reopening_;
  const std::string scene_;
  const std::string id_ = internal::new_request_id();
  uint64_t sequence_ = 0;
  uint64_t revision_ = 0;
  std::deque<internal::OutgoingEdit> waiting_;  // sent, and not known to be applied
  internal::PayloadPool payloads_;
  internal::PayloadPtr lent_;    // by positions_buffer()
  std::vector<uint16_t> steps_;  // before they are compressed
  std::optional<internal::OutgoingEdit> group_;
  absl::Status failed_;
  std::optional<internal::EditCall> call_;
};

Deformer::Deformer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Deformer::Deformer(Deformer&&) noexcept = default;
Deformer& Deformer::operator=(Deformer&&) noexcept = default;
Deformer::~Deformer() = default;

std::span<Vec3> Deformer::positions_buffer(size_t count) { return impl_->positions_buffer(count); }

absl::Status Deformer::set_positions(const MeshHandle& mesh, std::span<const Vec3> positions) {
  return impl_->add_floats(change_of(mesh, {}), positions);
}

absl::Status Deformer::set_positions(const MeshHandle& mesh, std::span<const uint32_t> indices,
                                     std::span<const Vec3> positions) {
  if (absl::Status status = check_counts(indices, positions); !status.ok() || indices.empty()) return status;
  return impl_->add_floats(change_of(mesh, indices), positions);
}

absl::Status Deformer::set_quantized_positions(const MeshHandle& mesh, std::span<const Vec3> positions,
                                               const Vec3& lowest, const Vec3& highest) {
  return impl_->add_quantized(change_of(mesh, {}), positions, lowest, highest);
}

absl::Status Deformer::set_quantized_positions(const MeshHandle& mesh, std::span<const uint32_t> indices,
                                               std::span<const Vec3> positions, const Vec3& lowest,
                                               const Vec3& highest) {
  if (absl::Status status = check_counts(indices, positions); !status.ok() || indices.empty()) return status;
  return impl_->add_quantized(change_of(mesh, indices), positions, lowest, highest);
}

absl::Status Deformer::set_quantized_displacements(const MeshHandle& mesh, std::span<const Vec3> displacements,
                                                   const Vec3& lowest, const Vec3& highest) {
  v1::SceneChange change = change_of(mesh, {});
  change.mutable_positions()->set_displacements(true);
  return impl_->add_quantized(std::move(change), displacements, lowest, highest);
}

absl::Status Deformer::set_weights(const MeshHandle& mesh, std::span<const float> weights) {
  v1::SceneChange change;
  change.mutable_weights()->set_mesh(mesh.name);
  change.mutable_weights()->mutable_weights()->Add(weights.begin(), weights.end());
  return impl_->add(std::move(change));
}

absl::Status Deformer::morph_to_sphere(const MeshHandle& mesh, float amount) {
  v1::SceneChange change;
  change.mutable_sphere()->set_mesh(mesh.name);
  change.mutable_sphere()->set_amount(amount);
  return impl_->add(std::move(change));
}

absl::Status Deformer::set_material(const MaterialHandle& handle, const Material& material) {
  v1::SceneChange change;
  v1::UpdateMaterialRequest& update = *change.mutable_material();
  *update.mutable_material() = to_proto(material);
  update.mutable_material()->set_name(handle.name);
  for (const char* path : {"model", "profile", "coat", "textures"}) update.mutable_update_mask()->add_paths(path);
  return impl_->add(std::move(change));
}

absl::Status Deformer::set_light(const LightHandle& handle, const Light& light) {
  v1::SceneChange change;
  v1::UpdateLightRequest& update = *change.mutable_light();
  *update.mutable_light() = to_proto(light);
  update.mutable_light()->set_name(handle.name);
  update.mutable_update_mask()->add_paths(internal::kind_of(light));
  return impl_->add(std::move(change));
}

void Deformer::begin() { impl_->begin(); }
absl::Status Deformer::commit() { return impl_->commit(); }
absl::StatusOr<uint64_t> Deformer::flush() { return impl_->flush(); }

Deformer Scene::deform(const DeformerOptions& options) const {
  return Deformer(std::make_unique<Deformer::Impl>(connection_, name_, options));
}

}  // namespace diaphane

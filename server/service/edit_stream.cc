#include "service/edit_stream.h"

#include <new>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "service/convert/status.h"

namespace diaphane::service {
namespace {

constexpr size_t kMaxEditorIdBytes = 64;
constexpr size_t kMostPayloadBytes = size_t{1} << 20;

}  // namespace

EditStream::EditStream(scene::SceneStore& store, const session::RenderThread& render_thread, Editors& editors,
                       OpenStreams& open_streams, SharedBufferCount& shared_buffers, std::string_view peer)
    : store_(store),
      render_thread_(render_thread),
      editors_(editors),
      open_streams_(open_streams),
      shared_buffers_(store, shared_buffers, is_on_this_machine(peer)) {
  {
    const absl::MutexLock lock(&link_->mutex);
    link_->stream = this;
  }
  id_ = open_streams_.add([this] {
    const absl::MutexLock lock(&mutex_);
    if (!ending_.has_value()) ending_ = absl::UnavailableError("the server is stopping");
    if (!writing_) acknowledge();
  });
  StartRead(&request_);
}

void EditStream::OnDone() {
  open_streams_.remove(id_);
  {
    // Whoever was here last has let go.
    const absl::MutexLock lock(&mutex_);
  }
  {
    const std::shared_ptr<Link> link = link_;
    const absl::MutexLock lock(&link->mutex);
    link->stream = nullptr;
    link->alarm.reset();
  }
  delete this;
}

void EditStream::OnReadDone(bool ok) {
  const absl::Time begin = absl::Now();
  const absl::Status status = ok ? take(request_) : absl::OkStatus();
  work_ += absl::Now() - begin;
  if (ok && status.ok()) return read_next();
  const absl::MutexLock lock(&mutex_);
  if (!ending_.has_value()) ending_ = status;
  if (!writing_) acknowledge();
}

void EditStream::read_next() {
  if (edit_.has_value()) return StartRead(&request_);
  const absl::Time now = absl::Now();
  const absl::Time due = pace_.after(std::exchange(work_, absl::ZeroDuration()), now, render_thread_.is_busy());
  if (due == now) return StartRead(&request_);
  const absl::MutexLock lock(&link_->mutex);
  // A new one: to set one again would end the function that it runs.
  link_->alarm.emplace();
  link_->alarm->Set(absl::ToChronoTime(due), [link = link_](bool ok) {
    if (!ok) return;
    const absl::MutexLock lock(&link->mutex);
    if (link->stream != nullptr) link->stream->go_on();
  });
}

/// Nothing else keeps a stream from its end meanwhile: once it is finished, reading is too late.
void EditStream::go_on() {
  const absl::MutexLock lock(&mutex_);
  if (!finished_) StartRead(&request_);
}

void EditStream::OnWriteDone(bool ok) {
  const absl::MutexLock lock(&mutex_);
  writing_ = false;
  if (!ok) return finish(absl::CancelledError("the client is gone"));
  acknowledge();
}

void EditStream::OnCancel() {
  const absl::MutexLock lock(&mutex_);
  ending_ = absl::CancelledError("cancelled by the caller");
  if (!writing_) finish(*ending_);
}

absl::Status EditStream::take(const v1::EditSceneRequest& request) {
  if (request.has_opening()) return open(request.opening());
  if (scene_.empty()) return base::invalid_field("part", "an opening first", "none");
  const auto part = request.part_case();
  if (part == v1::EditSceneRequest::PART_NOT_SET) return base::invalid_field("part", "an edit or payload", "nothing");
  const bool is_payload = part == v1::EditSceneRequest::kPayload;
  if (is_payload != edit_.has_value()) {
    const uint64_t bytes = edit_.has_value() ? edit_->reader.bytes_to_come() : 0;
    return base::invalid_field("part", bytes > 0 ? fmt::format("payload, {} more bytes", bytes) : "an edit",
                               is_payload ? "payload" : "something else");
  }
  try {
    if (part == v1::EditSceneRequest::kSharedMemoryBytes) return share(request.shared_memory_bytes());
    return is_payload ? take_payload(request.payload()) : begin(request.edit());
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("out of memory");
  }
}

absl::Status EditStream::open(const v1::EditOpening& opening) {
  if (!scene_.empty()) return base::invalid_field("part", "one opening", "a second");
  if (opening.editor_id().size() > kMaxEditorIdBytes) {
    return base::invalid_field("opening.editor_id", fmt::format("at most {} bytes", kMaxEditorIdBytes),
                               fmt::format("{} bytes", opening.editor_id().size()));
  }
  if (absl::Status known = store_.scene({"scene", opening.scene()}).status(); !known.ok()) return known;
  scene_ = opening.scene();
  editor_ = editors_.find(scene_, opening.editor_id());
  turn_ = editor_->take_over();
  return absl::OkStatus();
}

absl::Status EditStream::begin(const v1::SceneEdit& edit) {
  if (sequence_.has_value() && edit.sequence() != *sequence_ + 1) {
    return base::invalid_field("edit.sequence", fmt::format("{}, after {}", *sequence_ + 1, *sequence_),
                               fmt::format("{}", edit.sequence()));
  }
  absl::StatusOr<scene::Reservation> memory = store_.reserve(decoded_bytes(edit));
  if (!memory.ok()) return memory.status();
  absl::StatusOr<EditReader> reader =
      EditReader::begin(edit, [&](const v1::SharedBytes& named) { return shared_buffers_.find(named); });
  if (!reader.ok()) return reader.status();
  edit_.emplace(Edit{edit.sequence(), *std::move(memory), *std::move(reader)});
  return edit_->reader.bytes_to_come() > 0 ? absl::OkStatus() : apply();
}

absl::Status EditStream::share(uint64_t bytes) {
  const absl::StatusOr<std::optional<v1::SharedMemory>> offer = shared_buffers_.share(bytes);
  if (!offer.ok()) return offer.status();
  if (!offer->has_value()) return absl::OkStatus();
  const absl::MutexLock lock(&mutex_);
  offers_.push_back(**offer);
  if (!writing_) acknowledge();
  return absl::OkStatus();
}

absl::Status EditStream::take_payload(const std::string& bytes) {
  if (bytes.size() > kMostPayloadBytes) {
    return base::invalid_field("payload", fmt::format("at most {} bytes", kMostPayloadBytes),
                               fmt::format("{} bytes", bytes.size()));
  }
  if (absl::Status added = edit_->reader.add(bytes); !added.ok()) return added;
  return edit_->reader.bytes_to_come() > 0 ? absl::OkStatus() : apply();
}

absl::Status EditStream::apply() {
  // Its memory is free once it is applied.
  Edit edit = *std::exchange(edit_, std::nullopt);
  absl::StatusOr<uint64_t> revision = uint64_t{0};
  const absl::Status applied = editor_->apply(turn_, [&] {
    revision = store_.apply({"scene", scene_}, edit.reader.finish());
    return revision.status();
  });
  if (!applied.ok()) return applied;
  sequence_ = edit.sequence;
  const absl::MutexLock lock(&mutex_);
  applied_.set_applied(edit.sequence);
  applied_.set_scene_revision(*revision);
  if (!writing_) acknowledge();
  return absl::OkStatus();
}

/// Tells what is applied and was not told, or ends.
void EditStream::acknowledge() {
  if (finished_) return;
  if (applied_.scene_revision() == told_ && offers_.empty()) {
    if (ending_.has_value()) finish(*ending_);
    return;
  }
  message_ = applied_;
  if (!offers_.empty()) {
    *message_.mutable_shared_memory() = offers_.front();
    offers_.erase(offers_.begin());
  }
  told_ = applied_.scene_revision();
  writing_ = true;
  StartWrite(&message_);
}

void EditStream::finish(const absl::Status& status) {
  if (finished_) return;
  finished_ = true;
  Finish(to_grpc(status));
}

}  // namespace diaphane::service

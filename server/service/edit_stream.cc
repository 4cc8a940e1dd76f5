#include "service/edit_stream.h"

#include <new>

#include "base/status.h"
#include "fmt/format.h"
#include "service/convert/edit.h"
#include "service/convert/status.h"

namespace diaphane::service {
namespace {

constexpr size_t kMaxEditorIdBytes = 64;

}  // namespace

EditStream::EditStream(scene::SceneStore& store, Editors& editors, OpenStreams& open_streams)
    : store_(store), editors_(editors), open_streams_(open_streams) {
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
  delete this;
}

void EditStream::OnReadDone(bool ok) {
  const absl::Status status = ok ? take(request_) : absl::OkStatus();
  if (ok && status.ok()) return StartRead(&request_);
  const absl::MutexLock lock(&mutex_);
  if (!ending_.has_value()) ending_ = status;
  if (!writing_) acknowledge();
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
  if (!request.has_edit()) return base::invalid_field("part", "an edit", "nothing");
  try {
    return editor_->apply(turn_, [&] { return apply(request.edit()); });
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

absl::Status EditStream::apply(const v1::SceneEdit& edit) {
  if (sequence_.has_value() && edit.sequence() != *sequence_ + 1) {
    return base::invalid_field("edit.sequence", fmt::format("{}, after {}", *sequence_ + 1, *sequence_),
                               fmt::format("{}", edit.sequence()));
  }
  const absl::StatusOr<scene::Reservation> decoding = store_.reserve(decoded_bytes(edit));
  if (!decoding.ok()) return decoding.status();
  auto changes = from_proto(edit);
  if (!changes.ok()) return changes.status();
  const absl::StatusOr<uint64_t> revision = store_.apply({"scene", scene_}, *std::move(changes));
  if (!revision.ok()) return revision.status();
  sequence_ = edit.sequence();
  const absl::MutexLock lock(&mutex_);
  applied_.set_applied(edit.sequence());
  applied_.set_scene_revision(*revision);
  if (!writing_) acknowledge();
  return absl::OkStatus();
}

/// Tells what is applied and was not told, or ends.
void EditStream::acknowledge() {
  if (finished_) return;
  if (applied_.scene_revision() == told_) {
    if (ending_.has_value()) finish(*ending_);
    return;
  }
  message_ = applied_;
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

#include "scene/scene_store.h"

#include <charconv>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"

namespace diaphane::scene {
namespace {

void apply_patch(const ScenePatch& patch, SceneSnapshot& draft) {
  if (patch.display_name.has_value()) draft.display_name = *patch.display_name;
  if (patch.millimetres_per_unit.has_value()) draft.millimetres_per_unit = *patch.millimetres_per_unit;
}

// The order of creation after which a page starts.
absl::StatusOr<uint64_t> parse_token(const Reference& token) {
  uint64_t order = 0;
  if (token.name.empty()) return order;
  const char* end = token.name.data() + token.name.size();
  const auto parsed = std::from_chars(token.name.data(), end, order);
  if (parsed.ec != std::errc() || parsed.ptr != end) {
    return base::invalid_field(token.field, "a next_page_token of this server, or empty", token.name);
  }
  return order;
}

}  // namespace

absl::StatusOr<SnapshotPtr> SceneStore::create_scene(const ScenePatch& values) {
  auto created = std::make_shared<SceneSnapshot>();
  created->name = make_scene_name();
  created->revision = 1;
  apply_patch(values, *created);
  absl::MutexLock lock(&mutex_);
  if (scenes_.size() >= limits_.max_scenes) {
    return base::field_error(absl::StatusCode::kResourceExhausted, {"scenes", fmt::format("{}", scenes_.size() + 1),
                                                                    fmt::format("at most {}", limits_.max_scenes)});
  }
  const uint64_t order = next_order_++;
  order_of_name_.emplace(created->name, order);
  scenes_.emplace(order, created);
  return SnapshotPtr(std::move(created));
}

absl::StatusOr<SnapshotPtr> SceneStore::scene(const Reference& scene) const {
  if (absl::Status form = check_scene_name(scene); !form.ok()) return form;
  absl::MutexLock lock(&mutex_);
  const auto order = order_of_name_.find(std::string(scene.name));
  if (order == order_of_name_.end()) return not_found(scene, "scene");
  return scenes_.at(order->second);
}

absl::StatusOr<ScenePage> SceneStore::scenes(size_t page_size, const Reference& token) const {
  const absl::StatusOr<uint64_t> after = parse_token(token);
  if (!after.ok()) return after.status();
  ScenePage page;
  absl::MutexLock lock(&mutex_);
  auto next = scenes_.upper_bound(*after);
  uint64_t last = *after;
  for (; next != scenes_.end() && page.scenes.size() < page_size; ++next) {
    page.scenes.push_back(next->second);
    last = next->first;
  }
  if (next != scenes_.end()) page.next_page_token = fmt::format("{}", last);
  return page;
}

absl::StatusOr<SnapshotPtr> SceneStore::update_scene(const Reference& scene, const ScenePatch& patch) {
  return mutate(scene, [&](SceneSnapshot& draft) {
    apply_patch(patch, draft);
    return absl::OkStatus();
  });
}

absl::Status SceneStore::delete_scene(const Reference& scene) {
  if (absl::Status form = check_scene_name(scene); !form.ok()) return form;
  SnapshotPtr retired;  // Its meshes are freed after the lock.
  absl::MutexLock lock(&mutex_);
  const auto order = order_of_name_.find(std::string(scene.name));
  if (order == order_of_name_.end()) return not_found(scene, "scene");
  const auto entry = scenes_.find(order->second);
  retired = std::move(entry->second);
  scenes_.erase(entry);
  order_of_name_.erase(order);
  tell_watchers(std::string(scene.name), nullptr);
  watchers_.erase(std::string(scene.name));
  return absl::OkStatus();
}

absl::StatusOr<std::shared_ptr<const SceneStore::Watcher>> SceneStore::watch(const Reference& scene, Watcher watcher) {
  if (absl::Status form = check_scene_name(scene); !form.ok()) return form;
  auto kept = std::make_shared<const Watcher>(std::move(watcher));
  absl::MutexLock lock(&mutex_);
  const auto order = order_of_name_.find(std::string(scene.name));
  if (order == order_of_name_.end()) return not_found(scene, "scene");
  watchers_[std::string(scene.name)].push_back(kept);
  (*kept)(scenes_.at(order->second));
  return kept;
}

void SceneStore::tell_watchers(const std::string& scene, const SnapshotPtr& snapshot) {
  const auto found = watchers_.find(scene);
  if (found == watchers_.end()) return;
  std::erase_if(found->second, [&](const std::weak_ptr<const Watcher>& kept) {
    const std::shared_ptr<const Watcher> watcher = kept.lock();
    if (watcher != nullptr) (*watcher)(snapshot);
    return watcher == nullptr;
  });
  if (found->second.empty()) watchers_.erase(found);
}

absl::StatusOr<SnapshotPtr> SceneStore::mutate(const Reference& scene, Change change) {
  if (absl::Status form = check_scene_name(scene); !form.ok()) return form;
  SnapshotPtr retired;  // Its meshes are freed after the lock.
  absl::MutexLock lock(&mutex_);
  const auto order = order_of_name_.find(std::string(scene.name));
  if (order == order_of_name_.end()) return not_found(scene, "scene");
  SnapshotPtr& current = scenes_.at(order->second);
  auto draft = std::make_shared<SceneSnapshot>(*current);
  ++draft->revision;
  if (absl::Status changed = change(*draft); !changed.ok()) return changed;
  retired = std::exchange(current, std::move(draft));
  tell_watchers(current->name, current);
  return current;
}

absl::StatusOr<SnapshotPtr> SceneStore::mutate_parent(const Reference& child, Collection collection, Change change) {
  const absl::StatusOr<std::string> scene = scene_of_child(child, collection);
  if (!scene.ok()) return scene.status();
  return mutate({child.field, *scene}, change);
}

absl::StatusOr<SnapshotPtr> SceneStore::parent_of(const Reference& child, Collection collection) const {
  const absl::StatusOr<std::string> name = scene_of_child(child, collection);
  if (!name.ok()) return name.status();
  return scene({child.field, *name});
}

}  // namespace diaphane::scene

// A server that remembers what it was sent, and answers as a test tells it to.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "diaphane/v1/render_service.grpc.pb.h"
#include "diaphane/v1/scene_service.grpc.pb.h"
#include "diaphane/v1/server_service.grpc.pb.h"
#include "grpcpp/grpcpp.h"

namespace diaphane::testing_support {

class FakeScenes final : public v1::SceneService::Service {
 public:
  /// Answers of the next uploads and scene creations; OK once they are used up.
  std::deque<grpc::Status> answers;
  std::vector<v1::CreateSceneRequest> created;
  std::vector<v1::MeshHeader> mesh_headers;
  std::vector<v1::PositionsHeader> positions_headers;
  std::vector<size_t> chunk_sizes;
  std::string payload;  ///< of the last upload
  std::vector<v1::Scene> scenes;
  uint32_t page_size = 2;

  grpc::Status CreateScene(grpc::ServerContext*, const v1::CreateSceneRequest* request, v1::Scene* response) override {
    created.push_back(*request);
    response->set_name("scenes/s");
    return next_answer();
  }

  grpc::Status ListScenes(grpc::ServerContext*, const v1::ListScenesRequest* request,
                          v1::ListScenesResponse* response) override {
    const size_t first = request->page_token().empty() ? 0 : std::stoul(request->page_token());
    for (size_t i = first; i < scenes.size() && i < first + page_size; ++i) *response->add_scenes() = scenes[i];
    if (first + page_size < scenes.size()) response->set_next_page_token(std::to_string(first + page_size));
    return grpc::Status::OK;
  }

  grpc::Status UploadMesh(grpc::ServerContext*, grpc::ServerReader<v1::UploadMeshRequest>* reader,
                          v1::MeshResponse* response) override {
    v1::UploadMeshRequest request;
    payload.clear();
    while (reader->Read(&request)) {
      if (request.has_header()) mesh_headers.push_back(request.header());
      take(request.chunk());
    }
    response->mutable_mesh()->set_name("scenes/s/meshes/m");
    return next_answer();
  }

  grpc::Status UpdatePositions(grpc::ServerContext*, grpc::ServerReader<v1::UpdatePositionsRequest>* reader,
                               v1::MeshResponse* response) override {
    v1::UpdatePositionsRequest request;
    payload.clear();
    while (reader->Read(&request)) {
      if (request.has_header()) positions_headers.push_back(request.header());
      take(request.chunk());
    }
    response->set_scene_revision(7);
    return next_answer();
  }

 private:
  void take(const std::string& chunk) {
    if (chunk.empty()) return;
    chunk_sizes.push_back(chunk.size());
    payload += chunk;
  }

  grpc::Status next_answer() {
    if (answers.empty()) return grpc::Status::OK;
    grpc::Status answer = answers.front();
    answers.pop_front();
    return answer;
  }
};

class FakeRenders final : public v1::RenderService::Service {
 public:
  std::string image;
  bool wait_for_cancellation = false;
  std::vector<float> shares;  ///< told before a frame
  bool forget_the_frame = false;
  v1::RenderFrameRequest last_request;

  grpc::Status RenderFrame(grpc::ServerContext* context, const v1::RenderFrameRequest*,
                           v1::RenderFrameResponse* response) override {
    while (wait_for_cancellation && !context->IsCancelled()) std::this_thread::yield();
    response->set_image(image);
    return grpc::Status::OK;
  }

  grpc::Status RenderFrameWithProgress(grpc::ServerContext* context, const v1::RenderFrameRequest* request,
                                       grpc::ServerWriter<v1::RenderFrameWithProgressResponse>* writer) override {
    last_request = *request;
    v1::RenderFrameWithProgressResponse part;
    for (const float share : shares) {
      part.set_progress(share);
      writer->Write(part);
    }
    while (wait_for_cancellation && !context->IsCancelled()) std::this_thread::yield();
    part.mutable_frame()->set_image(image);
    if (!forget_the_frame) writer->Write(part);
    return grpc::Status::OK;
  }
};

class FakeInfo final : public v1::ServerService::Service {
 public:
  grpc::Status GetServerInfo(grpc::ServerContext*, const v1::GetServerInfoRequest*, v1::ServerInfo* response) override {
    response->set_version("fake");
    return grpc::Status::OK;
  }
};

/// All of it on a free port of the loopback interface.
class FakeServer {
 public:
  FakeScenes scenes;
  FakeRenders renders;

  FakeServer() {
    int port = 0;
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&scenes);
    builder.RegisterService(&renders);
    builder.RegisterService(&info_);
    server_ = builder.BuildAndStart();
    address_ = "127.0.0.1:" + std::to_string(port);
  }
  ~FakeServer() { server_->Shutdown(); }

  const std::string& address() const { return address_; }

 private:
  FakeInfo info_;
  std::string address_;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace diaphane::testing_support

// Where the gallery's pictures are taken: scenes on a server, frames as linear data.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/client.h"
#include "diaphane/environment.h"
#include "diaphane/mesh_data.h"
#include "diaphane/private_server.h"
#include "diaphane/texture.h"
#include "gallery/linear_frame.h"

namespace diaphane::gallery {

/// On the surface of a body; none need be given.
struct Pictures {
  std::optional<TextureData> albedo, normal, roughness;
};

struct Body {
  MeshData mesh;
  Material material;  ///< without textures
  Pictures pictures{};
};

/// What a picture is taken of.
struct Still {
  std::vector<Body> bodies;
  double millimetres_per_unit = 1;
  std::vector<Light> lights;
  std::optional<EnvironmentMap> environment;
  Camera camera;
  Size size;
  /// Positions of the first body, one frame after the other; none: as it is.
  std::vector<std::vector<Vec3>> poses;
};

/// A connection, and the server where none was named. One thread.
class Studio {
 public:
  /// `address` as for Client::connect; empty: a private server.
  static absl::StatusOr<Studio> open(const std::string& address);

  /// Frames of a still: for each pose one by each of the settings, in that order.
  absl::StatusOr<std::vector<LinearFrame>> shoot(const Still& still, std::span<const RenderSettings> settings) const;

  const Client& client() const { return client_; }

 private:
  Studio(std::optional<PrivateServer> server, Client client) : server_(std::move(server)), client_(std::move(client)) {}

  std::optional<PrivateServer> server_;
  Client client_;
};

}  // namespace diaphane::gallery

// Values to the contract's messages and back. The only place that knows both.
#pragma once

#include "diaphane/client.h"
#include "diaphane/render_options.h"
#include "diaphane/scene.h"
#include "diaphane/v1/frame.pb.h"
#include "diaphane/v1/light.pb.h"
#include "diaphane/v1/material.pb.h"
#include "diaphane/v1/mesh.pb.h"
#include "diaphane/v1/render_service.pb.h"
#include "diaphane/v1/scene.pb.h"
#include "diaphane/v1/server_service.pb.h"
#include "diaphane/values.h"

namespace diaphane::internal {

v1::Vec3 to_proto(const Vec3& value);
v1::Vec3 to_proto(const Rgb& value);
v1::Coefficients to_proto(const Coefficients& coefficients);
v1::Camera to_proto(const Camera& camera);
v1::Material to_proto(const Material& material);
v1::Light to_proto(const Light& light);
/// The name of the light's kind in an update mask.
const char* kind_of(const Light& light);
v1::RenderSettings to_proto(const RenderSettings& settings);
v1::RenderFrameRequest to_proto(const RenderOptions& options);

Vec3 vec3_from_proto(const v1::Vec3& message);
Rgb rgb_from_proto(const v1::Vec3& message);
Coefficients from_proto(const v1::Coefficients& message);
Material from_proto(const v1::Material& message);
MaterialInfo info_from_proto(const v1::Material& message);
MaterialPreset from_proto(const v1::MaterialPreset& message);
Light from_proto(const v1::Light& message);
SceneInfo from_proto(const v1::Scene& message);
MeshInfo from_proto(const v1::Mesh& message);
RenderSettings from_proto(const v1::RenderSettings& message);
RenderedFrame from_proto(v1::RenderFrameResponse&& message);
ServerInfo from_proto(const v1::ServerInfo& message);

}  // namespace diaphane::internal

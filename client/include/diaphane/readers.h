// Meshes from files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/mesh_data.h"
#include "diaphane/texture.h"
#include "diaphane/values.h"

namespace diaphane {

/// Bounds on what a file may make the reader allocate. Counts are over the whole file, instances counted each. As they
/// are, a small file cannot make more than 1 GiB of itself, and the largest of the usual scans (28 million triangles)
/// fit.
struct ReadLimits {
  uint64_t max_file_bytes = uint64_t{1} << 30;  ///< of the file together with every file that it refers to
  uint64_t max_vertices = 15'000'000;
  uint64_t max_triangles = 30'000'000;
  uint64_t max_texture_pixels = uint64_t{64} << 20;  ///< of all pictures that its materials use
  uint32_t max_nodes = 100'000;  ///< nodes of a glTF scene graph; also the meshes that any file may hold
};

/// What a file says that a mesh is made of.
struct FileMaterial {
  std::string name;                                 ///< may be empty
  Material material;                                ///< without textures
  std::optional<size_t> albedo, normal, roughness;  ///< into LoadedFile::textures
  float normal_scale = 1;
};

struct LoadedFile {
  std::vector<MeshData> meshes;                ///< at least one, each with at least one triangle
  std::vector<FileMaterial> materials;         ///< those that meshes have; of glTF alone
  std::vector<TextureData> textures;           ///< those that the materials have
  std::optional<double> millimetres_per_unit;  ///< where the format states a unit (glTF: metres, so 1000)
  std::vector<std::string> warnings;           ///< one line each: what was left out, and why
};

/// Reads a mesh file: glTF 2.0 (.gltf, .glb), Wavefront OBJ, PLY, STL or OFF, told apart by content first and by
/// extension second. What cannot be a mesh is refused as a whole, never half read.
///
/// - Polygons come back as n-2 triangles: convex ones as a fan, concave ones clipped ear by ear.
/// - A triangle that names one vertex twice is left out, with a warning.
/// - OBJ, PLY, OFF: one mesh; vertex i is the file's vertex i. OBJ appends a copy of a vertex for every further pair of
///   normal and texture coordinate that its faces give it. Materials and groups are not read.
/// - STL: one mesh per solid, corners at bit-equal positions welded.
/// - glTF: one mesh per primitive and node (and instance of EXT_mesh_gpu_instancing), placed by its scene_from_mesh (a
///   negative scale stays there), with the default morph weights applied. What has a skin comes posed by its joints at
///   rest, in scene units. Draco's and meshoptimizer's compression is read. External buffers and pictures are opened
///   only inside the file's own folder.
/// - glTF's materials: a body of the base colour (at most 0.95) through which light goes 1 mm, or KHR_materials_volume
///   where KHR_materials_volume_scatter gives it a colour; KHR_materials_ior; a coat of the roughness, or that of
///   KHR_materials_clearcoat. Pictures of base colour, normals and roughness (PNG, JPEG, WebP) with the texture
///   coordinates that the first of them names, KHR_texture_transform included. What cannot be read of them is left out
///   with a warning; so are metal, emission and alpha.
/// - Normals come as the file has them, of any length; (0, 0, 0) where it has none for that vertex.
/// - Colours of vertices come as linear RGB, cut to 0..1 and white where a vertex has none: glTF's COLOR_0 and PLY's
///   floating-point ones are linear already; PLY's integers, OBJ's and OFF's are taken as sRGB (OBJ's and OFF's as
///   0..255 where one of them is above 1). Texture coordinates (OBJ's vt, PLY's s t, u v and texture_u texture_v, OFF's
///   ST, glTF's TEXCOORD_0) come with v counted from above, (0, 0) where a vertex has none. Neither is read per face.
///
/// Errors, each one line "PATH: what, where, range": kNotFound no such file; kPermissionDenied it cannot be opened;
/// kInvalidArgument malformed (non-finite positions, indices out of range, truncated, ...) or nothing to render;
/// kResourceExhausted past one of `limits`; kUnimplemented a feature that is named, such as an extension.
/// Thread-safe.
absl::StatusOr<LoadedFile> read_mesh_file(const std::filesystem::path& path, const ReadLimits& limits = {});

}  // namespace diaphane

#include "app/options.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "app/version.h"

namespace diaphane::app {
namespace {

void add_limits(CLI::App& app, service::ServiceLimits& limits, uint64_t& mesh_mib, double& upload_silence_s,
                double& reference_s) {
  const CLI::Range positive(1u, UINT32_MAX);
  const auto add = [&](const char* name, auto& value, const char* description) {
    app.add_option(name, value, description)->check(positive)->capture_default_str()->group("Limits");
  };
  add("--max-pixels", limits.max_pixels, "pixels of a frame");
  add("--max-queued-frames", limits.max_queued_frames, "frames that wait to be drawn");
  add("--max-scenes", limits.scene.max_scenes, "scenes");
  add("--max-meshes", limits.scene.max_meshes_per_scene, "meshes of a scene");
  add("--max-materials", limits.scene.max_materials_per_scene, "materials of a scene");
  add("--max-textures", limits.scene.max_textures_per_scene, "textures of a scene");
  add("--max-lights", limits.scene.max_lights_per_scene, "lights of a scene");
  add("--max-vertices", limits.scene.max_vertices_per_mesh, "vertices of a mesh");
  add("--max-triangles", limits.scene.max_triangles_per_mesh, "triangles of a mesh");
  add("--max-mesh-mib", mesh_mib, "MiB of all meshes and of uploads in flight");
  app.add_option("--max-reference-seconds", reference_s, "how long a frame by the reference technique is drawn for")
      ->check(CLI::Range(0.001, 86400.0))
      ->capture_default_str()
      ->group("Limits");
  app.add_option("--max-upload-silence-seconds", upload_silence_s, "how long an upload may send nothing")
      ->check(CLI::Range(0.001, 86400.0))
      ->capture_default_str()
      ->group("Limits");
}

}  // namespace

std::variant<Options, int> parse_options(int argc, char** argv) {
  Options options;
  std::string warm = "all", raster = "auto";
  uint64_t mesh_mib = options.server.limits.scene.max_mesh_bytes >> 20;
  uint64_t grpc_mib = options.server.grpc_memory_bytes >> 20;
  double upload_silence_s = absl::ToDoubleSeconds(options.server.limits.max_upload_silence);
  double reference_s = absl::ToDoubleSeconds(options.server.limits.max_reference_time);
  double drain_s = absl::ToDoubleSeconds(options.drain);

  CLI::App app("Renders translucent objects for clients that connect by gRPC.", "diaphane-server");
  app.set_version_flag("--version", std::string("diaphane-server ") + kVersion);
  app.add_option("--listen", options.server.listen,
                 "HOST:PORT, [IPV6]:PORT or unix:PATH; port 0 picks one. Prints \"listening on ADDRESS\" when ready")
      ->capture_default_str();
  app.add_flag("--allow-public-plaintext", options.server.allow_public_plaintext,
               "listen, unencrypted, where other machines can connect");
  app.add_option("--device", options.renderer.device, "GPU, by its index or a part of its name (default: the best)");
  app.add_option("--raster", raster,
                 "who finds what triangles show: OpenGL, the CPU, or the CPU where OpenGL is software")
      ->check(CLI::IsMember({"auto", "gl", "native"}))
      ->capture_default_str();
  app.add_option("--shader-dir", options.renderer.shader_dir, "read shaders from here, not from the program")
      ->check(CLI::ExistingDirectory);
  app.add_option("--warm", warm, "draw once with every program before listening, or none")
      ->check(CLI::IsMember({"all", "none"}))
      ->capture_default_str();
  app.add_option("--log-level", options.log_level, "what goes to stderr")
      ->check(CLI::IsMember({"error", "warning", "info", "debug"}))
      ->capture_default_str();
  app.add_option("--drain-seconds", drain_s, "what calls in flight have to end after SIGTERM or SIGINT")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
  app.add_flag("--exit-with-stdin", options.exit_with_stdin, "stop when standard input ends, as after SIGTERM");
  app.add_option("--grpc-memory-mib", grpc_mib, "MiB that gRPC may hold for calls and what they read")
      ->check(CLI::Range(16u, 1u << 20))
      ->capture_default_str()
      ->group("Limits");
  add_limits(app, options.server.limits, mesh_mib, upload_silence_s, reference_s);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& stop) {
    return app.exit(stop) == 0 ? 0 : kUsageError;
  }
  options.renderer.warm_all = warm == "all";
  options.renderer.raster = raster == "gl"       ? render::Raster::kGl
                            : raster == "native" ? render::Raster::kNative
                                                 : render::Raster::kAuto;
  options.server.limits.scene.max_mesh_bytes = mesh_mib << 20;
  options.server.limits.max_upload_silence = absl::Seconds(upload_silence_s);
  options.server.limits.max_reference_time = absl::Seconds(reference_s);
  options.server.grpc_memory_bytes = grpc_mib << 20;
  options.drain = absl::Seconds(drain_s);
  return options;
}

}  // namespace diaphane::app

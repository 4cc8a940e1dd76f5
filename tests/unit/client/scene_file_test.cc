#include "diaphane/scene_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

namespace diaphane {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class SceneFileTest : public testing::Test {
 protected:
  SceneFileTest() {
    std::string pattern = (fs::temp_directory_path() / "scene_file_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~SceneFileTest() override { fs::remove_all(folder_); }

  absl::StatusOr<SceneFile> read(std::string_view text) {
    std::ofstream(folder_ / "scene.json") << text;
    return read_scene_file(folder_ / "scene.json");
  }

  // The message of the refusal, which must be one line that starts with the path.
  std::string refusal(std::string_view text) {
    const absl::Status status = read(text).status();
    const std::string message(status.message());
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << text << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_TRUE(message.starts_with((folder_ / "scene.json").string() + ": ")) << message;
    return message;
  }

  fs::path folder_;
};

TEST_F(SceneFileTest, ReadsEverythingThatAFileMaySay) {
  const auto scene = read(R"({
    "scene": {"display_name": "Two", "millimetresPerUnit": 12.5},
    "materials": [{"name": "a", "preset": "skin1"},
                  {"name": "b", "coefficients": {"absorption_mm": {"x": 0.5},
                                                 "reduced_scattering_mm": {"x": 1, "y": 2, "z": 3}}}],
    "lights": [{"point": {"position": {"y": 4}, "intensity": {"x": 9, "y": 8, "z": 7}}}],
    "meshes": [{"file": "sub/x.ply", "material": "b", "scene_from_mesh": [2,0,0,0, 0,2,0,0, 0,0,2,0, 5,6,7,1]},
               {"file": "y.glb"}],
    "camera": {"eye": {"z": 3}},
    "settings": {"technique": "TECHNIQUE_LAMBERT", "paper": {"kernel_taps": 3, "global_gain": 0}, "exposure_ev": -1},
    "size": {"width_px": 64, "height_px": 48}})");
  ASSERT_TRUE(scene.ok()) << scene.status();
  EXPECT_EQ(scene->display_name, "Two");
  EXPECT_EQ(scene->millimetres_per_unit, 12.5);
  ASSERT_EQ(scene->materials.size(), 2);
  EXPECT_EQ(std::get<std::string>(scene->materials[0].material.model), "skin1");
  const Coefficients& free = std::get<Coefficients>(scene->materials[1].material.model);
  EXPECT_EQ(free.absorption_mm, (Rgb{0.5, 0, 0}));
  EXPECT_EQ(free.reduced_scattering_mm, (Rgb{1, 2, 3}));
  EXPECT_FLOAT_EQ(free.refractive_index, 1.3f);
  ASSERT_EQ(scene->lights.size(), 1);
  EXPECT_EQ(std::get<PointLight>(scene->lights[0]).position, (Vec3{0, 4, 0}));
  EXPECT_EQ(std::get<PointLight>(scene->lights[0]).intensity_w_sr, (Rgb{9, 8, 7}));
  ASSERT_EQ(scene->meshes.size(), 2);
  EXPECT_EQ(scene->meshes[0].path, folder_ / "sub/x.ply");
  EXPECT_EQ(scene->meshes[0].material, 1);
  EXPECT_EQ(scene->meshes[0].scene_from_mesh[13], 6);
  EXPECT_EQ(scene->meshes[1].material, std::nullopt);
  EXPECT_EQ(scene->meshes[1].scene_from_mesh[0], 1);
  EXPECT_EQ(scene->camera->eye, (Vec3{0, 0, 3}));
  EXPECT_EQ(scene->camera->up, (Vec3{0, 1, 0}));
  EXPECT_EQ(scene->camera->fov_y_deg, 30);
  EXPECT_EQ(scene->settings.technique, Technique::kLambert);
  EXPECT_EQ(scene->settings.paper.kernel_taps, 3);
  EXPECT_EQ(scene->settings.paper.face_size_px, 256);
  EXPECT_EQ(scene->settings.paper.global_gain, 0);
  EXPECT_EQ(scene->settings.exposure_ev, -1);
  EXPECT_EQ(scene->size->height_px, 48);
}

TEST_F(SceneFileTest, LeavesOpenWhatIsNotSaid) {
  const auto scene = read(R"({"meshes": [{"file": "x.ply"}]})");
  ASSERT_TRUE(scene.ok()) << scene.status();
  EXPECT_FALSE(scene->millimetres_per_unit);
  EXPECT_FALSE(scene->camera);
  EXPECT_FALSE(scene->size);
  EXPECT_EQ(scene->settings.technique, Technique::kServerDefault);
}

TEST_F(SceneFileTest, RefusesUnknownFields) {
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply"}], "meches": []})"), HasSubstr("meches"));
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply", "colour": 1}]})"), HasSubstr("colour"));
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply"}], "settings": {"technique": "FAST"}})"), HasSubstr("FAST"));
}

TEST_F(SceneFileTest, RefusesAFieldGivenTwiceInEitherSpelling) {
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply"}], "size": {"width_px": 1, "width_px": 2}})"),
              HasSubstr("'width_px' is given twice"));
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply"}], "size": {"width_px": 1, "widthPx": 2}})"),
              HasSubstr("'widthPx' is given twice"));
}

TEST_F(SceneFileTest, RefusesWhatIsNotJson) {
  EXPECT_THAT(refusal(""), HasSubstr("line 1"));
  EXPECT_THAT(refusal("{\"meshes\":\n[}"), HasSubstr("line 2, column 2"));
  EXPECT_THAT(refusal("[]"), testing::Not(HasSubstr("\n")));
  EXPECT_THAT(refusal(std::string(1'000'000, '[')), HasSubstr("nested deeper than 32"));
}

TEST_F(SceneFileTest, RefusesFieldsThatTheServerSets) {
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply"}], "scene": {"revision": 3}})"), HasSubstr("scene.revision"));
  EXPECT_THAT(
      refusal(R"({"meshes": [{"file": "x.ply"}], "materials": [{"name": "a", "preset": "b", "resolved": {}}]})"),
      HasSubstr("materials[0].resolved"));
}

TEST_F(SceneFileTest, RefusesMaterialsThatCannotBeMeant) {
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply", "material": "a"}]})"), HasSubstr("meshes[0].material"));
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply"}], "materials": [{"preset": "wax"}]})"),
              HasSubstr("materials[0].name"));
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply"}], "materials": [{"name": "a"}]})"),
              HasSubstr("preset, coefficients"));
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply"}],
                          "materials": [{"name": "a", "preset": "wax"}, {"name": "a", "preset": "wax"}]})"),
              HasSubstr("materials[1].name"));
}

TEST_F(SceneFileTest, RefusesMeshesOutsideItsFolder) {
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "/etc/passwd"}]})"), HasSubstr("meshes[0].file"));
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "../x.ply"}]})"), HasSubstr("stays in this folder"));
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "sub/../../x.ply"}]})"), HasSubstr("stays in this folder"));
  fs::create_directory_symlink("/etc", folder_ / "link");
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "link/passwd"}]})"), HasSubstr("stays in this folder"));
  EXPECT_THAT(refusal(R"({"meshes": [{"file": ""}]})"), HasSubstr("meshes[0].file"));
  EXPECT_THAT(refusal(R"({"meshes": []})"), HasSubstr("meshes"));
}

TEST_F(SceneFileTest, NamesTheFilesOfTextures) {
  const auto scene = read(R"({"meshes": [{"file": "x.ply", "material": "a"}],
      "materials": [{"name": "a", "preset": "wax", "coat": {"roughness": 0.1},
                     "textures": {"albedo": "a.png", "normal": "sub/n.png", "normal_scale": 2}}]})");
  ASSERT_TRUE(scene.ok()) << scene.status();
  const SceneFile::NamedMaterial& material = scene->materials[0];
  EXPECT_EQ(material.albedo_file, folder_ / "a.png");
  EXPECT_EQ(material.normal_file, folder_ / "sub/n.png");
  EXPECT_TRUE(material.roughness_file.empty());
  EXPECT_EQ(material.material.textures.normal_scale, 2);
  EXPECT_FALSE(material.material.textures.albedo.has_value());
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply"}],
      "materials": [{"name": "a", "preset": "wax", "textures": {"roughness": "../r.png"}}]})"),
              HasSubstr("materials[0].textures.roughness: must be a relative path that stays in this folder"));
}

TEST_F(SceneFileTest, AcceptsAPathThatComesBackToItsFolder) {
  EXPECT_TRUE(read(R"({"meshes": [{"file": "sub/../x.ply"}]})").ok());
}

TEST_F(SceneFileTest, RefusesATransformOfAnotherLength) {
  EXPECT_THAT(refusal(R"({"meshes": [{"file": "x.ply", "scene_from_mesh": [1, 2]}]})"), HasSubstr("16 numbers, got 2"));
}

TEST_F(SceneFileTest, SaysWhichFileIsMissing) {
  const absl::Status status = read_scene_file(folder_ / "none.json").status();
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(status.message()), HasSubstr("none.json"));
}

TEST_F(SceneFileTest, RefusesFolders) {
  EXPECT_EQ(read_scene_file(folder_).status().code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace diaphane

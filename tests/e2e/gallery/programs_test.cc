// The programs behind ./dev gallery, ./dev contact-sheet and ./dev demo, in small.
#include <gmock/gmock.h>

#include <algorithm>
#include <regex>

#include "media/picture.h"
#include "nlohmann/json.hpp"
#include "tests/e2e/cli/fixture.h"
#include "tests/support/decoders.h"

namespace diaphane::testing_support {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

constexpr char kBunny[] = "/usr/share/glmark2/models/bunny.obj";

media::Picture picture_at(const fs::path& path) {
  auto picture = media::decode_picture(read_file(path));
  EXPECT_TRUE(picture.ok()) << path << ": " << picture.status();
  return picture.ok() ? *std::move(picture) : media::Picture{};
}

bool is_background(const uint8_t* pixel) {
  return pixel[0] == media::kBackground.r && pixel[1] == media::kBackground.g && pixel[2] == media::kBackground.b;
}

double luma(const uint8_t* p) { return 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]; }

// Over the body's pixels between two rows, as shares of the height from the top.
double mean_luma(const media::Picture& picture, double from = 0, double to = 1) {
  double sum = 0;
  double count = 0;
  for (int y = static_cast<int>(from * picture.height_px); y < static_cast<int>(to * picture.height_px); ++y) {
    for (int x = 0; x < picture.width_px; ++x) {
      const uint8_t* pixel = &picture.rgba[4 * static_cast<size_t>(y * picture.width_px + x)];
      if (is_background(pixel)) continue;
      sum += luma(pixel);
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

// Sorted luma of the body's pixels: two of them compare as histograms do.
std::vector<double> sorted_luma(const media::Picture& picture) {
  std::vector<double> values;
  for (size_t i = 0; i < picture.rgba.size(); i += 4) {
    if (!is_background(&picture.rgba[i])) values.push_back(luma(&picture.rgba[i]));
  }
  std::sort(values.begin(), values.end());
  return values;
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < 1000; ++i) sum += std::abs(a[i * a.size() / 1000] - b[i * b.size() / 1000]);
  return sum / 1000;
}

class Gallery : public CliTest {
 protected:
  void make() const {
    if (!fs::exists(kBunny)) GTEST_SKIP() << kBunny << " is not there";
    const Finished finished = run_program(
        "diaphane-gallery", folder_, {kBunny, "page", "--size", "96", "--reference-size", "40", "--head-levels", "4"});
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
  }

  media::Picture picture(const std::string& name) const { return picture_at(folder_ / "page" / (name + ".png")); }
};

TEST_F(Gallery, ShowsEveryFigureAsThePaperSaysOfIt) {
  make();
  if (IsSkipped() || HasFatalFailure()) return;
  const std::string page = read_file(folder_ / "page" / "index.html");
  for (const char* figure : {"fig6", "fig7", "fig8", "fig9", "fig10", "fig11", "materials", "colors", "techniques"}) {
    EXPECT_THAT(page, HasSubstr(std::string("<section id=\"") + figure + "\">"));
  }
  EXPECT_THAT(page, testing::Not(HasSubstr("http")));

  const std::regex link("<img src=\"([^\"]+)\" width=\"([0-9]+)\"");
  int pictures = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), link), end; at != end; ++at, ++pictures) {
    const media::Picture shown = picture_at(folder_ / "page" / (*at)[1].str());
    EXPECT_EQ(std::to_string(shown.width_px), (*at)[2].str()) << (*at)[1];
    EXPECT_GT(mean_luma(shown), 5) << (*at)[1] << " is black";
  }
  EXPECT_GE(pictures, 10 + 2 + 3 + 4 + 8 + 14 + 10);

  const auto kernel = [&](int taps) { return sorted_luma(picture("fig6_kernel_" + std::to_string(taps))); };
  EXPECT_LT(apart(kernel(5), kernel(6)), apart(kernel(3), kernel(4)));

  for (const char* technique : {"paper", "integral"}) {
    const media::Picture candle = picture(std::string("fig7_") + technique);
    EXPECT_GT(mean_luma(candle, 0.2, 0.45), 1.5 * mean_luma(candle, 0.75, 1)) << technique;
  }

  const json facts = json::parse(read_file(folder_ / "page" / "figures.json"));
  const json& terms = facts["fig9"]["horns_over_skull"];
  EXPECT_GT(terms["both"], terms["local"]);
  EXPECT_GT(terms["both"], 1);
  EXPECT_GT(terms["integral"], 1.5);
  for (const char* technique : {"paper", "integral"}) {
    for (const char* step : {"0", "35", "70"}) {
      EXPECT_GT(facts["fig10"]["horns_over_skull"][technique][step], 1) << technique << " " << step;
    }
  }
  // A coat adds, and what it adds in all does not depend on how rough it is.
  const json& shown = facts["fig11"]["mean_luminance"];
  const double bare = shown["none"], rough = shown["rough"], mirror = shown["mirror"];
  EXPECT_GT(rough, 1.02 * bare);
  EXPECT_NEAR(rough - bare, mirror - bare, 0.5 * (mirror - bare));
  for (const char* lit : {"front", "back"}) {
    EXPECT_LT(facts["techniques"]["rms_percent"][lit]["integral"][1], 5) << lit;
    EXPECT_GT(facts["techniques"]["rms_percent"][lit]["paper"][1], 5) << lit;
  }
}

TEST_F(Gallery, NamesTheMeshThatIsNotThere) {
  const Finished finished = run_program("diaphane-gallery", folder_, {"none.obj", "page"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.err, HasSubstr("none.obj"));
  EXPECT_FALSE(fs::exists(folder_ / "page" / "index.html"));
}

class ContactSheet : public CliTest {};

TEST_F(ContactSheet, ShowsWhatRendersAndSaysWhyTheRestDoesNot) {
  fs::create_directories(folder_ / "meshes" / "below");
  write_file(folder_ / "meshes" / "cube.obj", cube_obj());
  write_file(folder_ / "meshes" / "below" / "flat <1>.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n");
  write_file(folder_ / "meshes" / "below" / "points.obj", "v 0 0 0\n");
  write_file(folder_ / "meshes" / "notes.txt", "not a mesh");
  const Finished rendered = run_command(DIAPHANE_SOURCE_DIR "/client/gallery/render_folder", folder_,
                                        {DIAPHANE_BIN_DIR, "meshes", "sheet", "--size", "64x64"});
  ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
  const Finished made = run_program("diaphane-contact-page", folder_, {"sheet"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("3 mesh files: 2 render, 1 do not"));
  const std::string page = read_file(folder_ / "sheet" / "index.html");
  EXPECT_THAT(page, HasSubstr("<img src=\"cube.obj.png\""));
  EXPECT_THAT(page, HasSubstr("<img src=\"below__flat &lt;1&gt;.obj.png\""));
  EXPECT_THAT(page, testing::ContainsRegex("points.obj.*exit code 5: .*points.obj"));
  EXPECT_THAT(page, testing::Not(HasSubstr("notes.txt")));
  EXPECT_GT(mean_luma(picture_at(folder_ / "sheet" / "cube.obj.png")), 20);
  EXPECT_GT(mean_luma(picture_at(folder_ / "sheet" / "sheet.png")), 20);
}

class Demo : public CliTest {};

TEST_F(Demo, LeavesAnimationsOfAsManyFramesAsItRendered) {
  // An octahedron twice as high as wide: a cube would be on its sphere from the first.
  write_file(folder_ / "spindle.obj",
             "v 1 0 0\nv -1 0 0\nv 0 2 0\nv 0 -2 0\nv 0 0 1\nv 0 0 -1\n"
             "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
  const Finished finished =
      run_program("diaphane-demo", folder_, {"spindle.obj", "demo", "--frames", "3", "--size", "64x48"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  for (const char* technique : {"integral", "paper"}) {
    for (const char* frame : {"000", "001", "002"}) {
      EXPECT_TRUE(fs::exists(folder_ / "demo" / (std::string(technique) + "_" + frame + ".png")));
    }
  }
  EXPECT_GT(mean_luma(picture_at(folder_ / "demo" / "contact_sheet.png")), 20);

  const auto webp = decode_webp(folder_ / "demo" / "demo.webp");
  ASSERT_TRUE(webp.has_value());
  EXPECT_EQ(webp->width_px, 2 * 64);
  EXPECT_EQ(webp->height_px, 48);
  ASSERT_EQ(webp->mean.size(), 3);
  EXPECT_GT(*std::min_element(webp->mean.begin(), webp->mean.end()), 20);

  if (finished.err.find("no demo.mp4") != std::string::npos) GTEST_SKIP() << finished.err;
  const auto mp4 = decode_mp4(folder_ / "demo" / "demo.mp4");
  ASSERT_TRUE(mp4.has_value());
  EXPECT_EQ(mp4->width_px, 2 * 64);
  ASSERT_EQ(mp4->mean.size(), 3);
  EXPECT_GT(*std::min_element(mp4->mean.begin(), mp4->mean.end()), 16 + 20);
}

}  // namespace
}  // namespace diaphane::testing_support

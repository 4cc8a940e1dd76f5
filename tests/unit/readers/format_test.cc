#include "readers/format.h"

#include <gtest/gtest.h>

namespace diaphane::readers {
namespace {

TEST(TellFormat, BelievesContentBeforeExtension) {
  EXPECT_EQ(tell_format("ply\nformat ascii 1.0\n", ".obj"), MeshFormat::kPly);
  EXPECT_EQ(tell_format("glTF\x02", ".stl"), MeshFormat::kGltf);
  EXPECT_EQ(tell_format(" {\"asset\":{}}", ""), MeshFormat::kGltf);
  EXPECT_EQ(tell_format("# made by hand\nCOFF\n", ".txt"), MeshFormat::kOff);
  EXPECT_EQ(tell_format("solid a\nfacet normal 0 0 1\n", ""), MeshFormat::kStl);
}

TEST(TellFormat, FallsBackToTheExtensionInAnyCase) {
  EXPECT_EQ(tell_format("v 0 0 0\n", ".OBJ"), MeshFormat::kObj);
  EXPECT_EQ(tell_format("", ".Glb"), MeshFormat::kGltf);
  EXPECT_EQ(tell_format("v 0 0 0\n", ".txt"), std::nullopt);
}

TEST(TellFormat, TakesABinaryStlThatBeginsWithSolidForOne) {
  std::string bytes = "solid made by a careless exporter";
  bytes.resize(84, '\0');
  bytes[80] = 2;
  bytes.resize(84 + 2 * 50, '\0');
  EXPECT_EQ(tell_format(bytes, ""), MeshFormat::kStl);
}

}  // namespace
}  // namespace diaphane::readers

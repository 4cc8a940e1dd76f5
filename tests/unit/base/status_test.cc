#include "base/status.h"

#include <gtest/gtest.h>

namespace diaphane::base {
namespace {

TEST(FieldError, NamesFieldRangeAndValue) {
  const absl::Status status = invalid_field("size.width_px", "1..8192", 0);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(), "size.width_px: must be 1..8192, got 0");
}

TEST(FieldError, CarriesTheViolationAsData) {
  const FieldViolation violation =
      field_violation(field_error(absl::StatusCode::kResourceExhausted, {"vertex_count", "9", "at most 8"}));
  EXPECT_EQ(violation.field, "vertex_count");
  EXPECT_EQ(violation.value, "9");
  EXPECT_EQ(violation.range, "at most 8");
}

TEST(FieldError, CutsLongValuesBetweenCharacters) {
  std::string value(119, 'a');
  value += "é and more";
  EXPECT_EQ(field_violation(invalid_field("name", "short", value)).value, std::string(119, 'a') + "…");
}

TEST(FieldError, ReplacesControlCharacters) {
  EXPECT_EQ(field_violation(invalid_field("name", "text", "a\x1f\n\x7f")).value, "a???");
}

TEST(FieldError, OtherStatusesCarryNone) { EXPECT_EQ(field_violation(absl::InternalError("x")).field, ""); }

}  // namespace
}  // namespace diaphane::base

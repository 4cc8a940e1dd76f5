#include "service/convert/status.h"

#include <string>

#include "base/status.h"
#include "fmt/format.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace diaphane::service {
namespace {

google::rpc::ErrorInfo error_info(absl::StatusCode code, const base::FieldViolation& violation) {
  google::rpc::ErrorInfo info;
  info.set_reason(absl::StatusCodeToString(code));
  info.set_domain("diaphane");
  (*info.mutable_metadata())["field"] = violation.field;
  (*info.mutable_metadata())["value"] = violation.value;
  (*info.mutable_metadata())["range"] = violation.range;
  return info;
}

void add_details(absl::StatusCode code, const base::FieldViolation& violation, google::rpc::Status& status) {
  const std::string description = fmt::format("must be {}, got {}", violation.range, violation.value);
  if (code == absl::StatusCode::kInvalidArgument || code == absl::StatusCode::kNotFound) {
    google::rpc::BadRequest details;
    details.add_field_violations()->set_field(violation.field);
    details.mutable_field_violations(0)->set_description(description);
    status.add_details()->PackFrom(details);
  } else if (code == absl::StatusCode::kResourceExhausted) {
    google::rpc::QuotaFailure details;
    details.add_violations()->set_subject(violation.field);
    details.mutable_violations(0)->set_description(description);
    status.add_details()->PackFrom(details);
  } else if (code == absl::StatusCode::kFailedPrecondition) {
    google::rpc::PreconditionFailure details;
    details.add_violations()->set_type("STATE");
    details.mutable_violations(0)->set_subject(violation.field);
    details.mutable_violations(0)->set_description(description);
    status.add_details()->PackFrom(details);
  }
}

}  // namespace

grpc::Status to_grpc(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  // The canonical codes have the same numbers.
  const auto code = static_cast<grpc::StatusCode>(status.code());
  const std::string message(status.message());
  const base::FieldViolation violation = base::field_violation(status);
  if (violation.field.empty()) return grpc::Status(code, message);
  google::rpc::Status details;
  details.set_code(code);
  details.set_message(message);
  details.add_details()->PackFrom(error_info(status.code(), violation));
  add_details(status.code(), violation, details);
  return grpc::Status(code, message, details.SerializeAsString());
}

}  // namespace diaphane::service

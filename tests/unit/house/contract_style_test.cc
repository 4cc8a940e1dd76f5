// The rules of the contract's own files, as buf's linter has them by default (but that a call may answer with its
// resource): names, packages, imports, and a comment where it counts.
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FileDescriptor;
using google::protobuf::MethodDescriptor;
using google::protobuf::ServiceDescriptor;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

using Complaints = std::vector<std::string>;

bool matches(const std::string& name, const char* pattern) { return std::regex_match(name, std::regex(pattern)); }
bool is_snake(const std::string& name) { return matches(name, "[a-z][a-z0-9]*(_[a-z0-9]+)*"); }
bool is_upper_snake(const std::string& name) { return matches(name, "[A-Z][A-Z0-9]*(_[A-Z0-9]+)*"); }
bool is_pascal(const std::string& name) { return matches(name, "([A-Z][a-z0-9]*)+"); }

// TwoWords -> TWO_WORDS
std::string upper_snake(const std::string& name) {
  std::string result;
  for (const char c : name) {
    if (std::isupper(c) != 0 && !result.empty()) result += '_';
    result += static_cast<char>(std::toupper(c));
  }
  return result;
}

// GetThingRequest -> GetThing
std::string call_of(const std::string& request) { return request.substr(0, request.rfind("Request")); }

template <typename Thing>
bool has_comment(const Thing& thing) {
  google::protobuf::SourceLocation location;
  return thing.GetSourceLocation(&location) && !(location.leading_comments + location.trailing_comments).empty();
}

// Everything that is wrong with one file. `call_types` are requests and responses: their call says what they are.
class Judge {
 public:
  explicit Judge(const FileDescriptor& file) {
    judge_package(file);
    expect(file.syntax() == FileDescriptor::SYNTAX_PROTO3, file.name(), "says that it is proto3");
    expect(file.public_dependency_count() == 0, file.name(), "imports nothing publicly");
    expect(file.weak_dependency_count() == 0, file.name(), "imports nothing weakly");
    std::set<const Descriptor*> call_types;
    for (int i = 0; i < file.service_count(); ++i) judge(*file.service(i), call_types);
    for (int i = 0; i < file.message_type_count(); ++i) judge(*file.message_type(i), call_types);
    for (int i = 0; i < file.enum_type_count(); ++i) judge(*file.enum_type(i));
  }

  const Complaints& complaints() const { return complaints_; }

 private:
  void expect(bool holds, const std::string& name, const std::string& rule) {
    if (!holds) complaints_.push_back(name + ": " + rule);
  }

  void judge_package(const FileDescriptor& file) {
    std::string folder = fs::path(file.name()).parent_path();
    std::replace(folder.begin(), folder.end(), '/', '.');
    expect(matches(file.package(), ".*\\.v[1-9][0-9]*"), file.name(), "the package ends in a version");
    expect(matches(file.package(), "[a-z0-9_.]+"), file.name(), "the package is lower_snake.case");
    expect(file.package() == folder, file.name(), "the package is the folder");
    expect(is_snake(fs::path(file.name()).stem()), file.name(), "the file's name is snake_case");
  }

  void judge(const ServiceDescriptor& service, std::set<const Descriptor*>& call_types) {
    expect(is_pascal(service.name()) && service.name().ends_with("Service"), service.full_name(), "is NounService");
    expect(has_comment(service), service.full_name(), "has a comment");
    for (int i = 0; i < service.method_count(); ++i) {
      const MethodDescriptor& method = *service.method(i);
      expect(is_pascal(method.name()), method.full_name(), "is PascalCase");
      expect(has_comment(method), method.full_name(), "has a comment");
      // A variant, such as RenderFrameWithProgress, takes what its call does.
      const std::string& request = method.input_type()->name();
      expect(request.ends_with("Request") && method.name().starts_with(call_of(request)), method.full_name(),
             "takes a MethodRequest");
      // A resource's own verbs may answer with the resource, or with nothing.
      const std::string& answer = method.output_type()->name();
      expect(answer.ends_with("Response") || answer == "Empty" || method.name().ends_with(answer), method.full_name(),
             "returns a …Response, the noun of its name, or Empty");
      call_types.insert(method.input_type());
      if (answer.ends_with("Response")) call_types.insert(method.output_type());
    }
  }

  void judge(const Descriptor& message, const std::set<const Descriptor*>& call_types) {
    if (message.options().map_entry()) return;
    expect(is_pascal(message.name()), message.full_name(), "is PascalCase");
    expect(has_comment(message) || call_types.contains(&message), message.full_name(), "has a comment");
    for (int i = 0; i < message.field_count(); ++i) {
      expect(is_snake(message.field(i)->name()), message.field(i)->full_name(), "is snake_case");
    }
    for (int i = 0; i < message.real_oneof_decl_count(); ++i) {
      expect(is_snake(message.oneof_decl(i)->name()), message.oneof_decl(i)->full_name(), "is snake_case");
    }
    for (int i = 0; i < message.nested_type_count(); ++i) judge(*message.nested_type(i), call_types);
    for (int i = 0; i < message.enum_type_count(); ++i) judge(*message.enum_type(i));
  }

  void judge(const EnumDescriptor& type) {
    expect(is_pascal(type.name()), type.full_name(), "is PascalCase");
    expect(has_comment(type), type.full_name(), "has a comment");
    expect(!type.options().allow_alias(), type.full_name(), "has no aliases");
    const std::string prefix = upper_snake(type.name()) + "_";
    for (int i = 0; i < type.value_count(); ++i) {
      expect(type.value(i)->name().starts_with(prefix), type.value(i)->full_name(), "starts with " + prefix);
      expect(is_upper_snake(type.value(i)->name()), type.value(i)->full_name(), "is UPPER_SNAKE_CASE");
    }
    expect(type.value(0)->number() == 0 && type.value(0)->name() == prefix + "UNSPECIFIED", type.full_name(),
           "starts with 0, " + prefix + "UNSPECIFIED");
  }

  Complaints complaints_;
};

// What the compiler itself warns of: imports that nothing uses.
Complaints warnings_in(const fs::path& messages) {
  Complaints warnings;
  std::ifstream stream(messages);
  for (std::string line; std::getline(stream, line);) {
    if (line.find("warning: Import") != std::string::npos) warnings.push_back(line);
  }
  return warnings;
}

// The complaints about every .proto below folder/package; imports are relative to `folder`.
Complaints judge_files(const fs::path& folder, const std::string& package) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder / package)) {
    if (entry.path().extension() == ".proto") files.push_back(fs::relative(entry.path(), folder));
  }
  const fs::path compiled = fs::path(testing::TempDir()) / (package + ".descriptors");
  std::string command =
      "'" PROTOC "' --include_source_info --include_imports '--descriptor_set_out=" + compiled.string() + "' '-I" +
      folder.string() + "'";
  for (const std::string& file : files) command += " '" + file + "'";
  const std::string messages = compiled.string() + ".messages";
  if (std::system((command + " 2> '" + messages + "'").c_str()) != 0) return {command + ": failed, see " + messages};

  google::protobuf::FileDescriptorSet set;
  std::ifstream stream(compiled, std::ios::binary);
  if (!set.ParseFromIstream(&stream)) return {compiled.string() + ": cannot be read"};
  google::protobuf::DescriptorPool pool;
  for (const auto& file : set.file()) pool.BuildFile(file);
  Complaints complaints = warnings_in(messages);
  for (const std::string& file : files) {
    const Judge judge(*pool.FindFileByName(file));
    complaints.insert(complaints.end(), judge.complaints().begin(), judge.complaints().end());
  }
  return complaints;
}

TEST(ContractStyle, IsKeptByEveryProto) {
  EXPECT_THAT(judge_files(fs::path(DIAPHANE_SOURCE_DIR) / "proto", "diaphane"), IsEmpty());
}

TEST(ContractStyle, JudgesNamesPackagesImportsAndComments) {
  const Complaints complaints = judge_files(fs::path(DIAPHANE_SOURCE_DIR) / "tests/unit/house/data", "styleless");
  for (const char* rule : {"Import google/protobuf/empty.proto is unused", "BadNames.proto: imports nothing publicly",
                           "BadNames.proto: the package is lower_snake.case", "older.proto: says that it is proto3",
                           "Colour: has no aliases", "red_too: is UPPER_SNAKE_CASE"}) {
    EXPECT_THAT(complaints, Contains(HasSubstr(rule)));
  }
  EXPECT_THAT(complaints, SizeIs(24));
}

}  // namespace

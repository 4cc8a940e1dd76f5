// Runs the project's programs as a person would.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace diaphane::testing_support {

struct Finished {
  int exit_code = -1;  ///< 128 + the signal, where one ended it
  std::string out;
  std::string err;
  long peak_memory_kib = 0;
};

/// Runs a program, by its path, in `folder` to its end.
Finished run_command(const std::string& path, const std::filesystem::path& folder,
                     const std::vector<std::string>& arguments);

/// Runs build/bin/PROGRAM in `folder` to its end.
Finished run_program(const std::string& name, const std::filesystem::path& folder,
                     const std::vector<std::string>& arguments);

/// run_program("diaphane", ...)
Finished run_diaphane(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

/// The same, with a terminal in the place of stderr: `err` is what it was sent.
Finished run_diaphane_on_terminal(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

/// What a person does once a text has come.
struct Typed {
  std::string after;
  std::string keys;
};

/// The same in a terminal of 40 columns and 12 rows: `out` is what it was sent. What is typed is awaited in turn; a
/// minute after the start the program is killed.
Finished run_diaphane_in_terminal(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                                  const std::vector<Typed>& typed);

std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, const std::string& text);

/// A cube as an OBJ file: 8 vertices, 6 quads, from -1 to 1.
std::string cube_obj();

}  // namespace diaphane::testing_support

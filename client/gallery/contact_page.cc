// Makes a contact sheet, as a page and as one picture, of what render_folder left.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "CLI/CLI.hpp"
#include "fmt/format.h"
#include "gallery/page.h"
#include "media/sheet.h"

namespace {

using namespace diaphane;
namespace fs = std::filesystem;

constexpr int kCell_px = 224;
constexpr int kColumns = 8;

// A line of results.tsv.
struct Result {
  std::string file;
  std::string picture;  // empty where it did not render
  std::string exit_code;
  std::string said;
};

absl::StatusOr<std::vector<Result>> read_results(const fs::path& path) {
  std::ifstream input(path);
  if (!input) return absl::NotFoundError(fmt::format("{}: cannot be read; were there mesh files?", path.string()));
  std::vector<Result> results;
  for (std::string line; std::getline(input, line);) {
    std::istringstream fields(line);
    Result result;
    if (!std::getline(fields, result.file, '\t') || !std::getline(fields, result.picture, '\t') ||
        !std::getline(fields, result.exit_code, '\t')) {
      return absl::InvalidArgumentError(fmt::format("{}: must have four fields a line, got '{}'", path.string(), line));
    }
    std::getline(fields, result.said);
    results.push_back(std::move(result));
  }
  return results;
}

absl::StatusOr<media::Picture> picture_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return media::decode_picture(bytes);
}

std::string html_of(const Result& result) {
  const std::string name = gallery::escaped(result.file);
  const std::string said = gallery::escaped(result.said);
  if (result.picture.empty()) {
    return fmt::format(
        "<figure><figcaption><b>{}</b> <span class=\"reason\">exit code {}: {}</span></figcaption></figure>\n", name,
        gallery::escaped(result.exit_code), said);
  }
  return fmt::format("<figure><img src=\"{0}\" alt=\"{1}\"><figcaption><b>{1}</b> {2}</figcaption></figure>\n",
                     gallery::escaped(result.picture), name, said);
}

absl::Status run(const fs::path& folder) {
  const absl::StatusOr<std::vector<Result>> results = read_results(folder / "results.tsv");
  if (!results.ok()) return results.status();
  const auto rendered =
      std::count_if(results->begin(), results->end(), [](const Result& r) { return !r.picture.empty(); });
  const std::string count = fmt::format("{} mesh files: {} render, {} do not, each with the reason that it gave.",
                                        results->size(), rendered, results->size() - static_cast<size_t>(rendered));
  std::string html =
      gallery::page_head("Diaphane: contact sheet") +
      fmt::format("<p>{}</p>\n<div class=\"row\" style=\"grid-template-columns: repeat(5, 1fr)\">\n", count);
  std::vector<media::Cell> cells;
  for (const Result& result : *results) {
    html += html_of(result);
    if (result.picture.empty()) {
      cells.push_back({media::filled(kCell_px, kCell_px, {52, 46, 40}), result.file + ": none"});
      continue;
    }
    absl::StatusOr<media::Picture> picture = picture_of(folder / result.picture);
    if (!picture.ok()) return picture.status();
    cells.push_back({*std::move(picture), fs::path(result.file).filename().string()});
  }
  if (absl::Status written = gallery::write_text(folder / "index.html", html + "</div>\n</body>\n</html>\n");
      !written.ok()) {
    return written;
  }
  const absl::StatusOr<media::Picture> sheet =
      media::contact_sheet({&cells, 1}, {.cell_px = kCell_px, .columns = kColumns, .labels = true});
  if (!sheet.ok()) return sheet.status();
  if (absl::Status written = media::write_png(*sheet, folder / "sheet.png"); !written.ok()) return written;
  std::cout << count << "\n" << (folder / "index.html").string() << "\n" << (folder / "sheet.png").string() << "\n";
  return absl::OkStatus();
}

}  // namespace

int main(int argc, char** argv) {
  fs::path folder;
  CLI::App app{"Makes index.html and sheet.png of what render_folder left."};
  app.add_option("DIR", folder, "With results.tsv and its pictures")->required();
  CLI11_PARSE(app, argc, argv);
  const absl::Status status = run(folder);
  if (!status.ok()) std::cerr << "diaphane-contact-page: " << std::string(status.message()) << "\n";
  return status.ok() ? 0 : 1;
}

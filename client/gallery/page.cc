#include "gallery/page.h"

#include <fstream>

#include "fmt/format.h"

namespace diaphane::gallery {
namespace {

namespace fs = std::filesystem;

constexpr char kStyle[] = R"(
  body { background: #29292b; color: #dcdcde; font: 16px/1.5 sans-serif; margin: 0 auto; max-width: 1320px;
         padding: 1em 1.5em 4em; }
  h1, h2 { font-weight: normal; color: #fff; }
  h2 { border-top: 1px solid #555; margin-top: 2.5em; padding-top: 1em; }
  p { max-width: 54em; }
  a { color: #e0b070; }
  nav a { margin-right: 1.2em; }
  .row { display: grid; gap: 10px; margin: 10px 0; justify-content: start; }
  figure { margin: 0; }
  figure img { display: block; max-width: 100%; height: auto; }
  figcaption { color: #b4b4b8; font-size: 13px; line-height: 1.35; padding-top: 4px; }
  table { border-collapse: collapse; font-size: 14px; margin: 1em 0; }
  th, td { border-bottom: 1px solid #555; padding: 3px 14px 3px 0; text-align: left; }
  .reason { color: #e0b070; }
)";

std::string html_of(const Shot& shot) {
  return fmt::format(
      R"(<figure><img src="{0}.png" width="{1}" height="{2}" alt="{3}"><figcaption>{3}</figcaption></figure>
)",
      escaped(shot.name), shot.picture.width_px, shot.picture.height_px, escaped(shot.caption));
}

std::string html_of(const std::vector<std::vector<std::string>>& table) {
  if (table.empty()) return "";
  std::string html = "<table>\n";
  for (size_t row = 0; row < table.size(); ++row) {
    html += "<tr>";
    for (const std::string& cell : table[row])
      html += fmt::format("<{0}>{1}</{0}>", row == 0 ? "th" : "td", escaped(cell));
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string html_of(const Section& section) {
  std::string html = fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", escaped(section.id), escaped(section.title));
  for (const std::string& paragraph : section.paragraphs) html += fmt::format("<p>{}</p>\n", escaped(paragraph));
  for (const std::vector<Shot>& row : section.rows) {
    html += fmt::format("<div class=\"row\" style=\"grid-template-columns: repeat({}, minmax(0, max-content))\">\n",
                        row.size());
    for (const Shot& shot : row) html += html_of(shot);
    html += "</div>\n";
  }
  return html + html_of(section.table) + "</section>\n";
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

absl::Status write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (file.flush()) return absl::OkStatus();
  return absl::DataLossError(fmt::format("{}: cannot be written", path.string()));
}

std::string page_head(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n"
      "<h1>{0}</h1>\n",
      escaped(title), kStyle);
}

absl::Status write_page(const fs::path& folder, const std::string& title, const std::string& introduction,
                        const std::vector<Section>& sections) {
  std::string html = page_head(title) + fmt::format("<p>{}</p>\n<nav>", escaped(introduction));
  nlohmann::json facts;
  for (const Section& section : sections) {
    html += fmt::format("<a href=\"#{}\">{}</a>\n", escaped(section.id), escaped(section.title));
    facts[section.id] = section.facts;
  }
  html += "</nav>\n";
  for (const Section& section : sections) {
    html += html_of(section);
    for (const std::vector<Shot>& row : section.rows) {
      for (const Shot& shot : row) {
        if (absl::Status written = media::write_png(shot.picture, folder / (shot.name + ".png")); !written.ok()) {
          return written;
        }
      }
    }
  }
  if (absl::Status written = write_text(folder / "figures.json", facts.dump(2) + "\n"); !written.ok()) return written;
  return write_text(folder / "index.html", html + "</body>\n</html>\n");
}

}  // namespace diaphane::gallery

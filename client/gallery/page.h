// The gallery's page: pictures with words beside them, as plain HTML.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "media/picture.h"
#include "nlohmann/json.hpp"

namespace diaphane::gallery {

struct Shot {
  std::string name;  ///< of its file, without .png
  media::Picture picture;
  std::string caption;
};

/// One figure of the page. Text is plain: it is escaped.
struct Section {
  std::string id;
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<std::vector<Shot>> rows;              ///< side by side; rows of one length stand in columns
  std::vector<std::vector<std::string>> table;      ///< the first row is its head; may be empty
  nlohmann::json facts = nlohmann::json::object();  ///< what was measured, for figures.json
};

/// "page.html" escaped for text and attributes.
std::string escaped(const std::string& text);

/// Writes index.html, every picture, and figures.json, whose keys are the sections' ids, into a folder that is there.
///
/// Errors: DATA_LOSS, with the path, when a file cannot be written.
absl::Status write_page(const std::filesystem::path& folder, const std::string& title, const std::string& introduction,
                        const std::vector<Section>& sections);

/// Errors: DATA_LOSS, with the path.
absl::Status write_text(const std::filesystem::path& path, const std::string& text);

/// The head of a page up to and with its title, in this gallery's style.
std::string page_head(const std::string& title);

}  // namespace diaphane::gallery

// XML reader, a wrapper of tinyxml2.
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "base/input_file.h"
#include "mjcf/element.h"

namespace taut::mjcf {
namespace {

constexpr std::size_t kMostBytes = 64 << 20;
constexpr std::size_t kMostElements = 50'000;
constexpr int kMostFiles = 100;
/// Limit of the nesting depth, summed over included files, because the reader is recursive. The
/// library limits the depth of each file only.
constexpr int kDeepest = 500;
/// Limit of attributes: the library compares each one with all previous ones of the element.
constexpr std::size_t kMostAttributes = 200;  // per element

/// Number of elements, comments and declarations of a text, and the largest number of attributes of
/// an element. Counted without parsing; exact for valid XML.
struct MarkupCount {
  std::size_t nodes = 0, attributes = 0;
  std::size_t crowded_at = 0;  ///< Position of the element with the most attributes.
};

MarkupCount CountMarkup(std::string_view text) {
  MarkupCount count;
  const auto after = [&](std::size_t at, std::string_view end) {
    const std::size_t found = text.find(end, at);
    return found == text.npos ? text.size() : found + end.size();
  };
  for (std::size_t at = 0; (at = text.find('<', at)) != text.npos;) {
    const std::string_view tag = text.substr(at);
    if (tag.starts_with("</")) {
      ++at;
      continue;
    }
    ++count.nodes;
    if (tag.starts_with("<!--")) {
      at = after(at + 4, "-->");
    } else if (tag.starts_with("<![CDATA[")) {
      at = after(at + 9, "]]>");
    } else if (tag.starts_with("<?") || tag.starts_with("<!")) {
      at = after(at, tag[1] == '?' ? "?>" : ">");
    } else {
      const std::size_t begin = at;
      std::size_t attributes = 0;
      char quote = '\0';
      for (++at; at < text.size() && (quote != '\0' || text[at] != '>'); ++at) {
        const char c = text[at];
        if (quote != '\0') {
          if (c == quote) quote = '\0';
        } else if (c == '"' || c == '\'') {
          quote = c;
          ++attributes;
        }
      }
      if (attributes > count.attributes) count.attributes = attributes, count.crowded_at = begin;
    }
  }
  return count;
}

class XmlReader {
 public:
  XmlReader(const std::string& path, std::vector<std::string>& files, Diagnostics& out)
      : folder_(std::filesystem::path(path).parent_path()), files_(files), out_(out) {}

  std::optional<Element> Read(const std::string& path) {
    const auto text =
        base::ReadInputFile(path, kMostBytes, "expected an MJCF model", out_,
                            files_.empty() ? base::NamedBy::kUser : base::NamedBy::kFile);
    if (!text) return std::nullopt;
    files_.push_back(path);
    if (std::any_of(text->begin(), text->end(), base::IsControl)) {
      out_.Error("mjcf.control_character", {path}, "the file contains control characters");
      return std::nullopt;
    }
    if (!Fits(*text, path)) return std::nullopt;
    tinyxml2::XMLDocument document;
    if (document.Parse(text->data(), text->size()) != tinyxml2::XML_SUCCESS ||
        document.RootElement() == nullptr) {
      const bool empty = document.ErrorID() == tinyxml2::XML_ERROR_EMPTY_DOCUMENT;
      out_.Error("mjcf.not_xml", {path, empty ? 0 : document.ErrorLineNum()},
                 empty ? "the file is empty" : "the file is not valid XML: " + Why(document));
      return std::nullopt;
    }
    if (document.RootElement()->NextSiblingElement() != nullptr) {
      out_.Error("mjcf.second_root",
                 {path, document.RootElement()->NextSiblingElement()->GetLineNum()},
                 "the file has a second root element");
      return std::nullopt;
    }
    Element root;
    return Take(*document.RootElement(), path, root) ? std::optional(std::move(root))
                                                     : std::nullopt;
  }

 private:
  /// Returns whether the number of elements, in this text and all texts before it, and of
  /// attributes is within the limits. Called before the library parses the text. Parsing takes 20
  /// times the memory of the text, and time proportional to the square of an element's attributes.
  bool Fits(std::string_view text, const std::string& path) {
    const MarkupCount count = CountMarkup(text);
    elements_ += count.nodes;
    if (elements_ > kMostElements) {
      out_.Error("mjcf.too_many_elements", {path},
                 "the model has more than " + std::to_string(kMostElements) +
                     " elements and comments in all files up to this one");
    } else if (count.attributes > kMostAttributes) {
      const auto from = text.begin(), to = from + static_cast<std::ptrdiff_t>(count.crowded_at);
      out_.Error("mjcf.too_many_attributes",
                 {path, 1 + static_cast<int>(std::count(from, to, '\n'))},
                 "an element has more than " + std::to_string(kMostAttributes) + " attributes");
    } else {
      return true;
    }
    return false;
  }

  static std::string Why(const tinyxml2::XMLDocument& document) {
    const std::string id = tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID());
    if (document.ErrorID() == tinyxml2::XML_ERROR_MISMATCHED_ELEMENT) {
      return "the end tag of an element has another name";
    }
    if (document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED) {
      return "elements are nested too deeply";
    }
    if (document.ErrorID() == tinyxml2::XML_ERROR_PARSING_ATTRIBUTE) {
      return "an attribute is not key=\"value\", or occurs twice";
    }
    std::string words;  // XML_ERROR_PARSING_ELEMENT becomes "parsing element"
    for (const char c : id.substr(id.rfind("ERROR_") == id.npos ? 0 : id.rfind("ERROR_") + 6)) {
      words += c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return words;
  }

  bool Take(const tinyxml2::XMLElement& from, const std::string& path, Element& to) {
    if (depth_ >= kDeepest) {
      out_.Error("mjcf.too_deep", {path, from.GetLineNum()},
                 "elements are nested more than " + std::to_string(kDeepest) +
                     " levels deep, across all files");
      return false;
    }
    to.name = from.Name();
    to.at = {path, from.GetLineNum(), 0};
    for (const auto* a = from.FirstAttribute(); a != nullptr; a = a->Next()) {
      const SourceRef at{path, a->GetLineNum(), 0};
      const std::string value = a->Value();
      if (std::any_of(value.begin(), value.end(), base::IsControl)) {
        out_.Error("mjcf.control_character", at,
                   to.name + "." + a->Name() + " contains control characters");
        return false;
      }
      to.attributes.push_back({a->Name(), value, at});
    }
    ++depth_;
    for (const auto* c = from.FirstChildElement(); c != nullptr; c = c->NextSiblingElement()) {
      if (std::string_view(c->Name()) == "include") {
        if (!Include(*c, path, to)) return false;
      } else if (!Take(*c, path, to.children.emplace_back())) {
        return false;
      }
    }
    --depth_;
    return true;
  }

  /// Inserts the children of the included file's root into `to`.
  bool Include(const tinyxml2::XMLElement& include, const std::string& path, Element& to) {
    const SourceRef at{path, include.GetLineNum(), 0};
    const char* const name = include.Attribute("file");
    if (name == nullptr) {
      out_.Error("mjcf.include_without_file", at, "include has no attribute file");
      return false;
    }
    const std::string file = (folder_ / name).lexically_normal().string();
    if (std::find(files_.begin(), files_.end(), file) != files_.end()) {
      out_.Error("mjcf.included_twice", at, "\"" + file + "\" is included twice");
      return false;
    }
    if (files_.size() >= static_cast<std::size_t>(kMostFiles)) {
      out_.Error("mjcf.too_many_files", at,
                 "the model has more than " + std::to_string(kMostFiles) + " files");
      return false;
    }
    auto root = Read(file);
    if (!root) {
      out_.Error("mjcf.include_not_read", at, "the included file cannot be read");
      return false;
    }
    for (Element& child : root->children) to.children.push_back(std::move(child));
    return true;
  }

  const std::filesystem::path
      folder_;  ///< Folder of the main file; all included paths are relative to it.
  std::vector<std::string>& files_;
  Diagnostics& out_;
  std::size_t elements_ = 0;
  int depth_ = 0;
};

}  // namespace

std::optional<Element> ReadXml(const std::string& path, std::vector<std::string>& files,
                               Diagnostics& out) {
  return XmlReader(path, files, out).Read(path);
}

}  // namespace taut::mjcf

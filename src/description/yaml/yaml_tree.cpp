#include "description/yaml/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <unordered_map>
#include <unordered_set>

#include "base/input_file.h"

namespace taut::description {
namespace {

std::string ControlText(char c) {
  return "the control character " + std::to_string(static_cast<int>(c)) + " is not allowed";
}

constexpr const char* kControlHint =
    "expected UTF-8 without control characters except tabs and line ends";

/// Thrown at the first error that ends parsing; caught in this file.
struct StopReading {};

/// Builds the tree from parser events. Unlike YAML::Node, events give every position and show
/// duplicate keys and aliases. They also permit limits during reading.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string file, Diagnostics& out) : file_(std::move(file)), out_(out) {}

  ValuePtr root() const { return root_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (root_)
      Stop("yaml.several_documents", mark, "the file has more than one YAML document",
           "remove the `---` between them");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Finish(NewValue(mark, Value::Kind::kNull), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end())
      Stop("yaml.circular_anchor", mark, "a YAML anchor must not contain itself");
    Place(found->second, At(mark));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    CheckTag(mark, tag);
    // Control characters from an escape sequence in quotes. `ParseYaml` has already rejected raw
    // ones.
    if (const auto bad = std::find_if(text.begin(), text.end(), base::IsControl);
        bad != text.end()) {
      out_.Error("yaml.control_character", At(mark), ControlText(*bad), kControlHint);
    }
    auto value = NewValue(mark, Value::Kind::kScalar);
    value->text = text;
    value->quoted = tag == "!";  // yaml-cpp's non-specific tags: "!" quoted, "?" plain
    Finish(std::move(value), anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    Open(mark, tag, anchor, Value::Kind::kSequence);
  }
  void OnSequenceEnd() override { Close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    Open(mark, tag, anchor, Value::Kind::kMap);
  }
  void OnMapEnd() override {
    ResolveMerges(*open_.back().value);
    Close();
  }

 private:
  struct Frame {
    std::shared_ptr<Value> value;
    YAML::anchor_t anchor;
    std::optional<Entry> entry;  ///< Key of a map that still has no value.
  };

  SourceRef At(const YAML::Mark& mark) const { return {file_, mark.line + 1, mark.column + 1}; }

  [[noreturn]] void Stop(MessageId id, const YAML::Mark& mark, std::string what,
                         std::string hint = {}) {
    out_.Error(id, At(mark), std::move(what), std::move(hint));
    throw StopReading{};
  }

  void CheckTag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    out_.Error("yaml.tag", At(mark), "YAML tag \"" + tag + "\" is not allowed");
  }

  std::shared_ptr<Value> NewValue(const YAML::Mark& mark, Value::Kind kind) const {
    auto value = std::make_shared<Value>();
    value->kind = kind;
    value->at = At(mark);
    return value;
  }

  void Open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
            Value::Kind kind) {
    CheckTag(mark, tag);
    if (static_cast<int>(open_.size()) >= kMaxYamlDepth) {
      Stop("yaml.too_deep", mark,
           "the file is nested more than " + std::to_string(kMaxYamlDepth) + " levels deep");
    }
    open_.push_back({NewValue(mark, kind), anchor, std::nullopt});
  }

  void Close() {
    Frame frame = std::move(open_.back());
    open_.pop_back();
    Finish(std::move(frame.value), frame.anchor);
  }

  void Finish(std::shared_ptr<Value> value, YAML::anchor_t anchor) {
    const SourceRef at = value->at;
    if (anchor != 0) anchors_[anchor] = value;
    Place(std::move(value), at);
  }

  /// Rejects `radius_m: 0,1` in a flow map: YAML parses `1` as a key without a value.
  void RefuseDecimalComma(const Value& map, const Entry& entry, const Value& value) {
    const bool is_number = entry.key.find_first_not_of("0123456789") == std::string::npos;
    if (!is_number || value.kind != Value::Kind::kNull || map.entries.empty()) return;
    const Value& before = *map.entries.back().value;
    if (!IsRightAfter(before, entry.key_at)) return;
    out_.Error("yaml.decimal_comma", entry.key_at,
               "\"" + before.text + "," + entry.key + "\" is not a number",
               "write decimal fractions with a point, and a space after each comma");
    throw StopReading{};
  }

  /// Adds a complete value to the innermost list or map that is still open.
  void Place(ValuePtr value, const SourceRef& at) {
    if (open_.empty()) {
      root_ = std::move(value);
      return;
    }
    Frame& parent = open_.back();
    Count(*parent.value, value->node_count, at);
    if (parent.value->kind == Value::Kind::kSequence) {
      parent.value->items.push_back(std::move(value));
    } else if (!parent.entry) {
      if (value->kind != Value::Kind::kScalar) {
        out_.Error("yaml.key_not_text", at,
                   "a key must be a text, not " + std::string(KindName(*value)));
        throw StopReading{};
      }
      parent.entry = Entry{value->text, at, nullptr};
    } else {
      RefuseDecimalComma(*parent.value, *parent.entry, *value);
      parent.entry->value = std::move(value);
      parent.value->entries.push_back(std::move(*parent.entry));
      parent.entry.reset();
    }
  }

  /// Returns whether there is only a comma between a number and a position, as in `0,5`.
  static bool IsRightAfter(const Value& number, const SourceRef& at) {
    return number.kind == Value::Kind::kScalar && !number.text.empty() &&
           number.text.back() >= '0' && number.text.back() <= '9' && number.at.line == at.line &&
           number.at.column + static_cast<int>(number.text.size()) + 1 == at.column;
  }

  void Count(Value& parent, std::size_t more, const SourceRef& at) {
    parent.node_count += more;
    if (parent.node_count <= kMaxYamlNodes) return;
    out_.Error("yaml.too_many_nodes", at,
               "the file has more than " + std::to_string(kMaxYamlNodes) + " YAML nodes",
               "an alias counts once for each use");
    throw StopReading{};
  }

  /// Reports duplicate keys. Replaces each merge key `<<` by the entries of its map.
  void ResolveMerges(Value& map) {
    std::vector<Entry> own, merges;
    std::unordered_map<std::string, SourceRef> seen;
    for (Entry& entry : map.entries) {
      const auto [first, fresh] = seen.emplace(entry.key, entry.key_at);
      if (!fresh) {
        out_.Error("key.duplicate", entry.key_at, "duplicate key \"" + entry.key + "\"",
                   "first in line " + std::to_string(first->second.line));
        continue;
      }
      (entry.key == "<<" ? merges : own).push_back(std::move(entry));
    }
    map.entries = std::move(own);
    for (const Entry& merge : merges) {
      if (merge.value->kind == Value::Kind::kMap) {
        MergeInto(map, *merge.value, seen);
      } else if (merge.value->kind == Value::Kind::kSequence) {
        for (const ValuePtr& item : merge.value->items) {
          if (item->kind == Value::Kind::kMap) {
            MergeInto(map, *item, seen);
          } else {
            out_.Error("yaml.merge_needs_map", item->at,
                       "`<<` needs a map, not " + std::string(KindName(*item)));
          }
        }
      } else {
        out_.Error("yaml.merge_needs_map", merge.key_at,
                   "`<<` needs a map, not " + std::string(KindName(*merge.value)));
      }
    }
  }

  /// Existing keys take precedence, as YAML specifies for merge keys.
  static void MergeInto(Value& map, const Value& other,
                        std::unordered_map<std::string, SourceRef>& seen) {
    for (const Entry& entry : other.entries) {
      if (seen.emplace(entry.key, entry.key_at).second) map.entries.push_back(entry);
    }
  }

  std::string file_;
  Diagnostics& out_;
  std::vector<Frame> open_;
  std::unordered_map<YAML::anchor_t, ValuePtr> anchors_;
  ValuePtr root_;
};

}  // namespace

const Value* Value::Find(std::string_view key) const {
  for (const Entry& entry : entries) {
    if (entry.key == key) return entry.value.get();
  }
  return nullptr;
}

std::string_view KindName(const Value& value) {
  switch (value.kind) {
    case Value::Kind::kNull:
      return "nothing";
    case Value::Kind::kScalar:
      return "a text";
    case Value::Kind::kSequence:
      return "a list";
    case Value::Kind::kMap:
      return "a map";
  }
  return "";
}

ValuePtr ParseYaml(const std::string& text, const std::string& file, Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  if (const auto bad = std::find_if(text.begin(), text.end(), base::IsControl); bad != text.end()) {
    const auto before = static_cast<std::size_t>(bad - text.begin());
    const std::size_t line_end = text.rfind('\n', before);
    const std::size_t line_begin = line_end == std::string::npos ? 0 : line_end + 1;
    const auto line = 1 + std::count(text.begin(), bad, '\n');
    out.Error("yaml.control_character",
              {file, static_cast<int>(line), static_cast<int>(before - line_begin) + 1},
              ControlText(*bad), kControlHint);
    return nullptr;
  }
  TreeBuilder builder(file, out);
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const StopReading&) {
    return nullptr;
  } catch (const YAML::Exception& error) {
    out.Error("yaml.invalid", {file, error.mark.line + 1, error.mark.column + 1},
              "the file is not valid YAML: " + error.msg);
    return nullptr;
  } catch (const std::bad_alloc&) {
    throw;                                 // not caused by the file
  } catch (const std::exception& error) {  // an error inside yaml-cpp
    out.Error("yaml.unreadable", {file, 0, 0},
              std::string("the file cannot be read as YAML: ") + error.what());
    return nullptr;
  }
  if (!builder.root()) out.Error("yaml.empty", {file, 1, 1}, "the file is empty");
  return out.items().size() == errors_before ? builder.root() : nullptr;
}

ValuePtr ReadYaml(const std::string& path, Diagnostics& out) {
  const auto text = base::ReadInputFile(
      path, kMaxFileBytes, "write repeated parts once, with `copies:`", out, base::NamedBy::kUser);
  return text ? ParseYaml(*text, path, out) : nullptr;
}

}  // namespace taut::description

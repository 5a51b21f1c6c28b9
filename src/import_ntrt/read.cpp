// Reader of NTRT's structure files and their includes, by the rules of NTRT's TensegrityModel.cpp
// at f0c52e93.
#include "import_ntrt/read.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/input_file.h"
#include "description/yaml/reader.h"
#include "import_ntrt/turn.h"

namespace taut::import_ntrt {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 32;  // nesting depth of included files
constexpr std::size_t kMostStructures = 2000;
constexpr std::size_t kMostHinted = 300;  // limit of names to compare for a hint

const description::NameTable kNoNames;

class Reader {
 public:
  Reader(const NtrtOptions& options, Model& model, Diagnostics& out)
      : in_{options, model, out}, model_(model), out_(out) {}

  void Run(const std::string& path) {
    AddDefaultBuilders(model_);
    Structure top;
    top.file = path;
    model_.structures.push_back(top);
    Build(0, path);
    model_.counts.files = static_cast<int>(files_.size());
  }

 private:
  struct File {
    ValuePtr root;
    int percent_lines = 0;
  };

  /// Opens and parses a file once. The root is null after an error.
  const File& Open(const std::string& path) {
    const auto [found, fresh] = files_.emplace(path, File{});
    File& file = found->second;
    if (!fresh) return file;
    auto text =
        base::ReadInputFile(path, description::kMaxFileBytes, "", out_,
                            files_.size() == 1 ? base::NamedBy::kUser : base::NamedBy::kFile);
    if (!text) return file;
    file.percent_lines = TreatPercent(path, *text);
    file.root = description::ParseYaml(*text, path, out_);
    if (!file.root) return file;
    if (file.root->kind != Value::Kind::kMap) {
      out_.Error(
          "ntrt.not_a_map", file.root->at,
          "an NTRT structure must be a map, not " + std::string(description::KindName(*file.root)));
      file.root = nullptr;
      return file;
    }
    OnlyKeys(*file.root, {"nodes", "pair_groups", "builders", "substructures", "bond_groups"},
             out_);
    return file;
  }

  /// Handles lines that begin with `%`, which are directives in YAML. They are valid at the head of
  /// a file. Elsewhere, they end the document.
  int TreatPercent(const std::string& path, std::string& text) const {
    int count = 0, line = 1;
    bool at_head = true;
    for (std::size_t begin = 0; begin < text.size(); ++line) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::size_t first = std::min(text.find_first_not_of(" \t\r", begin), end);
      if (text[begin] == '%' && !at_head) {
        ++count;
        const bool cut = in_.options.like_ntrt;
        out_.Warning(
            "ntrt.percent_line", {path, line, 1},
            cut ? "a line that begins with % ends the file, as in NTRT: the rest is ignored"
                : "a line that begins with % is read as a comment; NTRT ends the file there and "
                  "ignores the rest",
            "begin comments with #" +
                std::string(cut ? "" : "; --like_ntrt ignores the rest, too"));
        if (cut) {
          text.resize(begin);
          return count;
        }
        text[begin] = '#';
      }
      const bool is_blank = first == end || text[first] == '#' || text[begin] == '%';
      at_head = at_head && is_blank;
      begin = end + 1;
    }
    return count;
  }

  void Build(int structure, const std::string& path) {
    const File& file = Open(path);
    model_.counts.lines_with_percent += file.percent_lines;
    if (!file.root) return;
    const Value& root = *file.root;
    AddChildren(structure, path, root.Find("substructures"));
    ReadBuilders(in_, root.Find("builders"));
    if (!model_.full) AddNodes(structure, root.Find("nodes"));
    if (model_.full) return;  // stop, otherwise thousands of files or lines would repeat the error
    for (const Entry& group : MapOf(root.Find("pair_groups"), "pair_groups", out_)) {
      for (const ValuePtr& item : ListOf(group.value.get(), group.key, out_)) {
        std::string a, b;
        if (model_.full) return;
        if (!ReadTwo(*item, a, b, out_)) continue;
        const int from = NodeAt(in_, structure, a, item->at);
        const int to = NodeAt(in_, structure, b, item->at);
        if (from < 0 || to < 0) continue;
        AddPair(in_, structure, from, to, Split(group.key), item->at);
      }
    }
    ReadBonds(in_, structure, root.Find("bond_groups"));
  }

  void AddNodes(int structure, const Value* nodes) {
    for (const Entry& entry : MapOf(nodes, "nodes", out_)) {
      Node node;
      node.tags = Split(entry.key);
      node.at = entry.key_at;
      node.structure = structure;
      node.in_file = node.place = ReadPoint(*entry.value, entry.key, out_);
      if (node.tags.empty()) {
        out_.Error("ntrt.unnamed_node", entry.key_at, "a node needs a name");
        continue;
      }
      if (model_.nodes.size() >= kMostItems) {
        model_.full = true;
        out_.Error("ntrt.too_many_nodes", entry.key_at,
                   "the structure has more than " + std::to_string(kMostItems) + " nodes");
        return;
      }
      in_.structure(structure).nodes.push_back(static_cast<int>(model_.nodes.size()));
      model_.nodes.push_back(std::move(node));
    }
  }

  void AddChildren(int structure, const std::string& path, const Value* children) {
    const std::vector<Entry>& entries = MapOf(children, "substructures", out_);
    for (const Entry& entry : entries) {
      MapOf(entry.value.get(), entry.key, out_);
      OnlyKeys(*entry.value, {"path", "rotation", "translation", "scale", "offset"}, out_);
      for (const std::string& name : AtSlashes(entry.key)) {
        if (model_.full) return;
        AddChild(structure, path, name, entry);
      }
    }
    if (model_.full) return;
    // NTRT's order: first the rotations of all keys, then scale, offset and translation of each
    // key.
    for (const Entry& entry : entries) {
      ForNamed(structure, entry, [&](int child, int) {
        if (const Value* turn = entry.value->Find("rotation")) Rotate(child, *turn);
      });
    }
    for (const Entry& entry : entries) {
      const Value* scale = entry.value->Find("scale");
      const Value* offset = entry.value->Find("offset");
      const Value* shift = entry.value->Find("translation");
      const double factor = scale ? ReadPlain(*scale, "scale", out_) : 1.0;
      if (scale && !(factor > 0) && !std::isnan(factor)) {
        out_.Error("ntrt.bad_scale", scale->at, "scale must be positive");
      }
      const Vec3 step = offset ? ReadPoint(*offset, "offset", out_) : Vec3{};
      const Vec3 by = shift ? ReadPoint(*shift, "translation", out_) : Vec3{};
      ForNamed(structure, entry, [&](int child, int index) {
        if (scale) model_.Scale(child, factor);
        if (offset) model_.Shift(child, static_cast<double>(index) * step);
        if (shift) model_.Shift(child, by);
      });
    }
  }

  void AddChild(int parent, const std::string& parent_path, const std::string& name,
                const Entry& entry) {
    const Value* const path = entry.value->Find("path");
    if (!path) return;
    const auto file = description::FindFile(path, "path", {kNoNames, out_});
    if (!file) return;
    std::error_code ignored;
    const std::string real = fs::weakly_canonical(*file, ignored).string();
    if (open_.empty()) open_.push_back(fs::weakly_canonical(parent_path, ignored).string());
    if (std::find(open_.begin(), open_.end(), real) != open_.end()) {
      out_.Error("ntrt.circular_include", path->at, "the file includes itself");
      return;
    }
    if (open_.size() >= kDeepest || model_.structures.size() >= kMostStructures) {
      out_.Error("ntrt.too_deep", path->at,
                 open_.size() >= kDeepest
                     ? "files include files more than " + std::to_string(kDeepest) + " levels deep"
                     : "the structure has more than " + std::to_string(kMostStructures) +
                           " substructures");
      model_.full = true;
      return;
    }
    Structure child;
    child.tags = Split(name);
    if (child.tags.empty()) {
      out_.Error("ntrt.unnamed_substructure", entry.key_at, "a substructure needs a name");
      return;
    }
    child.parent = parent;
    child.file = *file;
    child.at = entry.key_at;
    const int index = static_cast<int>(model_.structures.size());
    model_.structures.push_back(child);
    open_.push_back(real);
    Build(index, *file);
    open_.pop_back();
    // Add the child last, because NTRT adds a child to its parent when the child is complete.
    in_.structure(parent).children.push_back(index);
  }

  template <class F>
  void ForNamed(int structure, const Entry& entry, const F& visit) {
    int index = 0;
    for (const std::string& name : AtSlashes(entry.key)) {
      const int child = model_.FindChild(structure, name);
      if (child >= 0) {
        visit(child, index);
      } else if (model_.ComparedTooMuch()) {
        return;                                 // the limit is reported once, at the end
      } else if (!entry.value->Find("path")) {  // a missing file has been reported
        out_.Error("ntrt.unknown_substructure", entry.key_at,
                   "there is no substructure \"" + name + "\"",
                   "one of its entries needs a `path`");
      }
      ++index;
    }
  }

  void Rotate(int child, const Value& rotation) {
    if (MapOf(&rotation, "rotation", out_).empty()) return;
    OnlyKeys(rotation, {"axis", "angle", "reference"}, out_);
    const Value *axis = rotation.Find("axis"), *angle = rotation.Find("angle");
    if (!axis || !angle) {
      out_.Warning("ntrt.rotation_without_effect", rotation.at,
                   "a rotation without axis and angle has no effect, as in NTRT",
                   "give both, or leave out `rotation`");
      return;
    }
    const Vec3 about = ReadPoint(*axis, "axis", out_);
    const double degrees = ReadPlain(*angle, "angle", out_);
    const Value* const reference = rotation.Find("reference");
    const Vec3 fixed =
        reference ? ReadPoint(*reference, "reference", out_) : model_.Centroid(child);
    if (Dot(about, about) == 0.0) {
      out_.Error("ntrt.zero_axis", axis->at, "the axis of a rotation must not be zero");
      return;
    }
    model_.Turn(child, fixed, About(about, degrees / 180.0 * std::acos(-1.0)));
  }

  Reading in_;
  Model& model_;
  Diagnostics& out_;
  std::map<std::string, File> files_;
  std::vector<std::string> open_;
};

}  // namespace

int NodeAt(const Reading& in, int structure, const std::string& path, const SourceRef& at) {
  std::string left = path;
  for (std::size_t dot; (dot = left.find('.')) != left.npos; left = left.substr(dot + 1)) {
    const std::string name = left.substr(0, dot);
    structure = in.model.FindChild(structure, name);
    if (structure >= 0) continue;
    if (in.model.ComparedTooMuch()) return -1;  // the limit is reported once, at the end
    in.out.Error("ntrt.unknown_substructure", at,
                 "there is no substructure \"" + name + "\" for the node \"" + path + "\"");
    return -1;
  }
  const int node = in.model.FindNode(structure, left);
  if (node < 0 && !in.model.ComparedTooMuch()) {
    std::vector<std::string> names;
    for (const int i : in.structure(structure).nodes) {
      if (names.size() > kMostHinted) break;
      names.push_back(in.node(i).tags[0]);
    }
    in.out.Error("ntrt.unknown_node", at, "there is no node \"" + path + "\"",
                 names.empty() ? "" : description::NameHint(left, names));
  }
  return node;
}

void AddPair(const Reading& in, int structure, int from, int to, Words tags, const SourceRef& at) {
  if (in.model.full) return;
  if (in.model.pairs.size() >= kMostItems) {
    in.model.full = true;
    in.out.Error("ntrt.too_many_pairs", at,
                 "the structure has more than " + std::to_string(kMostItems) + " pairs");
    return;
  }
  in.structure(structure).pairs.push_back(static_cast<int>(in.model.pairs.size()));
  in.model.pairs.push_back({from, to, std::move(tags), at, structure});
}

std::optional<Model> ReadStructure(const std::string& path, const NtrtOptions& options,
                                   Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  Model model;
  Reader(options, model, out).Run(path);
  if (out.items().size() != errors_before) return std::nullopt;
  if (model.nodes.empty()) {
    out.Error("ntrt.no_nodes", {path, 1, 1}, "the structure has no nodes",
              "expected `nodes:`, or `substructures:` with nodes");
    return std::nullopt;
  }
  for (const Node& node : model.nodes) {
    const double farthest =
        std::max({std::fabs(node.place.x), std::fabs(node.place.y), std::fabs(node.place.z)});
    if (std::isfinite(node.place.x + node.place.y + node.place.z) && farthest <= kFarthest)
      continue;
    out.Error("ntrt.node_too_far", node.at,
              "the scales and rotations of its structures move this node too far away",
              "coordinates must be within 1e12");
    return std::nullopt;
  }
  return model;
}

}  // namespace taut::import_ntrt

// Loading and saving of gait files.
#include "description/gait/gait_keys.h"
#include "description/yaml/merged_file.h"
#include "description/yaml/read_keys.h"
#include "description/yaml/write_keys.h"
#include "taut/files.h"

namespace taut {

std::optional<GaitSpec> LoadGait(const std::string& path, Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  const description::MergedFile file = description::ReadMergedFile(path, "gait", out);
  if (!file.root) return std::nullopt;
  const description::NameTable names = description::ResolveParameters(file.parameters, out);
  description::GaitText gait;
  description::NameSet used;
  description::ReadMapping(*file.root, "", {names, out, &used}, gait);
  if (out.items().size() != errors_before) return std::nullopt;
  description::WarnOfUnused(file.parameters, std::move(used), file.files, out);
  gait.files = file.files;
  description::ForEachGaitKind([&](const auto& kind, auto number) {
    const auto& text = std::get<number()>(gait.texts);
    if (!text) return;
    gait.*kind.gait = *text;
    if constexpr (requires { text->files; }) {
      gait.files.insert(gait.files.end(), text->files.begin(), text->files.end());
    }
  });
  return gait;
}

std::string GaitYaml(const GaitSpec& gait) {
  description::GaitText text{gait, {}, {}};
  std::string more;
  description::ForEachGaitKind([&](const auto& kind, auto number) {
    const auto& spec = gait.*kind.gait;
    if (!spec) return;
    using Spec = typename std::remove_cvref_t<decltype(kind)>::Spec;
    static_cast<Spec&>(std::get<number()>(text.texts).emplace()) = *spec;
    more = description::LinesBesideKeys(*spec);
  });
  description::BlockWriter<false> writer("");
  Keys(writer, std::as_const(text));
  return "taut: 1\nkind: gait\n" + writer.text() + more;
}

bool SaveGait(const GaitSpec& gait, const std::string& path, Diagnostics& out) {
  return WriteWholeFile(path, GaitYaml(gait), out);
}

}  // namespace taut

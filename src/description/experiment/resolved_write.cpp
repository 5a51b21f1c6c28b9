// Writer of resolved experiments.
#include <filesystem>

#include "base/hash.h"
#include "description/experiment/resolved.h"
#include "description/experiment/resolved_keys.h"
#include "description/yaml/kinds.h"
#include "description/yaml/write_keys.h"
#include "taut/version.h"

namespace taut {

std::string ResolvedYaml(const ExperimentSpec& experiment) {
  std::string out = "# Made by taut ";
  out += kVersion;
  out += " from";
  for (const std::string& file : experiment.files) {
    out += ' ';
    out += description::Quoted(std::filesystem::path(file).filename().string());
  }
  out += "\n# (inputs " + base::HashText(experiment.input_hash) + "); repeats that run.\n";
  out += "taut: 1\nkind: ";
  out += description::kResolvedKind;
  out += '\n';
  ExperimentSpec portable = experiment;
  if (portable.compare_with) {  // make the path absolute, because the text may be stored in another
                                // folder
    std::error_code failed;
    const auto path = std::filesystem::absolute(*portable.compare_with, failed);
    if (!failed) portable.compare_with = path.string();
  }
  description::BlockWriter<true> writer("");
  description::Keys(writer, std::as_const(portable));
  return out + writer.text();
}

}  // namespace taut

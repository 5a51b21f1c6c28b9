/// What several subcommands write: complaints, files, the folder of a run.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "commands.h"
#include "taut/run.h"
#include "taut/run_folder.h"
#include "taut/spec.h"

namespace taut::cli {

/// Prints what was found on stderr. Returns `exit`.
int Fail(const Diagnostics& found, Exit exit);

/// Whether a command goes on with what it has read: prints warnings on stderr and forgets them.
/// `strict` makes errors of them; those, like all others, are left for `Fail`.
bool Pass(Diagnostics& found, bool strict);
/// The same without a word, for processes of which another one speaks.
bool Passes(Diagnostics& found, bool strict);

/// What `--strict` does, for help texts.
inline constexpr const char* kStrictHelp = "Warnings about files are errors";

/// Writes a file that the user named. Complains on stderr, returns the exit status.
int WriteNamed(const std::string& path, const std::string& text);

/// The same, or to standard output if there is no path.
int WriteOrPrint(const std::string& path, const std::string& text);

/// Runs an experiment into a folder: traces, inputs.yaml, summary.json. `options` come without
/// traces. Nothing, and a complaint, if it did not run; a file that could not be written is a
/// complaint, too, and then there is no summary.json. Warnings about the start are printed when it
/// is prepared; `options.begin` may refuse them before. `more`: what else the trace is to say of
/// itself.
std::optional<RunSummary> RunInto(RunFolder& folder, const ExperimentSpec& experiment,
                                  RunOptions options, bool csv, Diagnostics& out,
                                  const TraceMetadata& more = {});

/// Words of `--symmetry`.
inline const std::map<std::string, CpgSymmetry> kSymmetries{{"segments", CpgSymmetry::kSegments},
                                                            {"index", CpgSymmetry::kIndex},
                                                            {"none", CpgSymmetry::kNone}};

}  // namespace taut::cli

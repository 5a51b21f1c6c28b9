/// Lookup of shipped files (models, experiments, gaits, ...), wherever taut is installed.
///
/// Threads: any number may call these functions at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace taut {

/// Returns the path of the running program; empty if the system does not provide it.
std::string RunningProgram();
/// Sets the path that `RunningProgram` returns, for a command that is part of another program. Call
/// it before other threads start.
void SetRunningProgram(const std::string& path);

/// Returns the path of a file shipped with the running program. Looks, relative to the program's
/// folder, in this folder (build), `../share/taut` (installation), `share/taut` (Python package).
std::optional<std::string> FindBesideProgram(const std::string& path);

/// Returns the folder of the shipped files: `share/taut` in the folder of a program or library, or
/// in a parent folder. So it is found in a build, in a Python package and below /usr.
std::optional<std::string> ShippedFolder(const std::string& program = RunningProgram());

/// Returns the kinds of shipped files that commands read, which are also their folders: "models",
/// "experiments", "gaits", "studies", "fits".
const std::vector<std::string>& ShippedKinds();

/// Returns the path of an input file. A relative path that does not exist in the current folder is
/// looked up in the folder of the shipped files, so `experiments/push_20n.yaml` works everywhere.
/// The result of a lookup is absolute, or `share/experiments/push_20n.yaml` in a source tree. A
/// path that is not found is returned unchanged.
std::string FindInput(const std::string& path, const std::string& program = RunningProgram());

/// Returns `did you mean "experiments/push_20n.yaml"?` if a file with a similar name is in the same
/// folder or among the shipped files, else "". The extension may be absent in `path`.
std::string SimilarInput(const std::string& path, const std::string& program = RunningProgram());

}  // namespace taut

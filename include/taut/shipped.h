/// Paths of files that taut installs: models, experiments, gaits, ...
///
/// Threads: any number may call these functions concurrently.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace taut {

/// Returns the path of the running program; empty if unknown.
std::string RunningProgram();
/// Sets the result of `RunningProgram`, for a command that is part of another program. Call it
/// before other threads start.
void SetRunningProgram(const std::string& path);

/// Returns the path of a file installed with the running program. The function searches the folder
/// of the program (build), `../share/taut` (installation) and `share/taut` (Python package).
std::optional<std::string> FindBesideProgram(const std::string& path);

/// Returns the folder of the installed files: `share/taut` in the folder of a program or library,
/// or in a parent folder. The search works in a build, in a Python package and below /usr.
std::optional<std::string> ShippedFolder(const std::string& program = RunningProgram());

/// Returns the kinds of installed files that commands read. The kinds are also folder names:
/// "models", "experiments", "gaits", "studies", "fits".
const std::vector<std::string>& ShippedKinds();

/// Returns the path of an input file. A relative path without a file in the current folder refers
/// to the folder of installed files, so `experiments/push_20n.yaml` works everywhere. Such a result
/// is absolute, or `share/experiments/push_20n.yaml` in a source tree. A path that is not found is
/// returned unchanged.
std::string FindInput(const std::string& path, const std::string& program = RunningProgram());

/// Returns `did you mean "experiments/push_20n.yaml"?` if a file with a similar name is in the same
/// folder or among the installed files, otherwise "". `path` may lack the extension.
std::string SimilarInput(const std::string& path, const std::string& program = RunningProgram());

}  // namespace taut

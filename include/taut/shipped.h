/// The files that come with taut (models, experiments, gaits, ...), wherever it is installed.
///
/// Threads: any number may call these functions at once.
#pragma once

#include <optional>
#include <string>

namespace taut {

/// The folder of these files, as seen from a program or library: `share/taut` in its folder or in
/// one above, as in a build folder, in a Python package and below /usr. Nothing if there is none.
std::optional<std::string> ShippedFolder(const std::string& program);

/// The same for the running program.
std::optional<std::string> ShippedFolder();

/// A user's path to an input file. A relative path to nothing in the current folder is looked up
/// among the files that come with taut, so `experiments/push_20n.yaml` works everywhere; the result
/// is absolute, or in a source tree `share/experiments/push_20n.yaml`. What is not found there,
/// either, is returned unchanged.
std::string FindInput(const std::string& path, const std::optional<std::string>& shipped);

}  // namespace taut

/// Input files by path, folder or name, as commands accept them.
///
/// Threads: any number may call these functions at once.
#pragma once

#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/shipped.h"

namespace taut {

/// Returns the path of the file that `given` refers to. `kinds`: accepted kinds of files, preferred
/// ones first: "model", "experiment", "gait", "study", "fit", "mapping", "calibration"; "trace"
/// accepts the folder of a run. The rules, in this order:
///
/// 1. A file: the path itself.
/// 2. A folder: the folder itself if it contains a trace and traces are accepted; else, for the
///    first accepted kind that it contains, `model.yaml` (named after the kind) or its only file of
///    this kind. Several files are an error.
/// 3. A name without its extension: `my_robot` is `my_robot.yaml`.
/// 4. A shipped file, by path or name: `experiments/push_20n.yaml`, `push_20n` (`FindInput`).
///
/// A text that matches no rule is returned unchanged.
std::string ResolveInput(const std::string& given, const std::vector<std::string>& kinds,
                         Diagnostics& out, const std::string& program = RunningProgram());

}  // namespace taut

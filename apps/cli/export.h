/// The commands of `taut export`, each in its file.
#pragma once

#include "commands.h"

namespace taut::cli {

void AddExportMjcf(CLI::App& export_, int& exit_code);

}  // namespace taut::cli

/// The commands of `taut import`, each in its file.
#pragma once

#include "commands.h"

namespace taut::cli {

void AddImportMjcf(CLI::App& import, int& exit_code);

}  // namespace taut::cli

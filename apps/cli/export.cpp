// Command `taut export`: conversion of robots for other programs.
#include "export.h"

namespace taut::cli {

void AddExport(CLI::App& app, int& exit_code) {
  CLI::App* group = app.add_subcommand(
      "export", "Convert a robot for other programs: MuJoCo, STL, glTF, statics tools.");
  group->require_subcommand(1);
  AddExportMjcf(*group, exit_code);
  AddExportShape(*group, exit_code);
  AddExportStructure(*group, exit_code);
  group->footer(
      "Examples:\n"
      "  taut export mjcf models/six_strut.yaml --out six_strut.xml\n"
      "  taut export shape models/six_strut.yaml --out six_strut.glb\n"
      "  taut export structure models/prism3.yaml --out prism3\n"
      "Help on a command: `taut export COMMAND --help`\n"
      "Exit status: 0 success, 1 a file cannot be written, 2 bad usage, 3 bad input.");
}

}  // namespace taut::cli

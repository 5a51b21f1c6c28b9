/// The `taut` command as a function, for the program and for the Python module that contains it.
#pragma once

namespace taut::cli {

/// Runs the command with these arguments; reports exceptions that no subcommand handles. Returns
/// the exit status.
int Main(int argc, char** argv);

}  // namespace taut::cli

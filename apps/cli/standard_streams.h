/// Standard output and error that tolerate failures: closed streams, a full disk, a pipe without
/// reader. The results of a command do not depend on these failures.
#pragma once

namespace taut::cli {

/// Must be called before anything is opened or printed. After it, printing never fails or throws.
void GuardStreams();

/// Declares that the output of this command only describes files that the command writes: if the
/// output cannot be printed, no result is lost.
void OutputIsNews();

/// Flushes the output. Returns the exit status: `exit_code`, or a failure if the output is the
/// result and could not be written.
int FinishOutput(int exit_code);

}  // namespace taut::cli
